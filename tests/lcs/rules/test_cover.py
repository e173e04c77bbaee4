"""The smallest cover, held against trying all subsets."""

from itertools import combinations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from lcs.arrays import Booleans
from lcs.rules.cover import smallest_cover


@given(
    held=st.tuples(st.integers(1, 7), st.integers(0, 14)).flatmap(
        lambda shape: arrays.arrays(np.bool_, shape)
    )
)
def test_no_smaller_choice_covers_as_much(held: Booleans) -> None:
    taken = smallest_cover(held, np.ones(len(held)))

    whole = held.any(axis=0)
    np.testing.assert_array_equal(held[taken].any(axis=0), whole)
    fewest = next(
        count
        for count in range(len(held) + 1)
        if any(
            (held[list(some)].any(axis=0) == whole).all()
            for some in combinations(range(len(held)), count)
        )
    )
    assert len(taken) == fewest


def test_where_greed_takes_three_two_are_found() -> None:
    held = np.array([[1, 1, 1, 1, 0, 0], [1, 0, 1, 0, 1, 0], [0, 1, 0, 1, 0, 1]], np.bool_)

    assert smallest_cover(held, np.ones(3)) == [1, 2]
