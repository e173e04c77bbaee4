"""The light on the floor, read from the recording of a scenario."""

import math
import struct
import zlib
from pathlib import Path
from typing import Any, Final

import numpy as np
from google.protobuf.message import DecodeError
from mcap.exceptions import McapError
from mcap.reader import make_reader
from zstandard import ZstdError

from runtime.arrays import Array, Floats
from runtime.container import ArtifactError
from runtime.recording.foxglove import classes
from runtime.recording.tracks import LightFrames

NANOSECONDS: Final = 1e9
LIGHT: Final = "/world/light"
BYTES: Final = 4
"""Of a number of a picture."""
UNREADABLE: Final = (McapError, DecodeError, ZstdError, struct.error, zlib.error, ValueError)
"""What readers raise at a file that was cut or altered."""


def recorded_floor(trace: Path) -> LightFrames | None:
    """The light on the floor, where it was recorded.

    Raises:
        ArtifactError: what is told of it was cut, or does not fit together.
    """
    times, frames, axes = [], [], []
    try:
        with trace.open("rb") as file:
            reader = make_reader(file, validate_crcs=True)
            for _, _, message in reader.iter_messages(topics=[LIGHT]):
                grid = classes()["Grid"].FromString(message.data)
                frames.append(_lux(grid))
                axes.append(_axes(grid, frames[-1].shape))
                times.append(message.log_time / NANOSECONDS)
    except UNREADABLE as error:
        raise ArtifactError(f"the light on the floor can't be read: {error}") from error
    if not frames:
        return None
    xs, ys = axes[0]
    if any(frame.shape != frames[0].shape for frame in frames):
        raise ArtifactError("pictures of the light on the floor differ in size")
    return LightFrames(xs, ys, np.array(times), np.array(frames))


def _lux(grid: Any) -> Floats:
    """Lux (ny, nx) of one message.

    Raises:
        ValueError: it holds no whole rows, or numbers that are no light.
    """
    columns = int(grid.column_count)
    if not columns or not grid.data or len(grid.data) % (BYTES * columns):
        raise ValueError(f"{len(grid.data)} bytes are no rows of {columns} cells")
    lux = np.frombuffer(grid.data, dtype="<f4").reshape(-1, columns)
    if not (np.isfinite(lux).all() and (lux >= 0.0).all()):
        raise ValueError("it holds numbers that are no light")
    return lux


def _axes(grid: Any, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """The middles of the cells along x and y.

    Raises:
        ValueError: the cells have no size, or no place.
    """
    corner, cell = grid.pose.position, grid.cell_size
    sizes = (cell.x, cell.y)
    if not all(map(math.isfinite, (corner.x, corner.y, *sizes))) or min(sizes) <= 0.0:
        raise ValueError("its cells have no size, or no place")
    rows, columns = shape
    xs = corner.x + cell.x * (np.arange(columns) + 0.5)
    ys = corner.y + cell.y * (np.arange(rows) + 0.5)
    return xs, ys
