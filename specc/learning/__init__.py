"""Experiments of learners: run, interrupted, resumed, summed up and written."""
