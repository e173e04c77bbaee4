"""Learning classifier systems for real-valued inputs; they know nobody else in this house."""
