"""A bifurcation diagram in sentences and as plain data, in the user's units."""

from collections.abc import Sequence

from runtime.arrays import Array
from runtime.program import Unit
from specc.figures.quantities import quantity
from verifier.topology.branches.continuation import Bifurcation, Branches
from verifier.topology.features import AxisRange


def branches_summary(branches: Branches) -> str:
    """The bifurcations in the order of the control, then the branches."""
    unit = branches.unit
    ends = f"{quantity(branches.low, unit)} to {quantity(branches.high, unit)}"
    rows = [f"{branches.name} against {branches.control}, from {ends}"]
    rows += [f"  {bifurcation_sentence(found, unit)}" for found in branches.bifurcations]
    if not branches.bifurcations:
        rows.append("  no bifurcation seen")
    rows += [f"  {bifurcation_sentence(found, unit)}" for found in branches.retypings]
    rows += [f"  {_branch('fixed point', b.values, b.kinds, unit)}" for b in branches.points]
    rows += [f"  {_branch('cycle', b.values, b.stabilities, unit)}" for b in branches.cycles]
    rows += [f"  {note}" for note in branches.notes]
    return "\n".join(rows)


def bifurcation_sentence(found: Bifurcation, unit: Unit) -> str:
    """What happens, and at which value of the control."""
    within = quantity(found.within, unit, 1)
    # No digit is written that is not known.
    known = max(found.within, 1e-12 * unit.scale)
    value = round(found.value / known) * known
    return f"{found.change} at {quantity(value, unit, 6)} ± {within}: {found.about}"


def _branch(what: str, values: Array, types: Sequence[str], unit: Unit) -> str:
    """Where a branch runs and which types it passes through."""
    passed = [str(t) for k, t in enumerate(types) if k == 0 or t != types[k - 1]]
    low, high = quantity(float(values.min()), unit), quantity(float(values.max()), unit)
    return f"{what} from {low} to {high}: {', then '.join(passed)}"


def branches_record(branches: Branches) -> dict[str, object]:
    """The same for programs."""
    axes, scale = branches.axes, branches.unit.scale
    return {
        "behavior": branches.name,
        "control": branches.control,
        "units": {branches.control: branches.unit.text, **{a.name: a.unit.text for a in axes}},
        "from": branches.low / scale,
        "to": branches.high / scale,
        "held": {h.name: h.label or h.value / h.unit.scale for h in branches.held},
        "fixed_points": [
            {
                "values": (branch.values / scale).tolist(),
                "at": _columns(axes, branch.points),
                "kinds": [str(kind) for kind in branch.kinds],
            }
            for branch in branches.points
        ],
        "cycles": [
            {
                "values": (branch.values / scale).tolist(),
                "lows": _columns(axes, branch.lows),
                "highs": _columns(axes, branch.highs),
                "periods": branch.periods.tolist(),
                "stabilities": [str(stability) for stability in branch.stabilities],
            }
            for branch in branches.cycles
        ],
        "bifurcations": [_change(branches, found) for found in branches.bifurcations],
        "changes_of_type": [_change(branches, found) for found in branches.retypings],
        "notes": list(branches.notes),
    }


def _change(branches: Branches, found: Bifurcation) -> dict[str, object]:
    scale = branches.unit.scale
    at = zip(branches.axes, found.at, strict=False)
    return {
        "change": str(found.change),
        "value": found.value / scale,
        "within": found.within / scale,
        "at": {axis.name: float(v) / axis.unit.scale for axis, v in at},
        "about": found.about,
    }


def _columns(axes: tuple[AxisRange, ...], points: Array) -> dict[str, list[float]]:
    return {axis.name: (points[:, j] / axis.unit.scale).tolist() for j, axis in enumerate(axes)}
