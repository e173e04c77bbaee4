"""Policies over several steps as short lists of rules: the first that holds says what to do."""
