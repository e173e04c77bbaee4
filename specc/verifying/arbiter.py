"""A recording judged against the spec of an arbiter: does the robot choose as it says?"""

from pathlib import Path

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter, Paradigm
from runtime.arbitration.build import arbiter_of
from runtime.user_code import UserCodeError, load_callee, where_is
from specc.faults import fault
from verifier.arbitration.judging import judge_arbiter
from verifier.arbitration.misread import misread_in
from verifier.arbitration.numbers import Decide, Running
from verifier.arbitration.reader import CHOICE
from verifier.report.examination import Depth, Examination
from verifier.traces.trace import Trace

SEED = 0
"""Of the chance that a competition takes."""


def arbiter_for_verify(path: Path, *, allow_code: bool = False) -> Arbiter:
    """An arbiter for `verify`, which runs what a spec's author wrote only where that is allowed.

    Raises:
        SpecError: the spec is wrong, or it decides by code (V336).
    """
    arbiter = compile_arbiter(path).arbiter
    if arbiter.paradigm is Paradigm.MODULE and not allow_code:
        message = "this arbiter decides by Python code, which verify runs only where it is allowed"
        code = f"{arbiter.module} ({where_is(arbiter.module, path.parent)})"
        raise fault("V336", path, message, f"read {code}, then verify with --allow-code")
    return arbiter


def examine_arbiter(arbiter: Arbiter, trace: Trace, *, depth: Depth = "all") -> Examination:
    """The verdict on the robot's decisions, and what explains it.

    Raises:
        SpecError: the choice, or something that is read, is not in the log (V310), a reading is
            in another unit (V314), or the arbiter's own code fails (V382).
    """
    strange = misread_in(arbiter, trace)
    if strange is not None:
        raise fault("V314", trace.source, strange.reason, strange.advice)
    beside = Path(arbiter.source.file).parent
    try:
        decides = running(arbiter, arbiter.name, _period(trace), beside=beside)
        made = judge_arbiter(arbiter, trace, decides, depth=depth)
    except UserCodeError as error:
        raise fault("V382", arbiter.source.file, str(error), "mend that code") from error
    origins = {"fidelity": made.section.origin}
    return Examination(made.report, origins=origins, arbitration=made.section)


def running(
    arbiter: Arbiter, name: str, period: float, *, seed: int = SEED, beside: Path
) -> Running | None:
    """What makes one that decides tick by tick, of those that are no rules, under its node's name.

    seed: with that of a run, an arbiter that takes chances takes those that it took there.
    beside: the folder of its spec, where code of the user's own is found.

    Raises:
        UserCodeError: its code can't be found.
    """
    if arbiter.paradigm in {Paradigm.RULES, Paradigm.SUBSUMPTION}:
        return None

    def fresh(one: Arbiter) -> Decide:
        made = arbiter_of(one, name, period, lambda text: load_callee(text, beside))
        made.reset(seed)
        return made.decide

    return fresh


def _period(trace: Trace) -> float:
    """The mean time between two decisions."""
    choice = trace.series.get(CHOICE)
    if choice is None or choice.times.size < 2:
        return 0.1
    return float((choice.times[-1] - choice.times[0]) / (choice.times.size - 1))
