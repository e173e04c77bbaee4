"""What a trace cannot tell: faults too small to show in it, and what it leaves open."""
