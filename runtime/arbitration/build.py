"""From a compiled arbiter to one that decides: one line for each paradigm."""

from collections.abc import Callable

from runtime.arbiter import Arbiter as Compiled
from runtime.arbiter import Paradigm
from runtime.arbitration.competition import Competing
from runtime.arbitration.module import FunctionArbiter, ObjectArbiter
from runtime.arbitration.plan import Plan
from runtime.arbitration.protocol import Arbiter
from runtime.arbitration.rules import Rules, Subsumption
from runtime.arbitration.weights import Weights
from runtime.user_code import Callee


def arbiter_of(
    compiled: Compiled, name: str, period: float, code: Callable[[str], Callee]
) -> Arbiter:
    """The arbiter `name` that decides every `period` seconds; call `reset` before its first run.

    code: gives what `package.module:name` names, for one of the user's own.

    Raises:
        UserCodeError: its code may not be run, or can't be found.
    """
    match compiled.paradigm:
        case Paradigm.RULES:
            return Rules(compiled)
        case Paradigm.SUBSUMPTION:
            return Subsumption(compiled)
        case Paradigm.WEIGHTS:
            return Weights(compiled)
        case Paradigm.COMPETITION:
            return Competing(compiled, name, period)
        case Paradigm.PLAN:
            return Plan(compiled, name, period)
        case Paradigm.MODULE:
            found = code(compiled.module)
            is_class = isinstance(found, type)
            return ObjectArbiter(compiled, found) if is_class else FunctionArbiter(compiled, found)
