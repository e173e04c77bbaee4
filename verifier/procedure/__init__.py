"""Test procedures: what to record so that the verifier can decide, and the proof that it can."""
