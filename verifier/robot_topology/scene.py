"""What the comparison of features works on: the measured states, joined, and the spec's portrait.

T: samples of the slowest predicted state; m: axes, the predicted states.
"""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from runtime.arrays import Array, Integers
from runtime.program import Kind, Program
from verifier.fidelity.shooting.noise import plain_noise
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.changes import Changes
from verifier.fidelity.stretches.needs import Needs, changes_of
from verifier.fidelity.stretches.segments import segments_of
from verifier.robot_topology.settings import Setting, longest_setting
from verifier.topology.features import AxisRange, Portrait
from verifier.topology.scenes import Scenes

SHORTEST: Final = 8
"""A stretch of fewer samples shows nothing."""
MOST: Final = 100_000
"""Of a longer trace every second, third, ... sample is looked at."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Stretch:
    """Samples without a gap, at one setting: times (T,), values (T, m), angles unwrapped."""

    times: Array
    values: Array

    @property
    def step(self) -> float:
        """The median time from one sample to the next."""
        return float(np.median(np.diff(self.times)))


@final
@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """The trace at the setting that held longest, and the spec's portrait there.

    noise, tolerance (m,): of the axes; tolerance is infinite where none is declared. columns: of
    the axes in the state vector. changes: of the mode.
    """

    program: Program
    portrait: Portrait
    setting: Setting
    columns: tuple[int, ...]
    stretches: tuple[Stretch, ...]
    changes: Changes
    noise: Array
    tolerance: Array
    horizon: float

    @property
    def axes(self) -> tuple[AxisRange, ...]:
        """The axes of the portrait."""
        return self.portrait.axes

    @property
    def width(self) -> Array:
        """The widths of the domains, (m,)."""
        return np.array([axis.width for axis in self.axes])

    @property
    def turns(self) -> Array:
        """The period of each axis, 0 for one that is no angle."""
        return np.array([axis.width if axis.periodic else 0.0 for axis in self.axes])


def scene_of(program: Program, needs: Needs, study: Study | None) -> Scene:
    """The scene.

    Raises:
        SliceError: nothing moves by itself, or on more axes than a portrait has.
    """
    times = _base(needs)
    fidelity = program.fidelity
    horizon = 1.0 if fidelity is None else fidelity.horizon
    setting = longest_setting(program, needs, times, horizon)
    portrait = Scenes(program).at(setting.values, cycles=True, basins=False)
    declared = {} if fidelity is None else fidelity.tolerance
    return Scene(
        program=program,
        portrait=portrait,
        setting=setting,
        columns=needs.columns,
        stretches=_stretches(program, needs, times, setting),
        changes=changes_of(program, needs),
        noise=_noise(needs, study),
        tolerance=np.array([declared.get(axis.name, np.inf) for axis in portrait.axes]),
        horizon=horizon,
    )


def shortest(differences: Array, turns: Array) -> Array:
    """Differences (..., m) with angles on the shorter way round."""
    safe = np.where(turns > 0.0, turns, 1.0)
    return np.where(turns > 0.0, differences - safe * np.rint(differences / safe), differences)


def _base(needs: Needs) -> Array:
    """The samples of the slowest state while all of them are there."""
    first = max(float(series.times[0]) for series in needs.series)
    last = min(float(series.times[-1]) for series in needs.series)
    times = needs.series[needs.base].times
    inside = times[(times >= first) & (times <= last)]
    return np.asarray(inside[:: -(-len(inside) // MOST) or 1])


def _stretches(
    program: Program, needs: Needs, times: Array, setting: Setting
) -> tuple[Stretch, ...]:
    """Without gaps, inside the domain, and where the setting holds; modes may switch."""
    plain = replace(program, field=replace(program.field, mode="", guards=()))
    spans = segments_of(plain, needs, 0.0).spans
    values = np.stack([_at(needs, j, times) for j in range(len(needs.series))], axis=-1)
    inside = _which(spans, times)
    inside[~setting.holds] = -1
    cuts = np.flatnonzero(np.diff(inside) != 0) + 1
    parts = np.split(np.arange(len(times)), cuts)
    return tuple(
        Stretch(times[part], values[part])
        for part in parts
        if len(part) >= SHORTEST and inside[part[0]] >= 0
    )


def _at(needs: Needs, j: int, times: Array) -> Array:
    """The measured state j at `times`, unwrapped and interpolated."""
    state, series = needs.driven[j], needs.series[j]
    values = series.values
    if state.kind is Kind.PERIODIC:
        values = np.unwrap(values, period=state.high - state.low)
    return np.interp(times, series.times, values)


def _which(spans: Array, times: Array) -> Integers:
    """In which span each time lies, -1 for none."""
    found = np.full(len(times), -1)
    for i, (low, high) in enumerate(spans):
        found[(times >= low) & (times <= high)] = i
    return found


def _noise(needs: Needs, study: Study | None) -> Array:
    if study is not None:
        return np.array([noise.sigma for noise in study.noise])
    turns = [s.high - s.low if s.kind is Kind.PERIODIC else 0.0 for s in needs.driven]
    return np.array(
        [
            plain_noise(series.times, series.values, turn).sigma
            for series, turn in zip(needs.series, turns, strict=True)
        ]
    )
