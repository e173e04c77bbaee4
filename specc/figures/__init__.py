"""Pictures: the one place that draws, from numbers made elsewhere."""
