"""Worlds and scenarios: from YAML to what the runtime lays out and runs."""
