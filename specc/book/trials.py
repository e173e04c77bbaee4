"""How each module of a book is tested: what to record of it so that it can be verified."""

from dataclasses import dataclass
from typing import Final, final

from runtime.architecture import Architecture, Node
from runtime.user_code import UserCodeError
from spec_schema.diagnostics import SpecError
from verifier.procedure.behavior import procedure_of
from verifier.procedure.bench import bench_test
from verifier.procedure.bench_model import BenchTest
from verifier.procedure.model import Procedure


@final
@dataclass(frozen=True, slots=True)
class Trial:
    """The test procedure of a behavior, or that of an arbiter; without: why there is neither."""

    procedure: Procedure | None
    bench: BenchTest | None
    without: str


NO_TRIAL: Final = Trial(None, None, "nothing is promised that could be tested")


def trial_of(architecture: Architecture, node: Node) -> Trial:
    """How a node is tested, rehearsed."""
    if node.behavior >= 0:
        try:
            return Trial(procedure_of(architecture.programs[node.behavior]), None, "")
        except SpecError as error:
            return Trial(None, None, error.diagnostics[0].message)
    if node.arbiter < 0:
        return NO_TRIAL
    try:
        test = bench_test(architecture.arbiters[node.arbiter], node.period)
    except UserCodeError as error:
        return Trial(None, None, str(error))
    return NO_TRIAL if test is None else Trial(None, test, "")
