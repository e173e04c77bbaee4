"""How many cycles `specc learn` runs between two looks at whether it shall stop."""

import pytest

from specc.learning.running import AT_ONCE, next_at_once


@pytest.mark.parametrize("took", [0.0, 1e-6, 0.1, 1e3])
def test_cycles_at_once_stay_in_their_limits_however_long_a_run_is(took: float) -> None:
    fewest, at_once, most = AT_ONCE
    for _ in range(5_000):
        at_once = next_at_once(at_once, took)
        assert fewest <= at_once <= most


def test_a_piece_that_took_too_long_is_followed_by_a_shorter_one() -> None:
    assert next_at_once(1_000, 0.4) == 250
    assert next_at_once(1_000, 0.09) == 1_111
