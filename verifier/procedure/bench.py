"""The test procedure of an arbiter: readings on either side of where its choice changes.

Places in the space of what it reads are drawn evenly. From each of them one reading is moved
through its range; where the choice changes, a reading below and one above that place are shown, so
that an arbiter with another threshold decides otherwise. Of rules, readings are added at which
single ones matter, so that an arbiter that lacks one does. Each is shown for a while, since an
arbiter may remember. How often all of it is repeated is the verifier's to say: until the spec
itself passes in a rehearsal.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.arbitration.build import arbiter_of
from runtime.arrays import Array, Booleans, Integers
from runtime.user_code import Callee, UserCodeError
from verifier.arbitration.judging import AGREED, Arbitrated, judge_arbiter
from verifier.arbitration.numbers import Decide, Running
from verifier.arbitration.reader import CHOICE
from verifier.arbitration.saying import CONFIDENCE
from verifier.arbitration.shares import times_longer
from verifier.procedure.bench_model import BenchTest, Biased, Lacking, Reading, Shown
from verifier.procedure.candidates import evenly, rounded
from verifier.procedure.single_rules import (
    mattering_rules,
    own_readings,
    single_rules,
    without_rule,
)
from verifier.report.report import Verdict
from verifier.traces.trace import TICKS, Series, Trace

PLACES: Final = 10
"""Where it is looked for changes of choice."""
ALONG: Final = 20
"""So many values of one reading are tried from each place."""
ASIDE: Final = 0.04
"""How far a reading is shown beside a change of choice, as a share of its range."""
BIAS: Final = 0.12
"""By how much, as a share of the range, an arbiter reads wrongly that must fail."""
EACH: Final = 2
"""So many places are shown of each change of choice by each reading."""
DECISIONS: Final = 4
"""Each reading is shown for at least so many decisions."""
MOST_REPEATS: Final = 40
SPARE: Final = 1.2
"""So many times as much as the verifier asks for."""
CLEARLY: Final = 2.5
"""So many times what may differ is to differ where a rule lacks."""
ADDED: Final = 0.5
"""Readings that are added for rules are this part of all at most."""


def bench_test(arbiter: Arbiter, period: float) -> BenchTest | None:
    """What to show an arbiter that decides every `period` seconds; None for one that reads nothing.

    Raises:
        UserCodeError: it is code of the user's own, which is not run for this.
    """
    if not arbiter.reads:
        return None
    bench = _Bench(arbiter, period)
    rows, names = bench.pairs()
    rows = bench.with_single_rules(rows[bench.chosen_last(rows) >= 0])
    shown = [
        Shown(dict(zip(names, map(float, row), strict=True)), arbiter.choices[choice])
        for row, choice in zip(rows, bench.chosen_last(rows), strict=True)
        if choice >= 0
    ]
    repeats, found = bench.rehearsed(rows)
    biased = tuple(bench.biased(rows, repeats, place) for place in bench.smooth)
    lacking, idle = bench.without_single_rules(rows, repeats)
    reached = {each.chosen for each in shown}
    return BenchTest(
        name=arbiter.name,
        period=period,
        seconds=bench.ticks * period,
        readings=tuple(Reading(r.name, r.unit, r.values) for r in arbiter.reads),
        shown=tuple(shown),
        repeats=repeats,
        required=bench.required,
        never=tuple(name for name in arbiter.choices if name not in reached),
        verdict=found.report.verdict,
        reasons=found.report.reasons,
        biased=tuple(each for each in biased if each is not None),
        lacking=lacking,
        idle=idle,
    )


def _no_code(text: str) -> Callee:
    raise UserCodeError(f"{text} is code, which no test procedure is derived from")


def _forgets(arbiter: Arbiter) -> bool:
    """Whether it chooses by what it reads now alone."""
    is_rules = arbiter.paradigm is Paradigm.RULES
    return is_rules and all(each.until is None and not each.lasts for each in arbiter.rules)


@final
@dataclass(frozen=True, eq=False, slots=True)
class _Bench:
    """An arbiter that is shown readings, rows (N, m) in the order of its reads."""

    arbiter: Arbiter
    period: float

    @property
    def ticks(self) -> int:
        """For so many decisions each reading is shown: longer than any rule lasts."""
        lasts = max((rule.lasts for rule in self.arbiter.rules), default=0.0)
        slow = 0.0 if self.arbiter.competition is None else 10.0 * self.arbiter.competition.time
        return max(DECISIONS, int(np.ceil(2.0 * max(lasts, slow) / self.period)))

    @property
    def smooth(self) -> tuple[int, ...]:
        """Which reads are no discrete ones."""
        return tuple(i for i, read in enumerate(self.arbiter.reads) if not read.values)

    @property
    def is_rules(self) -> bool:
        """Whether the first of its rules that holds decides."""
        return self.arbiter.paradigm is Paradigm.RULES

    @property
    def required(self) -> float:
        """The share of decisions that must agree."""
        return AGREED if self.arbiter.agreement is None else self.arbiter.agreement.share

    def chosen_last(self, rows: Array, one: Arbiter | None = None) -> Integers:
        """What it, or another one, has chosen at the end of each row (N,), -1 for nothing."""
        return self.chosen(np.repeat(rows, self.ticks, axis=0), one)[self.ticks - 1 :: self.ticks]

    def running(self, one: Arbiter) -> Decide:
        """A fresh one that decides."""
        made = arbiter_of(one, one.name, self.period, _no_code)
        made.reset(0)
        return made.decide

    def chosen(self, rows: Array, one: Arbiter | None = None) -> Integers:
        """What it, or another one, chooses (N,) that is shown rows (N, m) one after the other."""
        one = one or self.arbiter
        if _forgets(one):
            kinds, of_kind = np.unique(rows, axis=0, return_inverse=True)
            if len(kinds) < len(rows):
                return self.chosen(kinds, one)[of_kind.reshape(-1)]
        decide = self.running(one)
        controls = [control.default for control in self.arbiter.controls]
        found = np.full(len(rows), -1)
        for place, row in enumerate(rows):
            numbers = decide(np.array([*row, *controls]), place * self.period)
            if numbers.max() > 0.0:
                found[place] = int(np.argmax(numbers))
        return found

    def pairs(self) -> tuple[Array, list[str]]:
        """Rows (N, m) beside changes of choice, below and above in turn, and the reads' names."""
        found: dict[tuple[int, ...], list[tuple[Array, Array]]] = {}
        told: set[bytes] = set()
        for below, above, key in self._changes():
            kept, content = found.setdefault(key, []), below.tobytes() + above.tobytes()
            if len(kept) < EACH and content not in told:
                told.add(content)
                kept.append((below, above))
        rows = [row for kept in found.values() for pair in kept for row in pair]
        if not rows:
            rows = list(self._places())
        return np.array(rows), [read.name for read in self.arbiter.reads]

    def with_single_rules(self, rows: Array) -> Array:
        """The rows, and more of them, until each rule matters at enough of them."""
        if not self.is_rules:
            return rows
        own, most = own_readings(self.arbiter), int(len(rows) / (1.0 - ADDED))
        counts = mattering_rules(self.arbiter, rows).sum(axis=0)
        wanted = CLEARLY * (1.0 - self.required)
        for at in range(max(map(len, own), default=0)):
            for rule, readings in enumerate(own):
                if at < len(readings) and len(rows) < most and counts[rule] <= wanted * len(rows):
                    rows = np.concatenate([rows, readings[at : at + 1]])
                    counts += mattering_rules(self.arbiter, rows[-1:])[0]
        return rows

    def matters(self, rows: Array) -> Booleans:
        """At which of the rows (N, m), shown in their order, each of its single rules does: (N, R).

        One that remembers may choose otherwise long after a rule held that another lacks.
        """
        if _forgets(self.arbiter):
            return mattering_rules(self.arbiter, rows)
        chosen = self.chosen_last(rows)
        lacking = (without_rule(self.arbiter, place) for place in single_rules(self.arbiter))
        columns = [chosen != self.chosen_last(rows, one) for one in lacking]
        return np.array(columns, np.bool_).reshape(-1, len(rows)).T

    def _places(self) -> Array:
        """Rows, evenly over what can be read."""
        shares = evenly(PLACES, len(self.arbiter.reads))
        columns = [self._values(i, shares[:, i]) for i in range(len(self.arbiter.reads))]
        return np.stack(columns, axis=-1)

    def _values(self, place: int, share: Array) -> Array:
        read = self.arbiter.reads[place]
        if read.values:
            return np.floor(share * len(read.values))
        width = read.high - read.low
        values = rounded(read.low + share * width, width, read.unit.scale)
        return np.clip(values, read.low, read.high)

    def _changes(self) -> Iterator[tuple[Array, Array, tuple[int, ...]]]:
        """Rows below and above each change of choice, and which one it is of, by which reading.

        An arbiter that remembers changes elsewhere on its way up than on its way down.
        """
        for base in self._places():
            for place in range(len(self.arbiter.reads)):
                line = self._line(base, place)
                for way, chosen in enumerate(self._ways(line)):
                    for step in np.flatnonzero(np.diff(chosen)):
                        below, above = self._beside(line, int(step), place)
                        yield below, above, (place, way, int(chosen[step]), int(chosen[step + 1]))

    def _ways(self, line: Array) -> tuple[Integers, ...]:
        """What it chooses (k,) along a line: on the way up, on the way down, from a fresh start."""
        up = self.chosen(np.repeat(line, DECISIONS, axis=0))[DECISIONS - 1 :: DECISIONS]
        down = self.chosen(np.repeat(line[::-1], DECISIONS, axis=0))[DECISIONS - 1 :: DECISIONS]
        fresh = [self.chosen(np.tile(row, (DECISIONS, 1)))[-1] for row in line]
        return up, down[::-1], np.array(fresh)

    def _line(self, base: Array, place: int) -> Array:
        """Rows that differ from `base` in one reading alone, through its whole range."""
        read = self.arbiter.reads[place]
        count = len(read.values) or ALONG
        shares = (np.arange(count) + 0.5) / count
        line = np.tile(base, (count, 1))
        line[:, place] = self._values(place, shares)
        return line

    def _beside(self, line: Array, step: int, place: int) -> tuple[Array, Array]:
        """The rows before and after a change, as far apart as is to be shown."""
        read = self.arbiter.reads[place]
        below, above = line[step].copy(), line[step + 1].copy()
        if not read.values:
            middle, aside = 0.5 * (below[place] + above[place]), ASIDE * (read.high - read.low)
            ends = np.array([middle - aside, middle + aside])
            width = read.high - read.low
            told = np.clip(rounded(ends, width, read.unit.scale), read.low, read.high)
            below[place], above[place] = told
        return below, above

    def rehearsed(self, rows: Array) -> tuple[int, Arbitrated]:
        """How often all rows are shown until the verifier decides, and what it says then."""
        repeats = 1
        while True:
            found = self._judged(rows, repeats)
            share, required = found.section.share, found.section.required
            factor = times_longer(share, required, CONFIDENCE)
            if found.report.verdict is not Verdict.INCONCLUSIVE or repeats >= MOST_REPEATS:
                return repeats, found
            grown = repeats * min(max(SPARE * factor, 2.0), 8.0)
            repeats = int(min(np.ceil(grown), MOST_REPEATS))

    def biased(self, rows: Array, repeats: int, place: int) -> Biased | None:
        """One that reads one quantity too high; None where that changes no choice."""
        read = self.arbiter.reads[place]
        bias = BIAS * (read.high - read.low)
        wrong = rows.copy()
        wrong[:, place] = np.clip(wrong[:, place] + bias, read.low, read.high)
        found = self._judged(rows, repeats, wrong)
        if not found.section.confusion.sum() or found.section.share.value == 1.0:
            return None
        return Biased(read.name, bias, found.report.verdict)

    def without_single_rules(
        self, rows: Array, repeats: int
    ) -> tuple[tuple[Lacking, ...], tuple[int, ...]]:
        """Those without one of the rules, and numbers of rules that matter nowhere."""
        if not self.is_rules:
            return (), ()
        rules = np.array(single_rules(self.arbiter), np.int64)
        matters = self.matters(rows).any(axis=0)
        lacking = []
        for place in rules[matters].tolist():
            found = self._judged(rows, repeats, one=without_rule(self.arbiter, place))
            lacking.append(Lacking(place + 1, found.report.verdict))
        return tuple(lacking), tuple((rules[~matters] + 1).tolist())

    def _judged(
        self,
        rows: Array,
        repeats: int,
        read_as: Array | None = None,
        one: Arbiter | None = None,
    ) -> Arbitrated:
        """What the verifier says of one that is shown all rows, and may read other ones."""
        shown = np.tile(np.repeat(rows, self.ticks, axis=0), (repeats, 1))
        acted_on = rows if read_as is None else read_as
        chosen = self.chosen(np.tile(np.repeat(acted_on, self.ticks, axis=0), (repeats, 1)), one)
        times = np.asarray(np.arange(len(shown)) * self.period, dtype=np.float64)
        series = {
            read.name: Series(read.name, times, shown[:, i], read.name, TICKS)
            for i, read in enumerate(self.arbiter.reads)
        }
        series[CHOICE] = Series(CHOICE, times, chosen.astype(np.float64), CHOICE, TICKS)
        trace = Trace("rehearsal", series, {}, 0.0, (), ())
        is_rules = self.arbiter.paradigm in {Paradigm.RULES, Paradigm.SUBSUMPTION}
        running: Running | None = None if is_rules else self.running
        own = replace(self.arbiter, judge_when=None)
        return judge_arbiter(own, trace, running, depth="verdict")
