"""How arbiters decide: one file for each paradigm, behind one protocol."""
