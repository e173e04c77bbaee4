"""Architectures: what they name, how it is wired, what is wrong with it, and the program of it."""
