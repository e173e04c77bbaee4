"""Why a scenario can't be run, as a diagnostic."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from runtime.scenario import Scenario
from runtime.user_code import UserCodeError
from runtime.world.chipmunk import OtherPhysicsError
from runtime.world.layout import NoRoomError
from spec_schema.diagnostics import SpecError
from specc.faults import fault

ALLOW: Final = "read that code, then run it with --allow-code"


@contextmanager
def told_failures(scenario: Scenario, allow: str) -> Iterator[None]:
    """Within it what keeps a scenario from running is told; allow: what lets its code run.

    Raises:
        SpecError: there is no room (V381), code of the user's own may not be run or fails (V382),
            or this machine's physics are others (V384).
    """
    try:
        yield
    except NoRoomError as error:
        raise _no_room(scenario, error) from error
    except OtherPhysicsError as error:
        remedy = "install pymunk 7.3.1, on a machine of 64 bits"
        raise fault("V384", scenario.source.file, str(error), remedy) from error
    except UserCodeError as error:
        raise fault("V382", scenario.source.file, str(error), allow) from error


def _no_room(scenario: Scenario, error: NoRoomError) -> SpecError:
    remedy = "or try another --seed"
    return fault("V381", error.origin or scenario.source.file, str(error), remedy)
