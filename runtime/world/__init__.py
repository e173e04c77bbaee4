"""The simulated world: bodies, sensors, light and physics (thesis, sections 2.4 and 3.3)."""
