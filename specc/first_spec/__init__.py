"""A first spec for a log: what it holds, what its variables could be, and the spec as text."""
