"""Where Chipmunk's structures hold what, in words of 8 bytes; and how kernels read it there.

Asked for one by one, the numbers of 80 bodies take ten times as long. `runtime.world.chipmunk`
checks the places below before any is used.
"""

from collections.abc import Callable
from typing import Any, Final

import numba
import numba.extending

NUMBA: Any = numba  # its own types do not cover what is used of it here
types: Any = NUMBA.types

INVERSE_MASS: Final = 3
INVERSE_MOMENT: Final = 5
VELOCITY: Final = 10
"""Of a body: the velocity of its centre of mass, x and y."""
HEADING: Final = 14
TURN: Final = 15
PLACE: Final = 21
"""Of a body: where its origin is, x and y."""
JOINTS: Final = 30
"""Of a body: the first of its joints."""

OTHER: Final = 2
OWN: Final = 3
"""Of a joint: its second body; a thing is the second of each of its joints."""
NEXT: Final = 5
"""Of a joint: the next joint of its second body."""
ARM: Final = 19
"""Of a joint: from the centre of mass of the second body to the foot, in the axes of the world."""
FELT: Final = 21
"""Of a joint: the mass felt there, a matrix of two by two."""


def _memory(kind: Any) -> Callable[..., Any]:
    """What makes numbers of this kind of the memory from an address on."""

    def typed(_typing: Any, address: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
            return builder.inttoptr(given[0], context.get_value_type(signature.return_type))

        return types.CPointer(kind)(address), generate

    made: Callable[..., Any] = NUMBA.extending.intrinsic(typed)
    return made


reals = _memory(types.float64)
words = _memory(types.int64)
