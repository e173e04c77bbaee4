"""Footprints and poses in SI, and what is wrong with them: corners that turn the wrong way."""

import math
from typing import Final, TypeAlias

from compiler.findings import Findings
from compiler.quantities import si_value
from runtime.world.model import Disc, Polygon, Pose, Shape
from spec_schema.places import Path
from spec_schema.shapes import PartSpec, ShapeSpec
from spec_schema.units import parse_unit

METRE: Final = parse_unit("m")
RADIAN: Final = parse_unit("rad")
STRAIGHT: Final = 1e-9
"""Square metres: what turns by less than this does not turn."""

Corners: TypeAlias = tuple[tuple[float, float], ...]
HERE: Final = Pose(0.0, 0.0, 0.0)


def length(value: float | str, path: Path, findings: Findings) -> float:
    """A length in metres; 0 where it can't be told."""
    return si_value(value, METRE, path, findings) or 0.0


def positive(
    value: float | str, unit_text: str, what: str, path: Path, findings: Findings
) -> float:
    """A quantity above 0 in SI; 1 where it can't be told."""
    unit = parse_unit(unit_text)
    found = si_value(value, unit, path, findings)
    if found is not None and found <= 0.0:
        message = f"{what} must be above 0 (got {value})"
        findings.error("S212", path, message, f"write a number above 0, in {unit.text}")
    return found if found is not None and found > 0.0 else 1.0


def pose_of(at: tuple[float | str, ...], path: Path, findings: Findings) -> Pose:
    """A place and a direction."""
    x, y = (length(value, (*path, i), findings) for i, value in enumerate(at[:2]))
    turned = at[2] if len(at) > 2 else 0.0
    if not isinstance(turned, str) and abs(turned) > math.tau:
        message = (
            f"a plain number is in radians, and {turned:g} rad is {turned / math.tau:.3g} turns"
        )
        remedy = f"write '{turned:g} deg', or '{turned:g} rad' if that is meant"
        findings.error("S212", (*path, 2), message, remedy)
    return Pose(x, y, si_value(turned, RADIAN, (*path, 2), findings) or 0.0)


def heights_of(
    heights: tuple[float | str, ...], path: Path, findings: Findings
) -> tuple[float, float]:
    """From which height to which."""
    low, high = (length(value, (*path, i), findings) for i, value in enumerate(heights))
    if not 0.0 <= low < high:
        message = "heights are above the floor, the lower one first"
        findings.error("S212", path, message, "write 'height: [0, 18 cm]'")
    return low, high


def shape_of(spec: ShapeSpec, path: Path, findings: Findings) -> Shape:
    """A footprint: discs and convex polygons."""
    if spec.parts is None:
        return _outline(spec, HERE, path, findings)
    shapes = [
        _outline(part, pose_of(part.at, (*path, "parts", i, "at"), findings), place, findings)
        for i, part in enumerate(spec.parts)
        for place in [(*path, "parts", i)]
    ]
    discs = tuple(disc for shape in shapes for disc in shape.discs)
    return Shape(discs, tuple(polygon for shape in shapes for polygon in shape.polygons))


def _outline(spec: ShapeSpec | PartSpec, at: Pose, path: Path, findings: Findings) -> Shape:
    if spec.circle is not None:
        radius = positive(spec.circle, "m", "a radius", (*path, "circle"), findings)
        return Shape((Disc(at.x, at.y, radius),), ())
    if spec.box is not None:
        sides = [
            positive(side, "m", "a side", (*path, "box", i), findings)
            for i, side in enumerate(spec.box)
        ]
        return Shape((), (Polygon(tuple(placed(at, corner) for corner in box_corners(*sides))),))
    corners = points_of(spec.polygon or (), (*path, "polygon"), findings)
    _check_convex(corners, (*path, "polygon"), findings)
    return Shape((), (Polygon(tuple(placed(at, corner) for corner in corners)),))


def box_corners(ahead: float, wide: float) -> Corners:
    """The corners of a rectangle around the middle."""
    x, y = ahead / 2, wide / 2
    return ((-x, -y), (x, -y), (x, y), (-x, y))


def points_of(
    points: tuple[tuple[float | str, ...], ...], path: Path, findings: Findings
) -> Corners:
    """Corners in metres."""
    return tuple(
        (length(x, (*path, i, 0), findings), length(y, (*path, i, 1), findings))
        for i, (x, y) in enumerate(points)
    )


def placed(at: Pose, point: tuple[float, float]) -> tuple[float, float]:
    """A point of something's own frame where that stands at a pose."""
    cos, sin = math.cos(at.heading), math.sin(at.heading)
    return at.x + cos * point[0] - sin * point[1], at.y + sin * point[0] + cos * point[1]


def area_of(corners: Corners) -> float:
    """Twice the signed area: above 0 where the corners go round counter-clockwise."""
    pairs = zip(corners, (*corners[1:], corners[0]), strict=True)
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs)


def turns_of(corners: Corners) -> list[float]:
    """For each corner the cross product of the edges before and after it."""
    found = []
    for i, here in enumerate(corners):
        before, after = corners[i - 1], corners[(i + 1) % len(corners)]
        one = (here[0] - before[0], here[1] - before[1])
        two = (after[0] - here[0], after[1] - here[1])
        found.append(one[0] * two[1] - one[1] * two[0])
    return found


def _check_convex(corners: Corners, path: Path, findings: Findings) -> None:
    turns = turns_of(corners)
    if all(turn < -STRAIGHT for turn in turns):
        message = "the corners go round clockwise"
        findings.error(
            "S326", path, message, f"write them the other way round: {backwards(corners)}"
        )
    elif any(turn <= STRAIGHT for turn in turns) or not _goes_round_once(corners):
        wrong = next((i for i, turn in enumerate(turns) if turn <= STRAIGHT), 0)
        message = f"the polygon is not convex: it does not turn left at its corner {wrong + 1}"
        remedy = "leave that corner out, or make it of convex `parts`"
        findings.error("S326", (*path, wrong), message, remedy)


def _goes_round_once(corners: Corners) -> bool:
    """Whether all left turns together are one full turn: a star makes two."""
    edges = [
        math.atan2(b[1] - a[1], b[0] - a[0])
        for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)
    ]
    turned = sum((edges[i] - edges[i - 1]) % math.tau for i in range(len(edges)))
    return turned < 1.5 * math.tau


def backwards(corners: Corners) -> str:
    """The corners the other way round, as they are written."""
    shown = ", ".join(f"[{x:g}, {y:g}]" for x, y in reversed(corners))
    return f"[{shown}]"
