"""Fixed points: all of them, proved."""
