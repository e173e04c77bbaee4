"""Why an arbiter decided as it did: a recording's decisions, read by the spec that ran."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final, final

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.architecture import Architecture
from runtime.user_code import UserCodeError
from spec_schema.diagnostics import SpecError
from spec_schema.suggest import did_you_mean, there_are
from specc.faults import fault
from specc.verifying.arbiter import running
from specc.verifying.spec_finding import find_spec
from specc.verifying.standard import Carried, Standard, carried_by, standard_of
from specc.verifying.trace import program_for_verify
from verifier.arbitration.decisions import Decisions, decisions_of
from verifier.arbitration.numbers import chooser_of
from verifier.arbitration.reader import reader_of
from verifier.architectures.log import open_run
from verifier.architectures.nodes import NodeRecord, decision_log
from verifier.architectures.recorded import records_of, topics_of_nodes
from verifier.deciding.margins import Margins
from verifier.deciding.moments import Moments, moments_of
from verifier.deciding.rulings import DRAWN
from verifier.deciding.stretches import Stretch, stretches_of, whole_margins
from verifier.traces.files.log import Progress
from verifier.traces.read import ClockWish, read_trace

NAME_ONE: Final = "name an arbiter's spec: --spec ARBITER.yaml"


@final
@dataclass(frozen=True, eq=False, slots=True)
class Explained:
    """An arbiter's decisions in a recording.

    name: `robot.node`, or the arbiter's own name where the log is no scenario's. source: the
    recording. margins: of every decision; None of an arbiter that has to run (a plan, a
    competition, code), of which no boundary is known.
    """

    name: str
    source: str
    moments: Moments
    margins: Margins | None
    stretches: tuple[Stretch, ...]

    @property
    def arbiter(self) -> Arbiter:
        """Whose decisions they are."""
        return self.moments.arbiter


def explain(
    recording: Path | str,
    spec: Path | str | None = None,
    nodes: Sequence[str] = (),
    *,
    allow_code: bool = False,
    clock: ClockWish = "auto",
    reading: Progress | None = None,
) -> tuple[Explained, ...]:
    """The decisions of the arbiters in a recording: of a scenario's run, or a log with `trace:`.

    Args:
        recording: the file.
        spec: a scenario, an architecture or an arbiter; None: what is attached, else the
            project's.
        nodes: `robot.node`, of a scenario's run; none for all arbiters.
        allow_code: whether arbiters that are code of the user's own may be run.
        clock: which stamps count, of a log.
        reading: is told now and then how many bytes of how many were read.

    Raises:
        SpecError: the recording or the spec can't be used, or there is no such arbiter (V423).
    """
    trace = Path(recording)
    program_of = partial(program_for_verify, allow_code=allow_code)
    named = None if spec is None else Path(spec)
    carried = carried_by(trace)
    if carried is not None:
        standard = standard_of(trace, carried, named, program_of)
        return _of_run(trace, carried, standard, nodes, allow_code=allow_code, reading=reading)
    arbiter = find_spec(trace, named, program_of).program
    if not isinstance(arbiter, Arbiter):
        message = f"'{arbiter.name}' is no arbiter: only what chooses has decisions to explain"
        raise fault("V423", trace, message, NAME_ONE)
    read = read_trace(trace, reader_of(arbiter), clock, reading)
    decisions = decisions_of(arbiter, read)
    beside = Path(arbiter.source.file).parent
    return (_explained(arbiter, arbiter.name, str(trace), decisions, beside, 0),)


def _of_run(
    trace: Path,
    carried: Carried,
    standard: Standard,
    nodes: Sequence[str],
    *,
    allow_code: bool,
    reading: Progress | None,
) -> tuple[Explained, ...]:
    """The arbiters of the recording of a scenario."""
    robots = {robot.name: robot.architecture for robot in standard.robots}
    wanted = _arbiters_in(trace, robots, standard, nodes)
    if not wanted:
        message = (
            f"'{standard.spec.name}' is no arbiter: only what chooses has decisions to explain"
        )
        raise fault("V423", trace, message, NAME_ONE)
    step = 0.0 if carried.document is None else carried.document.step
    log = open_run(trace, topics_of_nodes(robots), step, reading)
    records = records_of(log, robots)
    seed = 0 if carried.document is None else carried.document.seed
    found = []
    for robot, place in wanted:
        architecture, record = robots[robot], records[robot][place]
        arbiter = architecture.arbiters[architecture.nodes[place].arbiter]
        if not record.times.size:
            raise fault("V423", trace, f"the recording holds no decision of {record.name}")
        beside = standard.beside or Path(architecture.source.file).parent
        _refuse_code(trace, arbiter, record.name, allow_code=allow_code)
        found.append(_of_node(arbiter, record, trace, beside, seed))
    return tuple(found)


def _of_node(
    arbiter: Arbiter, record: NodeRecord, trace: Path, beside: Path, seed: int
) -> Explained:
    own, read = decision_log(arbiter, record, str(trace))
    decisions = decisions_of(own, read)
    since_start = Decisions(
        decisions.times + read.start,
        decisions.register,
        decisions.chosen,
        decisions.judged,
        decisions.exclusions,
    )
    return _explained(own, record.name, str(trace), since_start, beside, seed)


def _arbiters_in(
    trace: Path, robots: dict[str, Architecture], standard: Standard, nodes: Sequence[str]
) -> list[tuple[str, int]]:
    """Robot and place of each arbiter that is asked for.

    Raises:
        SpecError: there is none of that name, or none at all (V423).
    """
    known = {
        f"{robot}.{node.name}": (robot, place)
        for robot, architecture in robots.items()
        for place, node in enumerate(architecture.nodes)
        if node.arbiter >= 0
    }
    if not known:
        raise fault("V423", trace, "no robot in this recording has an arbiter")
    for name in nodes:
        if name not in known:
            remedy = did_you_mean(name, list(known)) or there_are(list(known))
            raise fault("V423", trace, f"no arbiter in it is '{name}'", remedy)
    only = standard.only
    names = nodes or [name for name in known if only is None or name in only]
    return [known[name] for name in names]


def _refuse_code(trace: Path, arbiter: Arbiter, name: str, *, allow_code: bool) -> None:
    """Stops before code of the user's own is run that nobody allowed.

    Raises:
        SpecError: it is not allowed (V336).
    """
    if arbiter.paradigm is Paradigm.MODULE and not allow_code:
        message = f"{name} decides by Python code, which is run only where it is allowed"
        raise fault("V336", trace, message, f"read {arbiter.module}, then add --allow-code")


def _explained(
    arbiter: Arbiter, name: str, source: str, decisions: Decisions, beside: Path, seed: int
) -> Explained:
    try:
        runs = running(arbiter, name, decisions.period, seed=seed, beside=beside)
        is_read = arbiter.paradigm in DRAWN
        chooser = None if is_read or runs is None else chooser_of(arbiter, runs)
        moments = moments_of(arbiter, decisions, chooser)
    except UserCodeError as error:
        raise fault("V382", arbiter.source.file, str(error), "mend that code") from error
    margins = whole_margins(moments) if is_read and decisions.times.size else None
    return Explained(name, source, moments, margins, stretches_of(moments, margins))


def cropped(found: Explained, start: float | None, end: float | None) -> Explained:
    """Only the stretches that reach into a span of time.

    Raises:
        SpecError: nothing was decided then (V424).
    """
    times = found.moments.decisions.times
    low = -np.inf if start is None else start
    high = np.inf if end is None else end
    if low > high or high < times[0] or low > times[-1]:
        raise outside(found, low, high)
    kept = tuple(each for each in found.stretches if each.end >= low and each.start <= high)
    return Explained(found.name, found.source, found.moments, found.margins, kept)


def outside(found: Explained, low: float, high: float) -> SpecError:
    """The error about a time of which the recording says nothing."""
    times = found.moments.decisions.times
    asked = f"{low:g} s" if low == high else f"{low:g} to {high:g} s"
    message = f"nothing was decided by {found.name} at {asked}"
    remedy = f"its decisions are from {times[0]:.6g} to {times[-1]:.6g} s"
    return fault("V424", found.source, message, remedy)
