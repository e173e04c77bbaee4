"""From a checked spec to a program: named passes, each a file, listed in `compile.py`."""
