"""Trajectories and orbits: where they begin, and how they are followed."""
