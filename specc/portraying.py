"""A phase portrait, from what a user gives: names, and numbers in the variables' own units."""

from collections.abc import Mapping, Sequence

from runtime.program import Control, Program, State
from specc.faults import fault
from specc.given import Value, settings_for
from verifier.topology.features import Portrait
from verifier.topology.portrait import portrait as look
from verifier.topology.slices import SliceError


def portrait(
    program: Program,
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
) -> Portrait:
    """The phase portrait over two states (or the only one), as numbers.

    Raises:
        SpecError: an axis or a name that it does not have, or a value outside its domain.
    """
    parts: tuple[State | Control, ...] = (*program.states, *program.controls)
    settings = settings_for(parts, held or {}, "state or control")
    try:
        return look(program, None if axes is None else tuple(axes), settings)
    except SliceError as error:
        raise fault("V346", program.source.file, str(error)) from error
