"""A second implementation of robustness with bounds: the definition itself, on a grid of instants.

It knows nothing of courses: at an instant it takes maxima and minima over all instants of a grid.
For quantities that are held between whole seconds a grid of half seconds holds every value that
they take, so that it is exact; for others it is as fine as the grid.
"""

import math
from collections.abc import Callable

from runtime.requirement import Formula, Operator

Value = Callable[[Formula, float], float]


class ByDefinition:
    """Bounds (low, high) of a formula at an instant, for a run from 0 to `end`."""

    def __init__(
        self, formula: tuple[Formula, ...], value: Value, end: float, step: float, ahead: float
    ) -> None:
        self.root = self._tree(list(formula))
        self.value, self.end = value, end
        self.grid = [i * step for i in range(int(ahead / step) + 1)]
        self.memory: dict[tuple[int, float], tuple[float, float]] = {}

    def _tree(self, formula: list[Formula]) -> tuple:
        last = formula.pop()
        if last.operator is Operator.PREDICATE:
            return (last,)
        count = 1 if last.operator in (Operator.NOT, Operator.ALWAYS, Operator.EVENTUALLY) else 2
        operands = [self._tree(formula) for _ in range(count)][::-1]
        return (last, *operands)

    def reach(self, node: tuple) -> float:
        """How far ahead it looks, apart from the rest of the run."""
        of = max((self.reach(each) for each in node[1:]), default=0.0)
        if node[0].operator is Operator.PREDICATE:
            return 0.0
        return of + (node[0].first if node[0].last is None else node[0].last)

    def at(self, node: tuple, time: float) -> tuple[float, float]:
        """The bounds at an instant."""
        key = (id(node), time)
        if key not in self.memory:
            self.memory[key] = self._at(node, time)
        return self.memory[key]

    def _at(  # noqa: PLR0911  one for each operator
        self, node: tuple, time: float
    ) -> tuple[float, float]:
        formula, operands = node[0], node[1:]
        match formula.operator:
            case Operator.PREDICATE:
                if time > self.end:
                    return -math.inf, math.inf
                return (self.value(formula, time),) * 2
            case Operator.NOT:
                low, high = self.at(operands[0], time)
                return -high, -low
            case Operator.AND:
                a, b = (self.at(each, time) for each in operands)
                return min(a[0], b[0]), min(a[1], b[1])
            case Operator.OR:
                a, b = (self.at(each, time) for each in operands)
                return max(a[0], b[0]), max(a[1], b[1])
            case Operator.IMPLIES:
                a, b = (self.at(each, time) for each in operands)
                return max(-a[1], b[0]), max(-a[0], b[1])
            case Operator.EVENTUALLY:
                return self._eventually(formula, lambda t: self.at(operands[0], t), operands, time)
            case Operator.ALWAYS:
                low, high = self._eventually(
                    formula,
                    lambda t: tuple(-v for v in self.at(operands[0], t)[::-1]),
                    operands,
                    time,
                )
                return -high, -low
            case _:
                hold, reached = operands
                return self._eventually(
                    formula, lambda t: self._until(formula, hold, reached, time, t), operands, time
                )

    def _until(
        self, formula: Formula, hold: tuple, reached: tuple, now: float, then: float
    ) -> tuple[float, float]:
        """`reached` then, and `hold` from now until just before then."""
        low, high = self.at(reached, then)
        held = now + formula.first
        for time in self.grid:
            if now <= time < then or (formula.first > 0.0 and now <= time <= held):
                a, b = self.at(hold, time)
                low, high = min(low, a), min(high, b)
        return low, high

    def _eventually(
        self, formula: Formula, at: Callable, operands: tuple, now: float
    ) -> tuple[float, float]:
        if formula.last is not None:
            inside = [t for t in self.grid if now + formula.first <= t <= now + formula.last]
            found = [at(t) for t in inside]
            return max(low for low, _ in found), max(high for _, high in found)
        decided = self.end - max(self.reach(each) for each in operands)
        inside = [t for t in self.grid if now + formula.first <= t <= self.end]
        low = max((at(t)[0] for t in inside), default=-math.inf)
        high = max((at(t)[1] for t in inside if t <= decided), default=math.inf)
        return low, max(low, high)
