"""The physics' own C functions, called without a detour where they are called in every step.

pymunk's methods check and wrap what they are given, and its batches build a request for each call:
of a step in which little moves that is the larger part. What is used here pymunk has not promised
to keep; nothing else uses it, and tests compare each with the method that is promised.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, Final, final

import numpy as np
import pymunk
from pymunk._chipmunk_cffi import ffi, lib
from pymunk.batch import ArbiterFields, BodyFields

from runtime.arrays import Array, Integers
from runtime.world.kernels import felt_mass
from runtime.world.kernels.cache import address_for_c

C: Final[Any] = lib
"""Chipmunk's functions; they have no types."""


def stepper(space: pymunk.Space) -> Callable[[float], None]:
    """What lets so many seconds pass in one step; after the first, which checks what was added."""
    raw, step = space._space, C.cpSpaceStep  # noqa: SLF001 (see above)
    return lambda seconds: step(raw, seconds)


def aimer(body: pymunk.Body) -> Callable[[float, float], None]:
    """What sets the velocity of a body to (x, y)."""
    raw, aim = body._body, C.cpBodySetVelocity  # noqa: SLF001 (see above)
    return lambda x, y: aim(raw, (x, y))


def compass(body: pymunk.Body) -> Callable[[float], float]:
    """What tells the heading at which a body will be in so many seconds, as it turns now."""
    raw, heading, turn = body._body, C.cpBodyGetAngle, C.cpBodyGetAngularVelocity  # noqa: SLF001
    return lambda seconds: heading(raw) + turn(raw) * seconds


def finder(body: pymunk.Body) -> Callable[[], tuple[float, float, float]]:
    """What tells where the origin of a body is, and its heading."""
    raw, place, heading = body._body, C.cpBodyGetPosition, C.cpBodyGetAngle  # noqa: SLF001

    def find() -> tuple[float, float, float]:
        at = place(raw)
        return at.x, at.y, heading(raw)

    return find


def feel_evenly(body: pymunk.Body) -> None:
    """Let the feet of a body, its only joints, feel the same mass in all directions.

    Raises:
        RuntimeError: Chipmunk's structures hold things elsewhere than this relies on.
    """
    C.cpBodySetVelocityUpdateFunc(body._body, _feeling())  # noqa: SLF001 (see above)


@cache
def _feeling() -> Any:
    """The compiled function, once it is sure that it writes where it should."""
    if not _is_laid_out_as_known():
        raise RuntimeError(
            f"pymunk {pymunk.version} keeps bodies and joints in memory otherwise than the physics "
            "of worlds relies on; install pymunk 7.3.1"
        )
    address = address_for_c(felt_mass.feel_evenly, felt_mass.SIGNATURE)
    return ffi.cast("cpBodyVelocityFunc", address)


def _is_laid_out_as_known() -> bool:
    """Whether a body with two joints is in memory as `felt_mass` says; nothing is written."""
    mass, moment, (x, y) = 3.0, 7.0, (0.3, 0.4)
    space, body = pymunk.Space(), pymunk.Body(mass, moment)
    before, foot = (
        pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), at) for at in ((-0.5, 0.2), (x, y))
    )
    space.add(body, before, foot)
    space.step(1.0)
    other, own = space.static_body._body, body._body  # noqa: SLF001 (see above)
    first, second = before._constraint, foot._constraint  # noqa: SLF001
    ours, joint = _memory(own, felt_mass.JOINTS + 1), _memory(second, felt_mass.FELT + 4)
    links = (
        (ours[1][felt_mass.JOINTS], second),
        (joint[1][felt_mass.OTHER], other),
        (joint[1][felt_mass.OWN], own),
        (joint[1][felt_mass.NEXT], first),
    )
    if any(word != int(ffi.cast("intptr_t", at)) for word, at in links):
        return False
    felt = np.linalg.inv(np.eye(2) / mass + np.outer((-y, x), (-y, x)) / moment)
    found = (ours[0][felt_mass.INVERSE_MASS], ours[0][felt_mass.INVERSE_MOMENT])
    return bool(
        np.allclose(found, (1.0 / mass, 1.0 / moment))
        and np.allclose(joint[0][felt_mass.ARM :][:2], (x, y))
        and np.allclose(joint[0][felt_mass.FELT :], felt.ravel())
    )


def _memory(at: Any, words: int) -> tuple[Array, Integers]:
    """So many words of 8 bytes, as real numbers and as whole ones."""
    copied = bytes(ffi.buffer(ffi.cast("char *", at), 8 * words))
    return np.frombuffer(copied, dtype=np.float64), np.frombuffer(copied, dtype=np.int64)


@final
class Bodies:
    """Some numbers of every body of a space, in its own order, which changes."""

    def __init__(self, space: pymunk.Space, fields: BodyFields, width: int) -> None:
        """width: how many real numbers the fields are."""
        self._space, self._width = space._space, width  # noqa: SLF001 (see above)
        self._visit = ffi.addressof(lib, "pmSpaceBodyGetIteratorFuncBatched")
        self._request = _Request(fields.value)
        self._seen: Array = np.zeros((0, width))
        self._seen_at: tuple[Any, int] = (None, 0)

    def read(self) -> Array:
        """The real numbers (n, width) as of now; the next call overwrites them."""
        request = self._request
        request.reals.num = request.whole.num = 0
        C.cpSpaceEachBody(self._space, self._visit, request.data)
        at = (request.reals.arr, request.reals.num)
        if at != self._seen_at:
            buffer = ffi.buffer(at[0], at[1] * ffi.sizeof("cpFloat"))
            self._seen = np.frombuffer(buffer, dtype=np.float64).reshape(-1, self._width)
            self._seen_at = at
        return self._seen

    def order(self) -> bytes:
        """The identities of the bodies that were read last, as machine words."""
        whole = self._request.whole
        return bytes(ffi.buffer(whole.arr, whole.num * ffi.sizeof("uintptr_t")))


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
        self.reals: Any = C.pmFloatArrayNew(0)
        self.whole: Any = C.pmIntArrayNew(0)
        self.data: Any = ffi.new("pmBatchedData *")
        self.data.fields, self.data.floatArray, self.data.intArray = fields, self.reals, self.whole
