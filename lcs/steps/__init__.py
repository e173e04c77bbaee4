"""Learning over several steps, where the reward comes late."""
