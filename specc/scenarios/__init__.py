"""Scenarios: run, watched, put together again from recordings, and drawn."""
