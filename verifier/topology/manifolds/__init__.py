"""Stable and unstable manifolds of saddles."""
