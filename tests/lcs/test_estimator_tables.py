"""Tables with names and categories become numbers and come back; unknown values are refused."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lcs.encoding import Encoding
from lcs.estimator import ALCSRClassifier
from lcs.faults import LearnerError
from lcs.inputs import Input

COLOR = Input("color", values=("red", "green", "blue"))
SIZE = Input("size", values=("small", "middle", "large"), is_ordered=True)
WEIGHT = Input("weight", "kg", low=0.0, high=10.0)
COUNT = Input("wheels")
TABLE = Encoding((COLOR, WEIGHT, SIZE, COUNT))

ROWS = st.lists(
    st.tuples(
        st.sampled_from([*COLOR.values, None]),
        st.none() | st.floats(allow_nan=False),
        st.sampled_from([*SIZE.values, None]),
        st.none() | st.integers(-(2**53), 2**53),
    ),
    min_size=1,
    max_size=20,
)


class Frame:
    """What is used of a pandas DataFrame: `columns`, and a column by its name."""

    def __init__(self, columns: dict[str, list[Any]]) -> None:
        self.columns = list(columns)
        self._cells = columns

    def __getitem__(self, name: str) -> list[Any]:
        return self._cells[name]

    def __len__(self) -> int:
        return len(self._cells[self.columns[0]])


@given(rows=ROWS)
def test_a_table_comes_back_from_its_numbers(rows: list[tuple[Any, ...]]) -> None:
    assert TABLE.decoded(TABLE.encoded(rows)) == rows


def test_columns_are_an_input_for_each_name_and_the_index_of_the_ordered() -> None:
    numbers = TABLE.encoded([("green", 2.5, "large", 4), (None, 1.0, "small", None)])

    assert [each.name for each in TABLE.columns] == [
        "color is red",
        "color is green",
        "color is blue",
        "weight",
        "size",
        "wheels",
    ]
    assert numbers[0].tolist() == [0, 1, 0, 2.5, 2, 4]
    assert np.isnan(numbers[1]).tolist() == [True, True, True, False, False, True]
    assert TABLE.columns[1].values == ("no", "yes")


def test_a_frame_is_read_by_the_names_of_its_columns() -> None:
    cells = {
        "wheels": [4, 2],
        "owner": ["x", "y"],
        "size": ["small", "large"],
        "weight": [1.0, float("nan")],
        "color": ["red", "blue"],
    }
    rows = [("red", 1.0, "small", 4), ("blue", None, "large", 2)]

    assert np.array_equal(TABLE.encoded(Frame(cells)), TABLE.encoded(rows), equal_nan=True)
    assert np.array_equal(TABLE.encoded(cells), TABLE.encoded(rows), equal_nan=True)


@pytest.mark.parametrize(
    ("row", "said"),
    [
        (
            ("purple", 1, "small", 1),
            "row 1, 'color': 'purple' is unknown; known are red, green, blue",
        ),
        (("red", "heavy", "small", 1), "row 1, 'weight': 'heavy' is no number"),
        (
            ("red", 1, "huge", 1),
            "row 1, 'size': 'huge' is unknown; known are small, middle, large",
        ),
        (("red", 1, "small"), "row 1 has 3 values, and there are 4 inputs"),
    ],
)
def test_what_is_unknown_is_refused_with_its_place(row: tuple[Any, ...], said: str) -> None:
    with pytest.raises(LearnerError) as caught:
        TABLE.encoded([("red", 1, "small", 1), row])

    assert str(caught.value) == said


def test_a_table_without_a_column_is_refused() -> None:
    with pytest.raises(LearnerError, match="no column 'color': it has weight, size"):
        TABLE.encoded({"weight": [1], "size": ["small"]})
    with pytest.raises(LearnerError, match="different lengths"):
        Encoding((WEIGHT, COUNT)).encoded({"weight": [1], "wheels": [1, 2]})


def test_names_are_there_once() -> None:
    with pytest.raises(LearnerError, match="two inputs are named 'weight'"):
        Encoding((WEIGHT, WEIGHT))
    with pytest.raises(LearnerError, match="'color' has a value twice: red, red"):
        Encoding((Input("color", values=("red", "red")),))


@pytest.mark.parametrize("numbers", [[1, 1, 0, 1, 0, 0], [0, 0, 0, 1, 0, 0], [0, 1, 0, 1, 0.5, 0]])
def test_numbers_that_stand_for_no_value_are_refused(numbers: list[float]) -> None:
    with pytest.raises(LearnerError, match=r"row 0, '\w+': .* stands for no value"):
        TABLE.decoded(np.array([numbers], np.float64))


def test_a_rule_on_a_name_is_learnt_from_a_table() -> None:
    """Who is blue, or large and heavier than 6 kg, is a lorry."""
    chance = np.random.default_rng(3)

    def drawn(count: int) -> tuple[list[tuple[Any, ...]], list[str]]:
        colors = chance.choice(COLOR.values, count).tolist()
        sizes = chance.choice(SIZE.values, count).tolist()
        weights = (10.0 * chance.random(count)).tolist()
        rows = list(zip(colors, weights, sizes, strict=True))
        return rows, [
            "lorry" if c == "blue" or (s == "large" and w > 6.0) else "car" for c, w, s in rows
        ]

    found = ALCSRClassifier(inputs=[COLOR, WEIGHT, SIZE], examples=4_000, random_state=0)
    found.fit(*drawn(400))
    rows, right = drawn(400)

    assert found.score(rows, right) > 0.93
    assert found.n_features_in_ == 3
    assert [each.name for each in found.inputs_][:2] == ["color is red", "color is green"]
    with pytest.raises(LearnerError, match="row 0, 'color': 'teal' is unknown"):
        found.predict([("teal", 1.0, "small")])
    with pytest.raises(LearnerError, match="row 0, 'size' is NaN"):
        found.predict([("red", 1.0, None)])


def test_names_of_the_columns_are_kept_and_asked_for() -> None:
    pandas = pytest.importorskip("pandas", reason="pandas is no dependency")
    x = np.random.default_rng(0).random((40, 2))
    frame = pandas.DataFrame(x, columns=["ahead", "left"])
    found = ALCSRClassifier(examples=80, random_state=0).fit(frame, x[:, 0] > 0.5)

    assert found.feature_names_in_.tolist() == ["ahead", "left"]
    assert [each.name for each in found.inputs_] == ["ahead", "left"]
    with pytest.raises(ValueError, match="same order"):
        found.predict(frame[["left", "ahead"]])
