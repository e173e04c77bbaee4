"""XCSR, the accuracy-based classifier system for real-valued inputs (Wilson 2000)."""
