"""Many nodes at their own rates, in simulated time that no computer's speed changes."""
