"""Reads tables of this book; each page of a behavior has an example under "The same as numbers".

Where modes differ, a table is of one mode: its quantity is called `rate heading in to_left`.
"""

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
