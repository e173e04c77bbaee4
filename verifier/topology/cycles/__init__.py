"""Closed trajectories of flows and maps, with their multipliers."""
