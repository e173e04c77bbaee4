"""One portrait held against another."""
