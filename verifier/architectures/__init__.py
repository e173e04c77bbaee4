"""Recordings of architectures: every node judged by its own spec, while others act."""
