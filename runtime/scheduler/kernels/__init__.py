"""What is compiled of the scheduler: one tick of a behavior."""
