"""The smoothed edges of basins, against scipy's filters."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, zoom

from specc.figures.areas import BLUR, FINER, _finer


@pytest.mark.parametrize("shape", [(48, 48), (7, 12), (2, 3), (1, 2)])
def test_finer_cells_are_those_of_a_blur_and_a_linear_zoom(shape: tuple[int, int]) -> None:
    inside = np.random.default_rng(1).random(shape) < 0.5
    blurred = gaussian_filter(inside.astype(float), BLUR, mode="nearest")
    expected = zoom(blurred, FINER, order=1, mode="nearest", grid_mode=True)

    finer = _finer(shape[0]) @ inside @ _finer(shape[1]).T

    np.testing.assert_allclose(finer, expected, rtol=0.0, atol=1e-14)  # rounding
