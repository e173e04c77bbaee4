"""An expression as text, for each reader: the machine, people, C, Python, LaTeX."""
