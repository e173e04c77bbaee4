"""Messages: how they are laid out, and values out of many of them at once."""
