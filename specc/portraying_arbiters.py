"""The portrait of an arbiter, from what a user gives: names, and numbers in their own units."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeAlias, final

from compiler.architecture.arbiters import compile_arbiter
from runtime.arbiter import Arbiter, Paradigm
from spec_schema.suggest import did_you_mean, there_are
from specc.faults import fault
from specc.given import Value, settings_for
from specc.portraying import MOST_PANELS, swept_values
from verifier.arbitration.reader import reader_of
from verifier.deciding.conditions import Values
from verifier.deciding.mattering import mattering
from verifier.deciding.plane import Axis, Plane, axis_of, plane_of
from verifier.deciding.rulings import DRAWN
from verifier.report.wording import listed, percent

MOST_AXES: Final = 2


@final
@dataclass(frozen=True, eq=False, slots=True)
class ArbiterPortrait:
    """What an arbiter decides where. why: what speaks for these axes, if nobody named them."""

    arbiter: Arbiter
    plane: Plane
    why: str


@final
@dataclass(frozen=True, eq=False, slots=True)
class ArbiterSweep:
    """Portraits over the same axes, at several values of `name`."""

    name: str
    portraits: tuple[ArbiterPortrait, ...]


FoundOfArbiter: TypeAlias = ArbiterPortrait | ArbiterSweep


def arbiter_portrait(
    spec: Arbiter | Path | str,
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
) -> ArbiterPortrait:
    """What an arbiter decides over one or two of its reads or controls, all else held.

    Without axes those two reads are taken that matter most.

    Raises:
        SpecError: it decides in a way that can't be drawn (V421), has no such axis (V422), or has
            no such name or value (V341, V342).
    """
    arbiter = spec if isinstance(spec, Arbiter) else compile_arbiter(Path(spec)).arbiter
    return _portrait(arbiter, axes, _settings(arbiter, held or {}))


def arbiter_sweep(
    spec: Arbiter | Path | str,
    name: str,
    values: str | Sequence[Value],
    axes: Sequence[str] | None = None,
    held: Mapping[str, Value] | None = None,
) -> ArbiterSweep:
    """The portraits at several values of a read or a control.

    values: a list, or a text as `0.1:0.8:6` (low, high, count), `5` (how many slices) or names.

    Raises:
        SpecError: as `arbiter_portrait`; or too many values, or another form of text.
    """
    arbiter = spec if isinstance(spec, Arbiter) else compile_arbiter(Path(spec)).arbiter
    reader = reader_of(arbiter)
    chosen = swept_values(reader, name, values) if isinstance(values, str) else values
    if not 1 <= len(chosen) <= MOST_PANELS:
        message = f"a sweep shows 1 to {MOST_PANELS} values (got {len(chosen)})"
        raise fault("V342", name, message, f"write {name}=LOW:HIGH:COUNT")
    each = [_settings(arbiter, {**(held or {}), name: value}) for value in chosen]
    if axes is None:
        base = {key: value for key, value in each[0].items() if key != name}
        axes, _ = _most_telling(arbiter, base, without=name)
    return ArbiterSweep(name, tuple(_portrait(arbiter, axes, settings) for settings in each))


def _settings(arbiter: Arbiter, held: Mapping[str, Value]) -> dict[str, float]:
    """SI values of reads and controls."""
    parts = [state for state in reader_of(arbiter).states if state.name != "choice"]
    return settings_for([*parts, *arbiter.controls], held, "read or control")


def _portrait(arbiter: Arbiter, axes: Sequence[str] | None, settings: Values) -> ArbiterPortrait:
    _refuse_undrawable(arbiter)
    why = ""
    if axes is None:
        axes, why = _most_telling(arbiter, settings)
    chosen = _axes(arbiter, axes)
    held = {name: value for name, value in settings.items() if name not in axes}
    return ArbiterPortrait(arbiter, plane_of(arbiter, chosen, held), why)


def _refuse_undrawable(arbiter: Arbiter) -> None:
    """Stops where what is decided depends on more than what is read.

    Raises:
        SpecError: it decides by a plan, a competition or code (V421).
    """
    if arbiter.paradigm in DRAWN:
        return
    match arbiter.paradigm:
        case Paradigm.PLAN:
            plan = "the plan's file" if arbiter.plan is None else arbiter.plan.source.file
            why, remedy = "a plan, whose mode remembers", f"draw the plan: specc portrait {plan}"
        case Paradigm.COMPETITION:
            why = "a competition, whose activations remember"
            remedy = "`specc explain` tells what was decided in a run"
        case _:
            why = "code, which may decide by anything"
            remedy = "`specc explain` tells what was decided in a run"
    message = f"this arbiter decides by {why}: no picture of what it reads shows what it decides"
    raise fault("V421", arbiter.source.file, message, remedy)


def _axes(arbiter: Arbiter, names: Sequence[str]) -> list[Axis]:
    """The axes by name.

    Raises:
        SpecError: one is none of its reads or controls, or there are too many (V422).
    """
    parts = {read.name: axis_of(read) for read in arbiter.reads}
    parts |= {control.name: axis_of(control) for control in arbiter.controls}
    file = arbiter.source.file
    for name in names:
        if name not in parts:
            remedy = did_you_mean(name, list(parts)) or there_are(list(parts))
            raise fault("V422", file, f"it neither reads '{name}' nor has a control of it", remedy)
    if not 1 <= len(names) <= MOST_AXES or len(set(names)) < len(names):
        message = f"an arbiter is drawn over one or two quantities (got {', '.join(names)})"
        raise fault("V422", file, message, "write --axes X,Y, and hold or sweep the others")
    return [parts[name] for name in names]


def _most_telling(arbiter: Arbiter, held: Values, *, without: str = "") -> tuple[list[str], str]:
    """The one or two reads that matter most, and why these.

    Raises:
        SpecError: nothing is read that could be an axis (V422).
    """
    _refuse_undrawable(arbiter)
    among = [read.name for read in arbiter.reads if read.name not in {*held, without}]
    if not among:
        message = "nothing that it reads is left to be an axis"
        raise fault("V422", arbiter.source.file, message, "hold fewer reads, or name --axes X,Y")
    shares = mattering(arbiter, held, among)
    best = sorted(among, key=lambda name: -shares[name])
    taken = [name for name in best[:MOST_AXES] if shares[name] > 0.0] or best[:1]
    told = [f"{name} in {percent(shares[name])}" for name in best if shares[name] > 0.0]
    if len(best) <= MOST_AXES:
        return taken, ""
    if not told:
        return taken, "no read alone changes what is decided"
    how = "another value of it alone changes what is decided (values at random over the domains)"
    which = "these matter most" if len(taken) > 1 else "this one matters most"
    return taken, f"{which}: {how}: {listed(told)}"
