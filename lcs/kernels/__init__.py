"""What the kernels of all learners share."""
