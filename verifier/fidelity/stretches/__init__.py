"""Which parts of a trace can be judged."""
