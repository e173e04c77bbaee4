"""Does the robot do what the spec says? Prediction, noise, judgement, coverage."""
