"""ALCSR as a classifier of scikit-learn's kind: rules that are learnt from labelled rows."""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Self, final

import numpy as np
import numpy.typing as npt
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils import check_random_state
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import (
    assert_all_finite,
    check_consistent_length,
    check_is_fitted,
    column_or_1d,
    validate_data,
)

from lcs.alcsr.config import GROWN, Config
from lcs.alcsr.learner import ALCSR
from lcs.arrays import Array, Integers
from lcs.encoding import Encoding
from lcs.faults import LearnerError
from lcs.inputs import Input
from lcs.intake import Intake, Missing, OutOfRange, refuse_parameters, without_gaps
from lcs.problems.rewards import RIGHT, WRONG, rewards_of
from lcs.rules.belief import Belief, believe
from lcs.rules.table import RuleTable
from lcs.saving import load_one_of
from lcs.state import State, array_named, chance_from, from_plain, plain_of, plain_of_chance

SEEDS: Final = 2**31 - 1


@final
@dataclass(frozen=True, slots=True)
class Kept:
    """What is saved of a classifier beside arrays: parameters first."""

    config: Config | None
    examples: int
    inputs: tuple[Input, ...] | None
    missing: str
    out_of_range: str
    uncovered: Any
    random_state: Any
    n_features: int
    names: tuple[str, ...]
    classes: tuple[Any, ...]
    type_of_classes: str
    met: tuple[int, ...]
    chance: dict[str, Any]
    learner: dict[str, Any]

    def refuse_what_no_file_holds(self) -> None:
        """Classes and parameters may be anything; here they are texts, numbers or None."""
        for name in ("uncovered", "random_state", "classes"):
            value = getattr(self, name)
            for each in value if name == "classes" else [value]:
                if not isinstance(each, str | int | float | None):
                    raise LearnerError(
                        f"{name}: {each!r} can't be saved; texts and plain numbers can"
                    )


class ALCSRClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]  # no types there
    """A classifier that finds rules: intervals of the inputs, and a class.

    Each class is an action of an `ALCSR` learner. For a row the learner is told the reward of every
    class in turn, 1000 for the right one and -1000 for the others.

    Args:
        config: the constants of ALCSR, and how open places of the thesis are read. None for
            `GROWN`, which goes beyond it; its memory is no longer than `fit` needs.
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
            such as -1 or "unknown"; but a text that is one of the two misspelt is refused.
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
        examples: int = 5_000,
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
        rows = len(x)
        self._begin(x, np.unique(labels), max(self.examples, rows))
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
            self._begin(x, np.unique(classes), GROWN.beyond.remembers)
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
        if isinstance(self.uncovered, str) and self.uncovered in {"nearest", "refuse"}:
            if self.uncovered == "refuse" and not is_covered.all():
                raise LearnerError(f"row {is_covered.argmin()}: no rule for its class holds")
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

    def state(self) -> State:
        """Its parameters and all that it has learnt: what `lcs.saving.save` writes.

        Raises:
            LearnerError: a class or a parameter is nothing that a file holds.
        """
        check_is_fitted(self, "learner_")
        inner = self.learner_.state()
        inputs = None if self.inputs is None else tuple(self.inputs)
        kept = Kept(
            **{**self.get_params(), "inputs": inputs, "examples": int(self.examples)},
            n_features=int(self.n_features_in_),
            names=tuple(str(name) for name in getattr(self, "feature_names_in_", ())),
            classes=tuple(self.classes_.tolist()),
            type_of_classes=self.classes_.dtype.str,
            met=tuple(self._met),
            chance=plain_of_chance(self._chance),
            learner=dict(inner.plain),
        )
        kept.refuse_what_no_file_holds()
        of_learner = {f"learner.{name}": each for name, each in inner.arrays.items()}
        arrays = {"power": self._intake.power.copy(), **of_learner}
        return State("ALCSRClassifier", plain_of(kept), arrays)

    @classmethod
    def from_state(cls, state: State) -> Self:
        """The classifier that had this state.

        Raises:
            LearnerError: the state is of another version, or damaged.
        """
        kept = from_plain(Kept, state.plain, "values")
        made = cls(**{name: getattr(kept, name) for name in cls().get_params()})
        made.n_features_in_ = kept.n_features
        if kept.names:
            made.feature_names_in_ = np.array(kept.names, object)
        made.classes_ = np.array(kept.classes, np.dtype(kept.type_of_classes))
        power = array_named("power", state.arrays)
        made.inputs_ = made._columns(power.size)
        made._intake = Intake.with_power(made.inputs_, power, made.missing, made.out_of_range)
        made._chance = chance_from(kept.chance)
        arrays = {name.removeprefix("learner."): each for name, each in state.arrays.items()}
        made.learner_ = ALCSR.from_state(State("ALCSR", kept.learner, arrays))
        made._met = []
        made._meet(np.array(kept.met, np.int64))
        return made

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """The classifier that `lcs.saving.save` wrote; it goes on bit for bit as that one would.

        Raises:
            LearnerError: the file is damaged, no classifier, or of another version.
            OSError: there is no such file, or it can't be read.
        """
        found: Self = load_one_of({"ALCSRClassifier": cls.from_state}, path)
        return found

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.input_tags.allow_nan = self.missing == "any"
        return tags

    def _read(self, X: Any, y: Any, *, first: bool) -> tuple[Array, npt.NDArray[Any]]:
        """Rows and labels, of the same length."""
        refuse_parameters(self.examples, self.inputs, self.uncovered)
        x = self._numbers(X, first=first)
        if y is None:
            raise LearnerError("fit requires y to be passed, but the target y is None")
        labels: npt.NDArray[Any] = column_or_1d(y, warn=True)
        assert_all_finite(labels, input_name="y")
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

    def _begin(self, x: Array, classes: npt.NDArray[Any], to_come: int) -> None:
        """A learner that knows nothing yet of rows like x, of which so many are to come."""
        columns = self._columns(x.shape[1])
        self._intake = Intake.of(columns, x, self.missing, self.out_of_range)
        self._intake.taught(x)
        seeds = check_random_state(self.random_state).randint(SEEDS, size=2)
        self._chance = np.random.default_rng(int(seeds[0]))
        self.inputs_ = columns
        self.classes_ = classes
        self._met: list[int] = []
        config = self.config if self.config is not None else _remembering(to_come)
        self.learner_ = ALCSR(
            len(classes), x.shape[1], config, reward_range=RIGHT - WRONG, seed=int(seeds[1])
        )

    def _columns(self, count: int) -> tuple[Input, ...]:
        """What the learner's columns are, so many if `inputs` does not say."""
        if self.inputs is not None:
            return Encoding(tuple(self.inputs)).columns
        names = getattr(self, "feature_names_in_", [f"x{i}" for i in range(count)])
        return tuple(Input(str(name)) for name in names)

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
        action = self._action_of[found]
        self.learner_.teach(given, rewards_of(action, len(self.classes_), 0.0, self._chance))

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


def _remembering(examples: int) -> Config:
    """What users have, with no more room for memories than there are examples to come."""
    least = max(1, min(examples, GROWN.beyond.remembers))
    return dataclasses.replace(GROWN, beyond=dataclasses.replace(GROWN.beyond, remembers=least))
