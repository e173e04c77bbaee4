"""Changes to single values of a spec's text; every other character stays."""
