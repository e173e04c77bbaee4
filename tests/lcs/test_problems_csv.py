"""A CSV file as a problem: numbers, words, what is refused and with which line."""

from pathlib import Path

import numpy as np
import pytest

from lcs.faults import LearnerError
from lcs.problems.csv_table import read_table
from lcs.problems.registry import made, table_offer


def written(folder: Path, text: str) -> Path:
    """A file with this text."""
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_numbers_are_inputs_with_a_range_and_each_word_is_an_input(tmp_path: Path) -> None:
    path = written(tmp_path, "distance,floor,does\n0.5,wood,stop\n2,wool,go\n\n 1.5 , wood ,go\n")

    table = read_table(path)

    distance, wood, wool = table.described
    assert (distance.name, distance.low, distance.high) == ("distance", 0.5, 2.0)
    assert (wood.name, wool.name) == ("floor is wood", "floor is wool")
    assert table.x.tolist() == [[0.5, 1.0, 0.0], [2.0, 0.0, 1.0], [1.5, 1.0, 0.0]]
    assert table.labels == ("go", "stop")
    assert table.right.tolist() == [1, 0, 0]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_any_usual_separator_and_the_mark_of_some_editors_will_do(
    tmp_path: Path, separator: str
) -> None:
    text = "\ufeffa,kind\n1,x\n2,y\n".replace(",", separator)

    assert read_table(written(tmp_path, text)).described[0].name == "a"


def test_the_class_is_the_column_that_is_named_and_others_can_be_left_out(tmp_path: Path) -> None:
    path = written(tmp_path, "t,kind,a\n0,10,5\n1,9,6\n2,10,7\n")

    problem = made(table_offer(path), {"target": "kind", "without": "t", "folds": 3, "tested": 3})

    assert [one.name for one in problem.described] == ["a"]
    assert problem.labels == ("9", "10")
    x, right = problem.fresh(9, np.random.default_rng(0))
    assert (x.tolist(), right.tolist()) == ([[7.0]], [1])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a,b\n1,x\n2\n", "line 3 has 1 fields, the line of names 2"),
        ("a,b\n1,x\n\nnan,y\n3,z\n", "line 4: 'a' is 'nan', where most rows have a number"),
        ("a,b\n1,x\n,y\n", "line 3: 'a' is empty"),
        ("a,b\n1,x\n2,\n", "line 3: 'b' is empty"),
        ("1,2\n3,4\n5,6\n", "line 1 holds numbers"),
        ("a,a\n1,x\n2,y\n", "two columns are named 'a'"),
        ("a,\n1,x\n2,y\n", "line 1 does not name column 2"),
        ("a,b\n1,x\n2,x\n", "all rows are of one class: 'b' is always x"),
        ("a,b\n1,x\n", "two rows at least"),
        ("a\n1\n2\n", "one column only"),
        ('a,b\n"1,x\n2,y\n', "this is no CSV"),
    ],
)
def test_what_can_not_be_used_is_told_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(LearnerError, match=said):
        read_table(written(tmp_path, text))


def test_more_classes_than_a_column_of_numbers_can_mean_are_refused(tmp_path: Path) -> None:
    rows = "".join(f"{i},{i / 7}\n" for i in range(70))

    with pytest.raises(LearnerError, match="70 different values"):
        read_table(written(tmp_path, "a,b\n" + rows))


def test_what_is_no_text_and_a_column_that_is_not_there_are_told(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_bytes(b"a,b\n\xff\xfe,1\n2,3\n")
    with pytest.raises(LearnerError, match="UTF-8"):
        read_table(path)
    with pytest.raises(LearnerError, match="no column is named 'c': there are a, b"):
        read_table(written(tmp_path, "a,b\n1,x\n2,y\n"), target="c")
