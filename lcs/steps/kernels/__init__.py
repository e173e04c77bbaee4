"""The compiled part of learning over several steps."""
