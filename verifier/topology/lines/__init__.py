"""Nullclines, every branch of them."""
