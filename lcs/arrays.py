"""The array types that flow through the learners."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int64]
Indices: TypeAlias = npt.NDArray[np.int32]
Counts: TypeAlias = npt.NDArray[np.int16]
Booleans: TypeAlias = npt.NDArray[np.bool_]
