"""A classifier that was saved goes on bit for bit, with all that it was told of its inputs."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lcs.alcsr.config import Config
from lcs.alcsr.learner import ALCSR
from lcs.estimator import ALCSRClassifier
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.saving import as_bytes, load, save

INPUTS = [
    Input("color", values=("red", "green")),
    Input("weight", "kg", low=0.0),
    Input("size", values=("small", "large"), is_ordered=True),
]


def rows(count: int, seed: int) -> tuple[list[tuple[Any, ...]], list[str]]:
    chance = np.random.default_rng(seed)
    colors = chance.choice(["red", "green"], count).tolist()
    weights = (30.0 * chance.random(count)).tolist()
    sizes = chance.choice(["small", "large"], count).tolist()
    table = list(zip(colors, weights, sizes, strict=True))
    return table, ["heavy" if row[1] > 12 and row[2] == "large" else "light" for row in table]


def as_saved(classifier: ALCSRClassifier, path: Path) -> ALCSRClassifier:
    save(classifier, path)
    return ALCSRClassifier.load(path)


def test_a_classifier_of_a_table_goes_on_as_if_nothing_had_been_stopped(tmp_path: Path) -> None:
    settings = {"missing": "any", "uncovered": "?", "config": Config(mutate=0.2), "examples": 300}
    going = ALCSRClassifier(inputs=INPUTS, random_state=3, **settings).fit(*rows(100, 1))
    stopped = as_saved(going, tmp_path / "classifier")

    for seed in (2, 3):
        table, labels = rows(50, seed)
        gaps = [*table[:-1], (None, None, "large")]
        going.partial_fit(gaps, labels)
        stopped = as_saved(stopped.partial_fit(gaps, labels), tmp_path / "classifier")

    fresh, _ = rows(50, 9)
    assert np.array_equal(stopped.predict_proba(fresh), going.predict_proba(fresh))
    assert stopped.predict(fresh).tolist() == going.predict(fresh).tolist()
    assert stopped.get_params() == {**going.get_params(), "inputs": tuple(INPUTS)}
    assert as_bytes(stopped.state()) == as_bytes(going.state())


@pytest.mark.parametrize("labels", [[0, 1], [False, True], ["a", "bb"], [0.0, 2.0]])
def test_classes_of_every_type_come_back(labels: list[Any], tmp_path: Path) -> None:
    x = np.random.default_rng(0).random((40, 1))
    found = ALCSRClassifier(examples=40).fit(x, np.array(labels)[(x[:, 0] > 0.5).astype(int)])
    again = as_saved(found, tmp_path / "classifier")

    assert again.classes_.dtype == found.classes_.dtype
    assert again.predict(x).tolist() == found.predict(x).tolist()
    assert again.fit(x, found.predict(x)).score(x, found.predict(x)) > 0.8


def test_what_no_file_holds_is_refused_by_its_name(tmp_path: Path) -> None:
    found = ALCSRClassifier(examples=4, random_state=np.random.RandomState(1))
    found.fit([[0.0], [1.0]], [0, 1])
    with pytest.raises(LearnerError, match="random_state: RandomState"):
        save(found, tmp_path / "classifier")


def test_a_learner_is_no_classifier_and_the_other_way_round(tmp_path: Path) -> None:
    save(ALCSR(2, 2), tmp_path / "learner")
    with pytest.raises(LearnerError, match="its kind is 'ALCSR': known are ALCSRClassifier"):
        ALCSRClassifier.load(tmp_path / "learner")
    save(ALCSRClassifier(examples=4).fit([[0.0], [1.0]], [0, 1]), tmp_path / "classifier")
    with pytest.raises(LearnerError, match="its kind is 'ALCSRClassifier'"):
        load(tmp_path / "classifier")
