"""The mass that the feet of a thing feel, made the same in all directions; compiled for C.

The physics weighs the velocity of a foot by the mass felt there, which is less across the line to
the centre of mass than along it, since a force across turns the thing as well:
m / (1 + r² / gyration). It then limits the force. So the force of a foot that slides does not
point against its velocity, as friction does. With the least felt mass in all directions it does:
the physics repeats its small corrections until forces and velocities fit (Moreau 1977: of all
forces within the limit, the one of the greatest dissipation), and mass plays no part in that.

The numbers below say where Chipmunk's structures hold what, in words of 8 bytes.
`runtime.world.chipmunk` checks them before they are used.
"""

from collections.abc import Callable
from typing import Any, Final

import numba
import numba.extending

NUMBA: Any = numba  # its own types do not cover what is used of it here
types: Any = NUMBA.types

INVERSE_MASS: Final = 3
INVERSE_MOMENT: Final = 5
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

SIGNATURE: Final = "void(int64)"


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


def feel_evenly(body: int) -> None:
    """Let all feet of the body at this address feel the least mass in all directions.

    Called in each step between the physics' own working out of felt masses and its use of them,
    in the place of what would let gravity, forces and damping act, of which there are none here.
    All joints of the body must be feet, and the body the second in each.
    """
    inverse_mass, inverse_moment = reals(body)[INVERSE_MASS], reals(body)[INVERSE_MOMENT]
    joint = words(body)[JOINTS]
    while joint != 0:
        numbers = reals(joint)
        x, y = numbers[ARM], numbers[ARM + 1]
        numbers[FELT] = numbers[FELT + 3] = 1.0 / (inverse_mass + inverse_moment * (x * x + y * y))
        numbers[FELT + 1] = numbers[FELT + 2] = 0.0
        joint = words(joint)[NEXT]
