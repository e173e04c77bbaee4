"""Reads a table of this book: `value("avoid.npz", "rate heading", {"left": 1, "side": 0})`."""

import numpy as np


def value(path: str, quantity: str, at: dict[str, float], setting: str = "default") -> float:
    """The quantity at a state, linear between nodes, NaN outside; in the units of the CSV."""
    data = np.load(path)
    values = data[f"{setting}/{quantity}"]
    for axis in data[f"{setting}/{quantity}/axes"]:
        nodes = data[f"{setting}/{quantity}/{axis}"]
        place = np.interp(at[axis], nodes, np.arange(len(nodes)), np.nan, np.nan)
        if np.isnan(place):
            return float("nan")
        i = min(int(place), len(nodes) - 2)
        values = values[i] + (place - i) * (values[i + 1] - values[i])
    return float(values)
