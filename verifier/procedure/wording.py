"""A test procedure in words, for who drives it: values in the user's units, a run to a line."""

from collections.abc import Mapping, Sequence

from runtime.program import Unit
from verifier.procedure.model import Drive, Excitation, Lateness, Planted, Procedure, Signal, Stage
from verifier.report.wording import exact, listed, number, percent, quantity, seconds


def procedure_sentences(procedure: Procedure) -> tuple[str, ...]:
    """All of it: the runs, what to log, what the rehearsal showed, what stays open."""
    return (
        *run_sentences(procedure),
        log_sentence(procedure),
        *excited_sentences(procedure),
        *rehearsal_sentences(procedure),
        *procedure.remarks,
    )


def run_sentences(procedure: Procedure) -> tuple[str, ...]:
    """`run 1: start with distance 0.5 m, heading -0.4 rad; run 8 s; twice in all` for each run."""
    return tuple(
        f"run {place}: {drive_phrase(procedure, drive)}"
        for place, drive in enumerate(procedure.drives, 1)
    )


def drive_phrase(procedure: Procedure, drive: Drive) -> str:
    """One run, its stages one after the other."""
    signals = {each.name: each for each in procedure.signals}
    start = listed([_at(signals[n], v) for n, v in drive.start.items() if n in signals])
    parts = [f"start with {start}" if start else "start anywhere"]
    standing = {n: v for n, v in drive.start.items() if n in signals and signals[n].is_sensed}
    for stage in drive.stages:
        parts.append(_stage(stage, standing, signals))
        standing = standing | stage.held
    if drive.repeats > 1:
        parts.append("twice in all" if drive.repeats == 2 else f"{drive.repeats} times in all")
    return "; ".join(parts)


def _stage(stage: Stage, standing: Mapping[str, float], signals: Mapping[str, Signal]) -> str:
    """`for 6 s with speed 0.2 m/s, bringing left from 0.4 to 1.2 m`."""
    changed = {n: v for n, v in stage.held.items() if standing.get(n) != v and n in signals}
    held = [_at(signals[n], v) for n, v in changed.items() if not signals[n].is_moved]
    moved = [
        f"{n} to {exact(v, signals[n].unit)}" for n, v in changed.items() if signals[n].is_moved
    ]
    told = f"run {seconds(stage.seconds)}"
    told += f" with {listed(held)}" if held else ""
    return told + (f", bringing {listed(moved)} evenly" if moved else "")


def _at(signal: Signal, value: float) -> str:
    if signal.values:
        return f"{signal.name} {signal.values[round(value)]}"
    return f"{signal.name} {exact(value, signal.unit)}"


def log_sentence(procedure: Procedure) -> str:
    """What to log, how often, and how quiet sensors have to be."""
    names = listed([each.name for each in procedure.signals])
    noisy = [
        f"{each.name} {quantity(each.noise, each.unit)}"
        for each in procedure.signals
        if each.noise > 0.0
    ]
    quiet = f"; sensors no noisier (standard deviation) than {listed(noisy)}" if noisy else ""
    return f"log {names} at {number(procedure.rate)} Hz{quiet}"


def excited_sentences(procedure: Procedure) -> tuple[str, ...]:
    """By how much each input shows."""
    units = {each.name: each.unit for each in procedure.signals}
    return tuple(
        _excited(each, units[each.name]) for each in procedure.excited if each.name in units
    )


def _excited(each: Excitation, unit: Unit) -> str:
    return (
        f"{each.name} from {exact(each.low, unit)} to {exact(each.high, unit)} moves what is judged"
        f" by {number(each.effect)} tolerances within {WITHIN}"
    )


WITHIN = "the horizon"
"""The time over which tolerances are stated."""


def rehearsal_sentences(procedure: Procedure) -> tuple[str, ...]:
    """What the verifier said of the procedure before anybody drove it."""
    found = procedure.rehearsal
    if found is None:
        return ()
    region = ""
    if procedure.required:
        region = (
            f" ({percent(found.share)} of the region seen, {percent(procedure.required)} asked)"
        )
    late = procedure.lateness
    timed = ""
    if late is not None:
        timed = f" that reads every {seconds(late.period)}"
        timed += f" and acts {seconds(late.response_time)} later" if late.response_time else ""
    told = (
        f"rehearsed in simulation with that noise, a faithful robot{timed} gets"
        f" {found.verdict.upper()}{region}"
    )
    units = {each.name: each.unit for each in procedure.signals}
    timing = () if late is None else (lateness_sentence(late),)
    return (told, *timing, *(_planted(each, units[each.variable]) for each in found.planted))


def lateness_sentence(late: Lateness) -> str:
    """What lateness is borne."""
    if late.share >= 1.0:
        return "being so late alone breaks a tolerance in these runs: build it faster"
    told = f"being so late alone takes up {percent(late.share)} of a tolerance at worst"
    if not late.slower:
        return told
    later = f"reading every {seconds(late.slower * late.period)}"
    if late.response_time:
        later += f" and acting {seconds(late.slower * late.response_time)} later"
    return f"{told}; {later} may break it"


def _planted(each: Planted, unit: Unit) -> str:
    return (
        f"a robot whose {each.variable} is carried {quantity(each.departure, unit)} away within"
        f" {WITHIN} gets {each.verdict.upper()}"
    )


def runs_in_words(procedure: Procedure, runs: Sequence[int]) -> tuple[str, ...]:
    """Some of the runs, by their numbers from 0, and what to log in them."""
    every = run_sentences(procedure)
    told = tuple(every[run] for run in runs)
    return (*told, f"in each run {log_sentence(procedure)}") if told else ()
