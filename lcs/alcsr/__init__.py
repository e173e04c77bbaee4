"""ALCSR, the artificial-life classifier system for real-valued inputs (thesis, chapter 4)."""
