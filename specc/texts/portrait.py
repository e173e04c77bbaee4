"""A portrait in sentences: what was found, what is proved, what is not known."""

from dataclasses import replace

from specc.portraying import Found, Sweep
from specc.texts.branches import branches_record, branches_summary
from verifier.topology.branches.continuation import Branches
from verifier.topology.features import (
    Basins,
    Cycle,
    FixedPoint,
    Held,
    Portrait,
    Reaches,
    Separatrix,
    Standing,
)
from verifier.topology.names import attractor_names, cycle_names, place, point_name
from verifier.topology.portrait_json import as_json
from verifier.topology.words import share_words


def summary(found: Found) -> str:
    """What was found, for people."""
    match found:
        case Portrait():
            return portrait_summary(found)
        case Sweep():
            return _sweep_summary(found)
        case Branches():
            return branches_summary(found)


def record(found: Found) -> dict[str, object]:
    """The same for programs, in the user's units."""
    match found:
        case Portrait():
            return as_json(found)
        case Sweep():
            return {"swept": found.name, "portraits": [as_json(p) for p in found.portraits]}
        case Branches():
            return branches_record(found)


def _sweep_summary(found: Sweep) -> str:
    """Portrait by portrait; a note that is the same of all comes once, at the end."""
    first, *others = found.portraits
    common = [n for n in first.notes if all(n in other.notes for other in others)] if others else []
    parts = [
        portrait_summary(replace(p, notes=tuple(n for n in p.notes if n not in common)))
        for p in found.portraits
    ]
    if common:
        parts.append("\n".join(["all panels", *(f"  {note}" for note in common)]))
    return "\n\n".join(parts)


def portrait_summary(portrait: Portrait) -> str:
    """Everything that a portrait found, one line each."""
    axes = ", ".join(axis.name for axis in portrait.axes)
    held = ", ".join(f"{held.name} = {_value(held)}" for held in portrait.held)
    rows = [f"{portrait.name} over {axes}" + (f", at {held}" if held else "")]
    still = portrait.completeness.still
    if not portrait.fixed_points and not still and not _is_proved_empty(portrait):
        rows.append("  no fixed points found")
    rows += [f"  {_fixed_point(point, portrait)}" for point in portrait.fixed_points]
    rows += [f"  {_cycle(cycle, portrait)}" for cycle in portrait.cycles]
    rows += [f"  {_separatrix(branch, portrait)}" for branch in portrait.separatrices]
    if portrait.basins is not None:
        rows += [f"  {line}" for line in _basins(portrait.basins, portrait)]
    rows += [f"  {_sentence(text)}" for text in proof_sentences(portrait)]
    rows += [f"  {note}" for note in portrait.notes]
    return "\n".join(rows)


def _value(held: Held) -> str:
    """What is held: a number with its unit, or the name of a discrete value."""
    unit = "" if held.unit.text == "1" else f" {held.unit.text}"
    return held.label or f"{held.value / held.unit.scale:.6g}{unit}"


def _is_proved_empty(portrait: Portrait) -> bool:
    proof = portrait.completeness
    return proof.complete and bool(proof.about)


def proof_sentences(portrait: Portrait) -> list[str]:
    """What is proved of the fixed points, and what is not."""
    proof = portrait.completeness
    if not proof.about:
        return []
    proved = sum(point.proved for point in portrait.fixed_points)
    count = len(proof.undecided)
    if proof.still and count:
        sentences = [f"Proved of {proof.about}: {_beside_lines(count)}"]
    elif proof.complete:
        sentences = [f"Proved of {proof.about}: {_all_there_is(proved)}"]
    elif count:
        boxes = "one box" if count == 1 else f"{count} boxes"
        sentences = [
            f"Undecided in {boxes}; proved of {proof.about}: outside, {_all_there_is(proved)}"
        ]
    else:
        sentences = [f"Proved of {proof.about}: {_plural(proved, 'fixed point')}, perhaps not all"]
    lost = len(proof.lost)
    if lost:
        sentences.append(f"The tables lack {_plural(lost, 'fixed point')} of the formula")
    return sentences


def _beside_lines(count: int) -> str:
    boxes = "one box" if count == 1 else f"{count} boxes"
    return f"outside {boxes} along them there is no fixed point"


def _all_there_is(count: int) -> str:
    match count:
        case 0:
            return "there is no fixed point"
        case 1:
            return "there is exactly one fixed point"
        case _:
            return f"there are exactly {count} fixed points"


def _plural(count: int, what: str) -> str:
    return f"one {what}" if count == 1 else f"{count} {what}s"


def _sentence(text: str) -> str:
    return text[:1].lower() + text[1:]


def _fixed_point(point: FixedPoint, portrait: Portrait) -> str:
    values = ", ".join(_complex(value) for value in point.eigenvalues)
    remarks = []
    if point.standing is Standing.INVENTED:
        remarks.append(str(point.standing))
    if portrait.completeness.about and not point.proved:
        remarks.append("not proved")
    told = f" ({', '.join(remarks)})" if remarks else ""
    return (
        f"{point.kind} at {place(portrait.axes, point.at.tolist(), 6)}; eigenvalues {values}{told}"
    )


def _cycle(cycle: Cycle, portrait: Portrait) -> str:
    values = ", ".join(_complex(value) for value in cycle.multipliers)
    told = f"; multipliers {values}" if values else ""
    doubt = " (two methods disagree)" if cycle.doubtful else ""
    if portrait.every > 0.0:
        steps = len(cycle.points) - 1
        return f"{cycle.stability} orbit of period {steps} ({cycle.period:.6g} s){told}{doubt}"
    return f"{cycle.stability} cycle of period {cycle.period:.8g} s{told}{doubt}"


def _separatrix(branch: Separatrix, portrait: Portrait) -> str:
    """Where a branch of a saddle's manifold comes from or goes to."""
    which = "stable" if branch.stable else "unstable"
    way = "comes from" if branch.stable else "goes to"
    match branch.reaches:
        case Reaches.EDGE | Reaches.ITSELF:
            end = f"{way} {branch.reaches}"
        case Reaches.POINT:
            end = f"{way} the {point_name(portrait, branch.to)}"
        case Reaches.CYCLE:
            cycle = portrait.cycles[branch.to]
            end = f"{way} the {cycle.stability} {cycle_names(portrait)[branch.to]}"
        case Reaches.NOWHERE_SEEN:
            end = f"was {branch.reaches}"
    return f"{which} manifold of the {point_name(portrait, branch.saddle)} {end}"


def _basins(basins: Basins, portrait: Portrait) -> list[str]:
    rows = [
        f"{share_words(attractor.share, attractor.within)} of the domain goes to the {name}"
        for attractor, name in zip(basins.attractors, attractor_names(portrait), strict=True)
    ]
    if basins.leaves > 0.0:
        rows.append(f"{share_words(basins.leaves, basins.leaves_within)} of the domain leaves it")
    if basins.open > 0.0:
        off = share_words(basins.open, basins.open_within)
        rows.append(f"{off} of the domain was not followed to an end")
    return rows


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-12 * max(1.0, abs(value)):
        return f"{value.real:.6g}"
    return f"{value.real:.6g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.6g}i"
