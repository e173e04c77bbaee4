"""An expression as text, for each reader: the machine, people, C, Python, LaTeX."""

from spec_schema.expressions.printers.postfix import to_postfix

__all__ = ["to_postfix"]
