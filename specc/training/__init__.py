"""Training the arbiter of a scenario: episodes, what they were worth, and what was learnt."""
