"""From the errors of the windows to the verdict."""
