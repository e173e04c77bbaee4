"""`specc fit`: the spec's own numbers moved to what the robot does, in the user's text."""
