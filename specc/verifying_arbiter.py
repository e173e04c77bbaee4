"""A recording judged against the spec of an arbiter: does the robot choose as it says?"""

from collections.abc import Callable
from pathlib import Path

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter, Paradigm
from runtime.arbitration.build import arbiter_of
from runtime.arrays import Array
from runtime.user_code import Callee
from specc.faults import fault
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.reader import CHOICE
from verifier.report.examination import Examination
from verifier.traces.trace import Trace

SEED = 0
"""Of the chance that a competition takes."""


def arbiter_for_verify(path: Path) -> Arbiter:
    """An arbiter for `verify`, which runs nothing that a spec's author wrote.

    Raises:
        SpecError: the spec is wrong, or it decides by code (V336).
    """
    arbiter = compile_arbiter(path).arbiter
    if arbiter.paradigm is Paradigm.MODULE:
        message = "this arbiter decides by Python code, and verify runs nobody's code"
        remedy = "write its rules down, and judge those"
        raise fault("V336", path, message, remedy)
    return arbiter


def examine_arbiter(arbiter: Arbiter, trace: Trace, *, only_verdict: bool = False) -> Examination:
    """The verdict on the robot's decisions, and what explains it.

    Raises:
        SpecError: the choice, or something that is read, is not in the log (V310).
    """
    decides = running(arbiter, arbiter.name, _period(trace))
    made = judge_arbiter(arbiter, trace, decides, only_verdict=only_verdict)
    origins = {"fidelity": made.section.origin}
    return Examination(made.report, origins=origins, arbitration=made.section)


def running(arbiter: Arbiter, name: str, period: float) -> Callable[[Array, float], Array] | None:
    """One that decides tick by tick, of those that are no rules, under the name of its node."""
    if arbiter.paradigm in {Paradigm.RULES, Paradigm.SUBSUMPTION}:
        return None
    made = arbiter_of(arbiter, name, period, _no_code)
    made.reset(SEED)
    return made.decide


def _period(trace: Trace) -> float:
    """The mean time between two decisions."""
    choice = trace.series.get(CHOICE)
    if choice is None or choice.times.size < 2:
        return 0.1
    return float((choice.times[-1] - choice.times[0]) / (choice.times.size - 1))


def _no_code(name: str) -> Callee:
    raise AssertionError(f"{name}: verify runs nobody's code")
