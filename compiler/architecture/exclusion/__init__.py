"""Whether two nodes ever act at once: proved, refuted with a state, or open."""
