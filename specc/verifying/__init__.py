"""Recordings judged: what is found in them, by which spec, and what many say together."""
