"""specc: a declarative spec compiler and verifier for robot behaviors."""

__version__ = "0.1.0"
