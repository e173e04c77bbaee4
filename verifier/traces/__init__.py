"""Logs of every kind, read into one `Trace`, with every loss counted."""
