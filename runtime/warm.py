"""Compile every kernel once, with progress: the list of what there is to compile stands here."""

import hashlib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np

from runtime.arbitration.kernels.compete import compete
from runtime.code import Code
from runtime.flow import flow_of
from runtime.integrators import adaptive, fixed_steps
from runtime.interpolation import lookup, lookup_jacobian, tabulate
from runtime.intervals import Interval, exactly
from runtime.jets import SURE, Jet
from runtime.kernels.cache import SOURCES, cache_folder, mark_warm
from runtime.kernels.interpolate import block_address
from runtime.kernels.machine import machine_address
from runtime.machine import evaluate
from runtime.program import Field, Kind, Origin, Program, Role, State, Unit
from runtime.progress import Progress
from runtime.scheduler.inputs import Inputs
from runtime.scheduler.ticker import Ticker
from runtime.table import Axis, Method
from runtime.table_bounds import column_jets, columns_of
from runtime.world.geometry import Plan
from runtime.world.kernels import felt_mass, nearness
from runtime.world.kernels.bodies import largest_speeds, states
from runtime.world.kernels.cache import SOURCES as SENSES
from runtime.world.kernels.cache import address_for_c
from runtime.world.light import LightMap, Sources, light_at
from runtime.world.model import Light, Pose
from runtime.world.rays import NOBODY, View, first_hits, least_range, nearest_visible, parts_of

TABLE = tabulate(np.zeros((2, 1)), (Axis("x", 0.0, 1.0, 2, periodic=False),), Method.LINEAR)

NO_MOTION = Program(
    name="rest",
    about="",
    states=(
        State(
            *("x", Unit("1", 1.0), 0.0, 1.0, Role.BOTH, Kind.CONTINUOUS, 0.5),
            closure=None,
            values=(),
            relates=("", ""),
            about="",
            origin="",
        ),
    ),
    controls=(),
    constants=(),
    outputs=(),
    field=Field(("x",), "formula", 0.0, (), (), (), (Code("0"),), ""),
    fidelity=None,
    bindings=(),
    judge_when=None,
    realizes=(),
    feasibility=None,
    source=Origin("", "", ""),
)
START = np.zeros((1, 1))
TIMES = np.array([0.0, 1.0])


def _step() -> object:
    nothing = np.zeros((1, 1, 0)), np.zeros(0, dtype=np.int64)
    return fixed_steps(flow_of(NO_MOTION), START, TIMES, *nothing)


def _adapt() -> object:
    return adaptive(flow_of(NO_MOTION), START, np.zeros(0), TIMES, 1e-6, 1e-6)


def _bounds() -> object:
    box = Jet(Interval(np.zeros(1), np.ones(1)), exactly(np.ones((1, 1))), SURE)
    return column_jets(columns_of(TABLE), [box], 1, coarse=False)


def _senses() -> object:
    plan = Plan((), (), np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]))
    plan.place(np.zeros((0, 3)), 1)
    parts = parts_of(plan.geometry)
    sources = Sources([Light("", "", Pose(0.3, 0.3, 0.0), 1.0, 1.0, 1.0, "")], plan.geometry)
    eye, view = (0.2, 0.2, 0.1), View(1.0, 0.0, 0.0, 1.0)
    return (
        first_hits(parts, np.array([(0.2, 0.2, 1.0, 0.0)]), reach=1.0, height=0.1, skip=NOBODY),
        least_range(parts, (0.2, 0.2, 0.0), np.zeros(1), reach=1.0, height=0.1, skip=NOBODY),
        nearest_visible(parts, eye, view, sources.rows[:, :3].copy(), sources.owners, skip=NOBODY),
        light_at(parts, sources.rows, eye),
        LightMap(parts, sources, (0.0, 0.0, 1.0, 1.0), (2, 2), 0.0),
    )


def _gap() -> object:
    edges, circles = np.zeros((1, 4)), np.zeros((0, 3))
    far = nearness.gap(edges, circles, edges, circles, np.ones(1, dtype=np.bool_), np.inf)
    nobody = np.zeros(0, dtype=np.int64)
    return far, largest_speeds(nobody), states(nobody, np.zeros((0, 6)))


def _feet() -> object:
    return address_for_c(felt_mass.feel_evenly, felt_mass.SIGNATURE)


def _tick() -> object:
    inputs = Inputs((), {})
    ticker = Ticker(NO_MOTION, inputs, (), None, 1.0, np.random.default_rng(0))
    return ticker.tick(np.zeros(1), allowed=True), inputs.read(np.zeros(1))


def _competition() -> object:
    one = np.ones(1)
    return compete(one, one, np.ones((1, 1)), np.ones((1, 1)), 0.1, 0.1)


KERNELS: tuple[tuple[str, Callable[[], object]], ...] = (
    ("interpolation", block_address),
    ("table lookup", lambda: lookup(TABLE, [0.5])),
    ("table derivatives", lambda: lookup_jacobian(TABLE, [0.5])),
    ("bounds of tables", _bounds),
    ("machine", machine_address),
    ("expressions", lambda: evaluate([Code("x")], ("x",), START)),
    ("fixed steps", _step),
    ("adaptive steps", _adapt),
    ("rays and light", _senses),
    ("clearances", _gap),
    ("friction of feet", _feet),
    ("ticks of behaviors", _tick),
    ("competition", _competition),
)
"""Names, and small calls that compile; each kernel is compiled for one kind of arguments only."""


def is_warm() -> bool:
    """Whether every kernel was compiled and kept for this very copy of the sources."""
    mark = _mark()
    return mark is not None and mark.exists()


def warm(progress: Progress) -> None:
    """Compile and keep every kernel; `progress(name, done, total)` is called before each."""
    for done, (name, call) in enumerate(KERNELS):
        progress(name, done, len(KERNELS))
        call()
    progress("", len(KERNELS), len(KERNELS))
    mark_warm()
    mark = _mark()
    if mark is not None:
        with suppress(OSError):
            mark.touch()


def _mark() -> Path | None:
    """The file that says so; None where nothing can be kept.

    numba finds machine code by the path of a source file and by when that was changed. So what was
    compiled from one clone serves no other, though the text, and with it the folder, is the same.
    """
    folder = cache_folder()
    if folder is None:
        return None
    digest = hashlib.sha256()
    for path in sorted([*SOURCES.glob("*.py"), *SENSES.glob("*.py")]):
        digest.update(f"{path} {path.stat().st_mtime_ns}\0".encode())
    return folder / f"warm-{digest.hexdigest()[:16]}"
