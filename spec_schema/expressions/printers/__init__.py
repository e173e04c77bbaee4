"""An expression as text, for each reader: the machine, people, C, Python, LaTeX.

Programs and messages need the first two; the others are for code and papers made from a spec.
"""
