"""The physics' own C functions, called without a detour where they are called in every step.

pymunk's methods check and wrap what they are given, and its batches build a request for each call:
of a step in which little moves that is the larger part. Bodies and feet are read in memory. What is
used here pymunk has not promised to keep; nothing else uses it, the places in memory are looked up
on a body of known numbers first, and tests compare each with the method that is promised.
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, Final, final

import numpy as np
import pymunk
from pymunk._chipmunk_cffi import ffi, lib
from pymunk.batch import ArbiterFields

from runtime.arrays import Array, Integers
from runtime.direct_calls import machine_code
from runtime.world.kernels import felt_mass, memory
from runtime.world.kernels.bodies import largest_speeds, states
from runtime.world.kernels.cache import address_for_c

C: Final[Any] = lib
"""Chipmunk's functions; they have no types."""


def stepper(space: pymunk.Space) -> Callable[[float], None]:
    """What lets so many seconds pass in one step; after the first, which checks what was added."""
    raw, step = space._space, C.cpSpaceStep  # noqa: SLF001 (see above)
    return lambda seconds: step(raw, seconds)


def aimer(body: pymunk.Body) -> Callable[[float, float], None]:
    """What sets the velocity of a kinematic body to (x, y); one that may sleep must be woken."""
    velocity = _numbers(body)[memory.VELOCITY :]

    def aim(x: float, y: float) -> None:
        velocity[0], velocity[1] = x, y

    return aim


def compass(body: pymunk.Body) -> Callable[[float], float]:
    """What tells the heading at which a body will be in so many seconds, as it turns now."""
    numbers, heading, turn = _numbers(body), memory.HEADING, memory.TURN
    return lambda seconds: numbers[heading] + numbers[turn] * seconds


def finder(body: pymunk.Body) -> Callable[[], tuple[float, float, float]]:
    """What tells where the origin of a body is, and its heading."""
    numbers, x, y, heading = _numbers(body), memory.PLACE, memory.PLACE + 1, memory.HEADING
    return lambda: (numbers[x], numbers[y], numbers[heading])


def feel_evenly(body: pymunk.Body) -> None:
    """Let the feet of a body, its only joints, feel the same mass in all directions.

    Raises:
        RuntimeError: Chipmunk's structures hold things elsewhere than this relies on.
    """
    make_sure()
    C.cpBodySetVelocityUpdateFunc(body._body, _feeling())  # noqa: SLF001 (see above)


@final
class OtherPhysicsError(RuntimeError):
    """A pymunk, or a machine, with which worlds can't be run."""


@cache
def _feeling() -> Any:
    """The compiled function, for C."""
    address = address_for_c(felt_mass.feel_evenly, felt_mass.SIGNATURE)
    return ffi.cast("cpBodyVelocityFunc", address)


@cache
def make_sure() -> None:
    """See that the physics keeps in memory what kernels look for where they look for it.

    Raises:
        OtherPhysicsError: it does not.
    """
    if not _is_laid_out_as_known():
        raise OtherPhysicsError(
            f"pymunk {pymunk.version} keeps bodies and joints in memory otherwise than the physics "
            "of worlds relies on"
        )


def _is_laid_out_as_known() -> bool:
    """Whether a body with two joints is in memory as `memory` says; nothing is written."""
    mass, moment, (x, y) = 3.0, 7.0, (0.3, 0.4)
    space, body = pymunk.Space(), pymunk.Body(mass, moment)
    body.center_of_gravity, body.position = (0.1, 0.2), (1.0, 2.0)
    feet = tuple(
        pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), at) for at in ((-0.5, 0.2), (x, y))
    )
    space.add(body, *feet)
    space.step(1.0)
    body.velocity, body.angular_velocity, body.angle = (5.0, 6.0), 8.0, 0.5
    other, own = space.static_body._body, body._body  # noqa: SLF001 (see above)
    before, last = (foot._constraint for foot in feet)  # noqa: SLF001
    ours, joint = _words(own, memory.JOINTS + 1), _words(last, memory.FELT + 4)
    links = (
        (ours[memory.JOINTS], last),
        (joint[memory.OTHER], other),
        (joint[memory.OWN], own),
        (joint[memory.NEXT], before),
    )
    if any(word != _address(of) for word, of in links):
        return False
    mine, its = ours.view(np.float64), joint.view(np.float64)
    arm = np.array((x, y)) - body.center_of_gravity
    across = np.array((-arm[1], arm[0]))
    expected: tuple[tuple[Array, Any], ...] = (
        (mine[memory.INVERSE_MASS :][:1], 1.0 / mass),
        (mine[memory.INVERSE_MOMENT :][:1], 1.0 / moment),
        (mine[memory.PLACE :][:2], body.position),
        (mine[memory.VELOCITY :][:2], body.velocity),
        (mine[memory.HEADING :][:1], body.angle),
        (mine[memory.TURN :][:1], body.angular_velocity),
        (its[memory.ARM :][:2], arm),
        (
            its[memory.FELT :],
            np.linalg.inv(np.eye(2) / mass + np.outer(across, across) / moment).ravel(),
        ),
    )
    return all(np.allclose(found, wanted) for found, wanted in expected)


def _address(of: Any) -> int:
    return int(ffi.cast("intptr_t", of))


def _words(of: Any, count: int) -> Integers:
    """So many words of 8 bytes from where a structure begins, as they are now."""
    return np.frombuffer(bytes(ffi.buffer(ffi.cast("char *", of), 8 * count)), dtype=np.int64)


def _numbers(body: pymunk.Body) -> "memoryview[float]":
    """The memory of a body itself, as real numbers; who keeps them keeps the body there."""
    make_sure()
    return memoryview(ffi.buffer(body._body, 8 * memory.JOINTS)).cast("d")  # noqa: SLF001


@final
class Bodies:
    """Some bodies, of which numbers are read; they stay where they are in memory."""

    def __init__(self, bodies: Sequence[pymunk.Body]) -> None:
        """Note where they are; they are kept as long as this is.

        Raises:
            RuntimeError: Chipmunk's structures hold things elsewhere than this relies on.
        """
        make_sure()
        self._bodies = tuple(bodies)
        at = [_address(body._body) for body in bodies]  # noqa: SLF001 (see above)
        self._at: Integers = np.array(at, dtype=np.int64)
        self._states = machine_code(states, (self._at, np.zeros((1, 6))))
        self._largest = machine_code(largest_speeds, (self._at,))

    def states(self) -> Array:
        """Of all (n, 6): x, y, heading; velocity of the centre of mass x, y; turn rate."""
        found = np.empty((len(self._at), 6))
        self._states(self._at, found)
        return found

    def largest_speeds(self) -> tuple[float, float, float]:
        """The largest amount of velocity x, velocity y, and turn rate, each alone."""
        return self._largest(self._at)


@final
class Contacts:
    """Some numbers of every contact of a space, in an order that means nothing."""

    def __init__(self, space: pymunk.Space, fields: ArbiterFields) -> None:
        self._space = space._space  # noqa: SLF001 (see above)
        self._visit = ffi.addressof(lib, "pmSpaceArbiterIteratorFuncBatched")
        self._request = _Request(fields.value)

    def read(self) -> list[float]:
        """The real numbers as of now, of one contact after the other."""
        request = self._request
        reals = request.reals
        reals.num = request.whole.num = 0
        C.cpSpaceEachCachedArbiter(self._space, self._visit, request.data)
        return ffi.unpack(reals.arr, reals.num) if reals.num else []

    def whole(self) -> list[int]:
        """The whole numbers that were read last."""
        whole = self._request.whole
        return ffi.unpack(whole.arr, whole.num) if whole.num else []


@final
class _Request:
    """A request for some fields, and room for the answer, which grows as it must."""

    def __init__(self, fields: int) -> None:
        self.reals: Any = ffi.gc(C.pmFloatArrayNew(0), C.pmFloatArrayFree)
        self.whole: Any = ffi.gc(C.pmIntArrayNew(0), C.pmIntArrayFree)
        self.data: Any = ffi.new("pmBatchedData *")
        self.data.fields, self.data.floatArray, self.data.intArray = fields, self.reals, self.whole
