"""How each module of a book is tested: what to record of it so that it can be verified."""

from dataclasses import dataclass
from typing import Final, final

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
