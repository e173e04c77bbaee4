"""The topology of a portrait as tables: what a robot's own field must have, too."""

from collections.abc import Sequence
from typing import Final

from specc.book.chapters import Block, Bullets, Paragraph, Table
from specc.figures.quantities import number, seconds
from specc.texts.portrait import proof_sentences
from verifier.topology.features import Basins, Cycle, FixedPoint, PointKind, Portrait, Standing
from verifier.topology.names import attractor_names, cycle_names, place
from verifier.topology.words import share_words

MOST: Final = 3
"""Degenerate points that are listed; of more it is said how many there are."""


def topology_blocks(portrait: Portrait) -> tuple[Block, ...]:
    """Fixed points, cycles and basins, each in a table, and what is proved."""
    blocks: list[Block] = []
    points = portrait.fixed_points
    if points:
        titles = ("fixed point", "at", "eigenvalues, 1/s", "known by")
        if portrait.every > 0.0:
            titles = ("fixed point", "at", "multipliers per step", "known by")
        shown = _telling(points)
        blocks.append(Table(titles, tuple(_point(each, portrait) for each in shown)))
        if len(points) > len(shown):
            more = f"And {len(points) - len(shown)} more, which are degenerate like the last ones."
            blocks.append(Paragraph(more, is_small=True))
    if portrait.cycles:
        rows = tuple(
            _cycle(name, each)
            for name, each in zip(cycle_names(portrait), portrait.cycles, strict=True)
        )
        blocks.append(Table(("cycle", "stability", "period", "multipliers"), rows))
    if portrait.basins is not None:
        rows = tuple(_shares(portrait, portrait.basins))
        blocks.append(Table(("of the domain shown", "goes to"), rows))
    told = [*proof_sentences(portrait), *(_capital(note) for note in portrait.notes)]
    if not points and not portrait.completeness.about and not portrait.completeness.still:
        told.insert(0, "No fixed points were found")
    if told:
        blocks.append(Bullets(tuple(f"{_capital(text)}." for text in told)))
    return tuple(blocks)


def _telling(points: Sequence[FixedPoint]) -> list[FixedPoint]:
    """Those with a type first; of curves of degenerate ones a few."""
    typed = [point for point in points if point.kind is not PointKind.DEGENERATE]
    others = [point for point in points if point.kind is PointKind.DEGENERATE]
    return typed + others[:MOST]


def _point(point: FixedPoint, portrait: Portrait) -> tuple[str, ...]:
    values = ", ".join(map(_complex, point.eigenvalues)) or "none: no derivative there"
    known = "proof" if point.proved else "search"
    if point.standing is Standing.INVENTED:
        known += f", {point.standing}"
    return (str(point.kind), place(portrait.axes, point.at.tolist(), 5), values, known)


def _cycle(name: str, cycle: Cycle) -> tuple[str, ...]:
    values = ", ".join(map(_complex, cycle.multipliers)) or "–"
    doubt = " (two methods disagree)" if cycle.doubtful else ""
    return (name, f"{cycle.stability}{doubt}", seconds(cycle.period), values)


def _shares(portrait: Portrait, basins: Basins) -> list[tuple[str, str]]:
    rows = [
        (share_words(one.share, one.within), f"the {name}")
        for one, name in zip(basins.attractors, attractor_names(portrait), strict=True)
    ]
    if basins.leaves > 0.0:
        rows.append((share_words(basins.leaves, basins.leaves_within), "the edge, and leaves it"))
    if basins.open > 0.0:
        rows.append((share_words(basins.open, basins.open_within), "where was not followed"))
    return rows


def _complex(value: complex) -> str:
    if abs(value.imag) < 1e-12 * max(1.0, abs(value)):
        return number(value.real, 5)
    sign = "+" if value.imag > 0 else "−"
    return f"{number(value.real, 5)} {sign} {number(abs(value.imag), 5)}i"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
