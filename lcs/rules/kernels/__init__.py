"""Compiled parts of what is done with rules."""
