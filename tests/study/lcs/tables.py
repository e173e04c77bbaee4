"""Rows of tables in Markdown."""

from collections.abc import Sequence

import numpy as np


def row(cells: Sequence[str]) -> str:
    """A line of a table."""
    return "| " + " | ".join(cells) + " |"


def percent(share: float) -> str:
    """A share as a percentage with a digit; a dash where there is none."""
    return "–" if np.isnan(share) else f"{100.0 * share:.1f}"
