"""The compiled part of problems."""
