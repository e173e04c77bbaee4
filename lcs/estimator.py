"""ALCSR as a classifier of scikit-learn's kind: rules that are learnt from labelled rows."""

import dataclasses
from collections.abc import Sequence
from typing import Any, Final, Self

import numpy as np
import numpy.typing as npt
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils import check_random_state
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_consistent_length, check_is_fitted, validate_data

from lcs.alcsr.config import Config
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Array, Integers
from lcs.encoding import Encoding
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.intake import Intake, Missing, OutOfRange, without_gaps
from lcs.problems.rewards import RIGHT, WRONG
from lcs.rules.belief import Belief, believe
from lcs.rules.table import RuleTable

SEEDS: Final = 2**31 - 1


class ALCSRClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]  # no types there
    """A classifier that finds rules: intervals of the inputs, and a class.

    Each class is an action of an `ALCSR` learner. For a row the learner is told the reward of every
    class in turn, 1000 for the right one and -1000 for the others.

    Args:
        config: the constants of ALCSR, and how open places of the thesis are read.
        examples: how many rows `fit` shows, the same ones again and again, each pass in an order
            of its own; whole passes, and one at least.
        inputs: what the columns are: names, units, ranges, and values of those that are not
            numbers. `X` may then be a table with names and categories (`lcs.encoding`). Where
            no range is declared, it is that of the rows of `fit` or of the first `partial_fit`.
        missing: "refuse" raises an error that names row and column of a NaN. "any": where a class
            is asked for, a rule's condition on a NaN holds; to learn from a row, each NaN is
            filled by the value of another row, drawn anew in each pass.
        out_of_range: of numbers beyond the declared range, or else beyond those learnt from.
            "clip": the end of the range is taken, so that the rules that reach it hold. "refuse":
            an error that names row and column. "as it is": rules may hold or not, and numbers to
            learn from widen the range.
        uncovered: what `predict` says where no rule for the most probable class holds. "nearest":
            that class; it is the one whose rules are nearest among those that nothing speaks
            against. "refuse": an error that names the row. Anything else is itself the answer,
            such as -1 or "unknown".
        random_state: an integer for the same rules in each run.

    Attributes:
        classes_: sorted. n_features_in_: columns of `X`. feature_names_in_: where `X` has them.
        inputs_: what the learner's columns are; those of named values are one for each value.
        learner_: the `ALCSR`, which sees each column times a power of two.
    """

    def __init__(
        self,
        config: Config | None = None,
        *,
        examples: int = 20_000,
        inputs: Sequence[Input] | None = None,
        missing: Missing = "refuse",
        out_of_range: OutOfRange = "clip",
        uncovered: Any = "nearest",
        random_state: Any = None,
    ) -> None:
        self.config = config
        self.examples = examples
        self.inputs = inputs
        self.missing = missing
        self.out_of_range = out_of_range
        self.uncovered = uncovered
        self.random_state = random_state

    def fit(self, X: Any, y: Any) -> Self:
        """Forget what was learnt, and learn rows X (T, n) with labels y (T,).

        Raises:
            LearnerError: a value can't be used; with its row and column.
        """
        x, labels = self._read(X, y, first=True)
        self._begin(x, np.unique(labels))
        rows = len(x)
        for _ in range(max(1, -(-self.examples // rows))):
            order = self._chance.permutation(rows)
            self._teach(x[order], labels[order])
        return self

    def partial_fit(self, X: Any, y: Any, classes: Any = None) -> Self:
        """Learn rows X (T, n) with labels y (T,) once, in their order, after what was learnt.

        With declared ranges and no gaps, rows in several pieces give the bits of rows in one.

        Args:
            classes: all that there may be; asked for by the first call.

        Raises:
            LearnerError: a value can't be used, with its row and column; or a class is unknown.
        """
        is_first = not hasattr(self, "learner_")
        x, labels = self._read(X, y, first=is_first)
        if is_first:
            if classes is None:
                raise LearnerError("the first partial_fit needs classes=, all that there may be")
            self._begin(x, np.unique(classes))
        elif classes is not None and not np.array_equal(np.unique(classes), self.classes_):
            raise LearnerError(f"classes are {self.classes_.tolist()} since the first partial_fit")
        self._teach(x, labels)
        return self

    def predict(self, X: Any) -> npt.NDArray[Any]:
        """The most probable class of each row (T,), or what `uncovered` says.

        Raises:
            LearnerError: a row can't be used, or is refused as no rule holds.
        """
        found = self._believed(X)
        best = found.probability.argmax(axis=1)  # of equals, the class that was met first
        is_covered = found.is_covered[np.arange(len(best)), best]
        said: npt.NDArray[Any] = self.classes_[self._class_of[best]]
        if isinstance(self.uncovered, str) and self.uncovered == "nearest":
            return said
        if isinstance(self.uncovered, str) and self.uncovered == "refuse":
            for row in np.flatnonzero(~is_covered):
                raise LearnerError(f"row {row}: no rule for any class holds there")
            return said
        if np.any(~is_covered):
            said = said.astype(np.result_type(said, np.asarray(self.uncovered)))
            said[~is_covered] = self.uncovered
        return said

    def predict_proba(self, X: Any) -> Array:
        """The probability of each class (T, A), in the order of `classes_`; rows sum to 1.

        A rule counts how often it was right. The share of that, with Laplace's one right and one
        wrong more, is what it believes of its class; a class is believed as the rules that hold do
        on average, weighed as in the learner's vote, and then all are made to sum to 1. Classes
        that no rule holds for share what the others leave, by how near their rules are.

        Raises:
            LearnerError: a row can't be used.
        """
        found: Array = self._believed(X).probability[:, self._action_of]
        return found

    @property
    def rules_(self) -> RuleTable:
        """The rules in the numbers of `inputs_`; action k is the class `classes_[k]`."""
        check_is_fitted(self, "learner_")
        table, intake = self.learner_.rules(), self._intake
        return dataclasses.replace(
            table,
            action=self._class_of[table.action],
            lower=intake.unscaled(table.lower),
            upper=intake.unscaled(table.upper),
            low=intake.unscaled(table.low),
            high=intake.unscaled(table.high),
        )

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.input_tags.allow_nan = self.missing == "any"
        return tags

    def _read(self, X: Any, y: Any, *, first: bool) -> tuple[Array, npt.NDArray[Any]]:
        """Rows and labels, of the same length."""
        x = self._numbers(X, first=first)
        labels: npt.NDArray[Any] = validate_data(self, y=y)
        check_classification_targets(labels)
        check_consistent_length(x, labels)
        return x, labels

    def _numbers(self, X: Any, *, first: bool) -> Array:
        """The rows (T, n) as numbers, still in the user's size."""
        if self.inputs is not None:
            self.n_features_in_ = len(self.inputs)
            return Encoding(tuple(self.inputs)).encoded(X)
        found: Array = validate_data(
            self, X, reset=first, dtype=np.float64, ensure_all_finite=False, order="C"
        )
        return found

    def _begin(self, x: Array, classes: npt.NDArray[Any]) -> None:
        """A learner that knows nothing yet of rows like x."""
        columns = (
            Encoding(tuple(self.inputs)).columns
            if self.inputs is not None
            else tuple(Input(str(name)) for name in self._names(x.shape[1]))
        )
        self._intake = Intake.of(columns, x, self.missing, self.out_of_range)
        self._intake.taught(x)
        seeds = check_random_state(self.random_state).randint(SEEDS, size=2)
        self._chance = np.random.default_rng(int(seeds[0]))
        self.inputs_ = columns
        self.classes_ = classes
        self._met: list[int] = []
        self.learner_ = ALCSR(
            len(classes), x.shape[1], self.config, reward_range=RIGHT - WRONG, seed=int(seeds[1])
        )

    def _names(self, columns: int) -> Sequence[str]:
        names: Sequence[str] = getattr(self, "feature_names_in_", [f"x{i}" for i in range(columns)])
        return names

    def _teach(self, x: Array, labels: npt.NDArray[Any]) -> None:
        """Each row once, in order."""
        found = np.searchsorted(self.classes_, labels)
        known = self.classes_[np.minimum(found, len(self.classes_) - 1)] == labels
        for row in np.flatnonzero(~known):
            raise LearnerError(
                f"row {row}: class {labels[row:].tolist()[0]!r} is unknown; "
                f"classes are {self.classes_.tolist()}"
            )
        self._meet(found)
        land = self.learner_.population.land
        given = without_gaps(self._intake.taught(x), land.low, land.high, self._chance)
        is_right = self._action_of[found][:, None] == np.arange(len(self.classes_))
        self.learner_.teach(given, np.where(is_right, RIGHT, WRONG))

    def _meet(self, found: Integers) -> None:
        """Give classes their actions in the order in which they come, whatever their names are."""
        _, first = np.unique(found, return_index=True)
        new = [int(each) for each in found[np.sort(first)] if each not in self._met]
        self._met = [*self._met, *new]
        others = [each for each in range(len(self.classes_)) if each not in self._met]
        self._class_of = np.array([*self._met, *others], np.int64)
        self._action_of = np.argsort(self._class_of)

    def _believed(self, X: Any) -> Belief:
        check_is_fitted(self, "learner_")
        table = self.learner_.rules()
        x = self._intake.asked(self._numbers(X, first=False), table.low, table.high)
        return believe(table, x)
