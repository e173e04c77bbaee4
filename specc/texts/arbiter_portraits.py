"""The portrait of an arbiter in sentences: which choice holds where, by which rule."""

from collections.abc import Sequence

import numpy as np

from runtime.arbiter import Arbiter, Paradigm
from runtime.arrays import Array
from runtime.program import Unit
from specc.portraying_arbiters import ArbiterPortrait, ArbiterSweep, FoundOfArbiter
from specc.texts.arbiters import rule_sentences, word_of
from verifier.deciding.plane import Axis
from verifier.deciding.rulings import NOTHING, Ruling
from verifier.report.wording import exact, percents, seconds

TRACED = "Boundaries that are no lines are followed from point to point, a 96th of an axis apart"


def summary_of_arbiter(found: FoundOfArbiter) -> str:
    """What was found, for people."""
    match found:
        case ArbiterPortrait():
            return portrait_text(found)
        case ArbiterSweep():
            return "\n\n".join(portrait_text(each) for each in found.portraits)


def record_of_arbiter(found: FoundOfArbiter) -> dict[str, object]:
    """The same for programs, in the user's units."""
    match found:
        case ArbiterPortrait():
            return _record(found)
        case ArbiterSweep():
            return {"swept": found.name, "portraits": [_record(each) for each in found.portraits]}


def portrait_text(found: ArbiterPortrait) -> str:
    """Each ruling with its share of what is drawn."""
    plane, arbiter = found.plane, found.arbiter
    axes = ", ".join(axis.name for axis in plane.axes)
    held = held_phrase(found)
    rows = [f"{arbiter.name} over {axes}" + (f", at {held}" if held else "")]
    if found.why:
        rows.append(f"  {found.why}")
    shares = percents([plane.share_of(k) for k in range(len(plane.rulings))])
    for ruling, share in zip(plane.rulings, shares, strict=True):
        rows.append(f"  {share:>5}  {ruling_phrase(arbiter, ruling)}")
    held_set = {c.name: plane.held.get(c.name, c.default) for c in arbiter.controls}
    rows += [
        f"  {word_of(arbiter)} {rule.number}: {rule.sentence}"
        for rule in rule_sentences(arbiter, held_set)
        if any(rule.number - 1 in ruling.places for ruling in plane.rulings)
    ]
    return "\n".join([*rows, *(f"  {note}" for note in notes_of(found))])


def ruling_phrase(arbiter: Arbiter, ruling: Ruling) -> str:
    """`flee (rule 1)`; of a band `flee if it held already (rule 1), else go (rule 2)`."""
    if not ruling.places:
        return choice_name(arbiter, ruling.choices[0])
    parts = []
    for place in ruling.places:
        if place == NOTHING:
            parts.append("nothing (none holds)")
            continue
        name = arbiter.choices[arbiter.rules[place].choice]
        parts.append(f"{name} ({word_of(arbiter)} {place + 1})")
    *before, last = parts
    if not before:
        return last
    return f"{' or '.join(before)} if it held already, else {last}"


def choice_name(arbiter: Arbiter, choice: int) -> str:
    """Of a choice, or of none."""
    return "nothing" if choice == NOTHING else arbiter.choices[choice]


def held_phrase(found: ArbiterPortrait, without: Sequence[str] = ()) -> str:
    """What is held: `used = 0.5, lamp = hidden`."""
    axes = {part.name: part for part in found.arbiter.reads if part.values}
    units = units_of(found.arbiter)
    told = []
    for name, value in found.plane.held.items():
        if name in without:
            continue
        is_named = name in axes
        text = axes[name].values[round(value)] if is_named else exact(value, units[name])
        told.append(f"{name} = {text}")
    return ", ".join(told)


def units_of(arbiter: Arbiter) -> dict[str, Unit]:
    """Of reads and controls."""
    units = {read.name: read.unit for read in arbiter.reads}
    return units | {control.name: control.unit for control in arbiter.controls}


def notes_of(found: ArbiterPortrait) -> list[str]:
    """What the areas do not show."""
    arbiter, plane = found.arbiter, found.plane
    drawn = {place for ruling in plane.rulings for place in ruling.places if place != NOTHING}
    notes = [
        f"once begun, {word_of(arbiter)} {p + 1} holds for {seconds(arbiter.rules[p].lasts)}"
        " at least, outside its area, too"
        for p in sorted(drawn)
        if arbiter.rules[p].lasts > 0.0
    ]
    if arbiter.paradigm is Paradigm.SUBSUMPTION:
        notes.append("the highest layer that holds is shown; those below act where it leaves room")
    if not plane.is_exact:
        notes.append(TRACED)
    return notes


def _record(found: ArbiterPortrait) -> dict[str, object]:
    plane, arbiter = found.plane, found.arbiter
    units = units_of(arbiter)
    scales = np.array([*(axis.unit.scale for axis in plane.axes), 1.0][:2])

    def in_units(points: Array) -> object:
        return (points / scales).tolist()

    return {
        "name": arbiter.name,
        "spec": arbiter.source.file,
        "axes": [_axis(axis) for axis in plane.axes],
        "why_these_axes": found.why or None,
        "held": {name: value / units[name].scale for name, value in plane.held.items()},
        "rulings": [
            {
                "choices": [choice_name(arbiter, choice) for choice in ruling.choices],
                "rules": [place + 1 for place in ruling.places if place != NOTHING],
                "depends_on_what_held": ruling.is_band,
                "share": plane.share_of(k),
                "told": ruling_phrase(arbiter, ruling),
            }
            for k, ruling in enumerate(plane.rulings)
        ],
        "areas": [
            {
                "ruling": area.ruling,
                "share": area.share,
                "rings": [in_units(ring) for ring in area.rings],
            }
            for area in plane.areas
        ],
        "borders": [
            {"rulings": list(border.rulings), "points": in_units(border.points)}
            for border in plane.borders
        ],
        "exact": plane.is_exact,
        "notes": notes_of(found),
    }


def _axis(axis: Axis) -> dict[str, object]:
    low, high = axis.low / axis.unit.scale, axis.high / axis.unit.scale
    return {
        "name": axis.name,
        "unit": axis.unit.text,
        "domain": [low, high],
        "values": list(axis.values),
    }
