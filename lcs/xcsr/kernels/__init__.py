"""XCSR's cycle over arrays of all classifiers, compiled."""
