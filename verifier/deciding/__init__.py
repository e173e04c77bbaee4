"""Arbiters read: what their rules say, where each decides, and how near another one is."""
