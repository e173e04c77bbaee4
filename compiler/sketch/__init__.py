"""Sketches: features drawn in a plane, what index theory adds, and a field that has them."""
