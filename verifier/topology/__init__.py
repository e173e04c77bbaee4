"""Fixed points, nullclines and trajectories of a compiled field, as numbers."""
