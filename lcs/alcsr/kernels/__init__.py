"""The compiled core of ALCSR."""
