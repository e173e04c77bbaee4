"""Expressions: a small safe language as checked trees, without evaluation of the user's text."""
