"""A portrait in sentences: what was found, what is proved, what is not known."""

from runtime.arrays import Array
from specc.branches_text import branches_record, branches_summary
from specc.portraying import Found, Sweep
from verifier.topology.branches.continuation import Branches
from verifier.topology.features import (
    AxisRange,
    Basins,
    Cycle,
    FixedPoint,
    Portrait,
    Reaches,
    Separatrix,
    Standing,
)
from verifier.topology.portrait_json import as_json


def summary(found: Found) -> str:
    """What was found, for people."""
    match found:
        case Portrait():
            return portrait_summary(found)
        case Sweep():
            return "\n\n".join(map(portrait_summary, found.portraits))
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


def portrait_summary(portrait: Portrait) -> str:
    """Everything that a portrait found, one line each."""
    axes = ", ".join(axis.name for axis in portrait.axes)
    held = ", ".join(
        f"{h.name} = {h.label or f'{h.value / h.unit.scale:g}'}" for h in portrait.held
    )
    rows = [f"{portrait.name} over {axes}" + (f", at {held}" if held else "")]
    if not portrait.fixed_points:
        rows.append("  no fixed points found")
    rows += [f"  {_fixed_point(point, portrait)}" for point in portrait.fixed_points]
    rows += [f"  {_cycle(cycle, portrait)}" for cycle in portrait.cycles]
    rows += [f"  {_separatrix(branch, portrait)}" for branch in portrait.separatrices]
    if portrait.basins is not None:
        rows += [f"  {line}" for line in _basins(portrait.basins, portrait)]
    rows += [f"  {_sentence(text)}" for text in proof_sentences(portrait)]
    rows += [f"  {note}" for note in portrait.notes]
    return "\n".join(rows)


def proof_sentences(portrait: Portrait) -> list[str]:
    """What is proved of the fixed points, and what is not."""
    proof = portrait.completeness
    if not proof.about:
        return []
    proved = sum(point.proved for point in portrait.fixed_points)
    count = len(proof.undecided)
    if proof.complete:
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
    return f"{point.kind} at {_place(portrait.axes, point.at)}; eigenvalues {values}{told}"


def _place(axes: tuple[AxisRange, ...], at: Array) -> str:
    return ", ".join(
        f"{axis.name} = {value / axis.unit.scale + 0.0:.6g}"
        for axis, value in zip(axes, at.tolist(), strict=True)
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
    saddle = portrait.fixed_points[branch.saddle]
    which = "stable" if branch.stable else "unstable"
    way = "comes from" if branch.stable else "goes to"
    match branch.reaches:
        case Reaches.EDGE | Reaches.ITSELF:
            end = f"{way} {branch.reaches}"
        case Reaches.POINT:
            other = portrait.fixed_points[branch.to]
            end = f"{way} the {other.kind} at {_place(portrait.axes, other.at)}"
        case Reaches.CYCLE:
            cycle = portrait.cycles[branch.to]
            end = f"{way} the {cycle.stability} cycle of period {cycle.period:.6g} s"
        case Reaches.NOWHERE_SEEN:
            end = f"was {branch.reaches}"
    return f"{which} manifold of the saddle at {_place(portrait.axes, saddle.at)} {end}"


def _basins(basins: Basins, portrait: Portrait) -> list[str]:
    rows = []
    for attractor in basins.attractors:
        if attractor.is_cycle:
            cycle = portrait.cycles[attractor.index]
            name = f"cycle of period {cycle.period:.6g} s"
        else:
            point = portrait.fixed_points[attractor.index]
            name = f"{point.kind} at {_place(portrait.axes, point.at)}"
        rows.append(f"{_share(attractor.share)} of the domain goes to the {name}")
    if basins.leaves > 0.0:
        rows.append(f"{_share(basins.leaves)} of the domain leaves it")
    if basins.open > 0.0:
        rows.append(f"{_share(basins.open)} of the domain was not followed to an end")
    return rows


def _share(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-12 * max(1.0, abs(value)):
        return f"{value.real:.6g}"
    return f"{value.real:.6g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.6g}i"
