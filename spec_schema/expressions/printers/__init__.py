"""An expression as text, for each reader: the machine, people, C, Python, LaTeX."""

from spec_schema.expressions.printers.c99 import C99_FUNCTIONS, to_c99
from spec_schema.expressions.printers.latex import to_latex
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.printers.python import to_python
from spec_schema.expressions.printers.text import to_text

__all__ = ["C99_FUNCTIONS", "to_c99", "to_latex", "to_postfix", "to_python", "to_text"]
