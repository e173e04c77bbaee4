"""The mass that the feet of a thing feel, made the same in all directions; compiled for C.

The physics weighs the velocity of a foot by the mass felt there, which is less across the line to
the centre of mass than along it, since a force across turns the thing as well:
m / (1 + r² / gyration). It then limits the force. So the force of a foot that slides does not
point against its velocity, as friction does. With the least felt mass in all directions it does:
the physics repeats its small corrections until forces and velocities fit (Moreau 1977: of all
forces within the limit, the one of the greatest dissipation), and mass plays no part in that.
"""

from typing import Final

from runtime.world.kernels.memory import (
    ARM,
    FELT,
    INVERSE_MASS,
    INVERSE_MOMENT,
    JOINTS,
    NEXT,
    reals,
    words,
)

SIGNATURE: Final = "void(int64)"


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
