"""Pass 3: everything that refers to a declared name by its name, and what nobody refers to."""

from collections.abc import Iterable

from compiler.claims import names_read
from compiler.declare import Declarations
from compiler.findings import Findings
from compiler.read_expressions import Expressions, signals
from runtime.claim import Claim
from runtime.program import Role
from spec_schema.arbiter import ArbiterSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.expressions.rewrite import names_in
from spec_schema.field_forms import Arrows, Form, Module
from spec_schema.field_grid import Grid
from spec_schema.field_modes import Modes
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean, there_are

MOST_AXES = 5


def check_references(
    spec: BehaviorSpec,
    declared: Declarations,
    expressions: Expressions,
    claims: tuple[Claim, ...],
    findings: Findings,
) -> None:
    """A finding for each name that means nothing where it stands, and for each left unused."""
    _check_axes(spec.field.form, declared, findings)
    _check_keys(spec, declared, findings)
    check_trace(spec, declared, findings)
    _check_signals(spec, declared, expressions, findings)
    read = _read_by_field(spec.field.form, declared, expressions)
    _warn_of_imitation(read - mode_of(spec.field.form), declared, findings)
    _warn_of_unused(spec, expressions, read | names_read(claims), findings)


def axes_of(form: Form, declared: Declarations) -> tuple[str, ...]:
    """The variables that a sketched, gridded or programmed field stands over."""
    match form:
        case Arrows() | Grid():
            return form.over
        case Module():
            return form.over or _readable(declared)
        case _:
            return ()


def _readable(declared: Declarations) -> tuple[str, ...]:
    """What a field may stand over: the continuous states that are sensed, and the controls."""
    sensed = {state.name for state in declared.states if state.role is not Role.DRIVEN}
    found = sensed & declared.continuous | {control.name for control in declared.controls}
    return tuple(name for name in declared.register if name in found)


def drives_of(form: Form, declared: Declarations) -> tuple[str, ...]:
    """The driven states in the order in which a sketched or gridded field gives their rates."""
    named = form.drives if isinstance(form, Arrows | Grid) else None
    return named or tuple(state.name for state in declared.driven)


def _check_axes(form: Form, declared: Declarations, findings: Findings) -> None:
    if not isinstance(form, Arrows | Grid | Module):
        return
    base: Path = ("field", type(form).__name__.lower())
    known = _readable(declared)
    for i, name in enumerate(form.over or ()):
        if name in declared.values:
            message = f"'{name}' is discrete, and nothing lies between its values"
            findings.error("S207", (*base, "over", i), message, "leave it out of `over`")
        elif name not in known:
            remedy = did_you_mean(name, list(known)) or f"it may stand over {', '.join(known)}"
            message = (
                f"the field can't stand over '{name}': no sensed state or control has this name"
            )
            findings.error("S207", (*base, "over", i), message, remedy)
    over = axes_of(form, declared)
    if len(over) > MOST_AXES:
        message = f"a table has at most {MOST_AXES} axes (got {len(over)})"
        findings.error("S245", (*base,), message, "name fewer variables in `over`", key=True)
    driven = [state.name for state in declared.driven]
    drives = drives_of(form, declared)
    if isinstance(form, Arrows):
        _check_arrows(form, drives, declared, findings)
    for i, name in enumerate(drives):
        if name not in driven:
            remedy = did_you_mean(name, driven) or f"the driven states: {', '.join(driven)}"
            findings.error("S205", (*base, "drives", i), f"'{name}' is no driven state", remedy)
    missing = [name for name in driven if name not in drives]
    if missing:
        message = f"the field gives no rate for '{missing[0]}'"
        findings.error("S204", (*base,), message, "add it to `drives`", key=True)


def _check_arrows(
    form: Arrows, drives: tuple[str, ...], declared: Declarations, findings: Findings
) -> None:
    """Arrows of the wrong length, outside the domain, or twice at a point."""
    known = {variable.name: variable for variable in declared.variables}
    seen: set[tuple[float, ...]] = set()
    for i, arrow in enumerate(form.sketch):
        path: Path = ("field", "arrows", "sketch", i)
        if form.drives is None and len(arrow.go) != len(drives):
            message = f"'go' has {len(arrow.go)} numbers for {len(drives)} driven states"
            remedy = f"write one for each of {', '.join(drives)}"
            findings.error("S234", (*path, "go"), message, remedy)
        for name, value in zip(form.over, arrow.at, strict=False):  # lengths are told by the model
            axis = known.get(name)
            if axis and not axis.low <= value * axis.unit.scale <= axis.high:
                message = f"this arrow starts outside the domain of '{name}'"
                findings.error(
                    "S234", (*path, "at"), message, "move it inside, or widen the domain"
                )
        if arrow.at in seen and form.fill != "least_squares":
            findings.error(
                "S234", (*path, "at"), "an arrow stands here already", "keep one of them"
            )
        seen.add(arrow.at)


def _check_keys(spec: BehaviorSpec, declared: Declarations, findings: Findings) -> None:
    driven = [state.name for state in declared.driven]
    readable = [*declared.continuous, *(c.name for c in declared.controls)]
    set_points = [*spec.output, *(c.name for c in declared.controls)]
    sections: list[tuple[Path, Iterable[str], list[str], str]] = [
        (("table", "tolerance"), spec.table.tolerance, driven, "driven state"),
        (("table", "nodes"), spec.table.nodes, readable, "state or control"),
        (("realizes",), spec.realizes, [*driven, *set_points], "driven state, output or control"),
    ]
    if spec.fidelity is not None:
        judged = spec.fidelity.tolerance
        sections += [
            (("fidelity", "tolerance"), spec.fidelity.tolerance, driven, "driven state"),
            (("fidelity", "scatter"), spec.fidelity.scatter, [*judged], "state with a tolerance"),
            (("fidelity", "region"), spec.fidelity.region, readable, "state or control"),
        ]
    for path, names, known, what in sections:
        for name in names:
            if name not in known:
                remedy = did_you_mean(name, sorted(known)) or there_are(sorted(known))
                findings.error("S208", (*path, name), f"'{name}' is no {what}", remedy, key=True)
    for name in set_points:
        channel = spec.realizes.get(name)
        if channel is not None and channel.mode != "set-point":
            message = f"'{name}' has no rate of its own, so it can't be realized as {channel.mode}"
            remedy = f"write '{channel.name} as set-point'"
            findings.error("S214", ("realizes", name), message, remedy)


def check_trace(
    spec: BehaviorSpec | ArbiterSpec, declared: Declarations, findings: Findings
) -> None:
    """A finding for each entry of `trace:` for what no log is read for, or with unknown values."""
    for name in spec.output:
        if name in spec.trace:
            message = (
                f"'{name}' is an output: it follows from the states, and no log is read for it"
            )
            findings.error("S209", ("trace", name), message, "remove it", key=True)
    for name in spec.constants:
        if name in spec.trace:
            message = f"'{name}' is a constant of the spec, and no log is read for it"
            findings.error(
                "S209",
                ("trace", name),
                message,
                "remove it, or declare it under `control`",
                key=True,
            )
    for name, values in declared.values.items():
        entry = spec.trace.get(name)
        for raw, meant in (entry.values or {}).items() if entry else ():
            if meant not in values:
                remedy = did_you_mean(meant, list(values)) or f"its values: {', '.join(values)}"
                path = ("trace", name, "values", raw)
                findings.error("S210", path, f"'{name}' has no value '{meant}'", remedy)
    for name in declared.units:
        if name in spec.trace and spec.trace[name].values is not None:
            message = f"'{name}' is a number and has no values by name"
            findings.error("S210", ("trace", name, "values"), message, "remove `values`", key=True)


def _check_signals(
    spec: BehaviorSpec, declared: Declarations, expressions: Expressions, findings: Findings
) -> None:
    judged = expressions.judge_when
    read = names_in(judged) if judged is not None else frozenset()
    for name in signals(spec):
        if spec.trace[name].constant is not None:
            message = f"'{name}' is declared nowhere, so it can't be a constant of the trace"
            findings.error("S209", ("trace", name), message, "declare it under `control`", key=True)
        elif name not in read and (judged is not None or spec.judge_when is None):
            known = declared.register
            remedy = did_you_mean(name, list(known)) or "read it in `judge_when`, or remove it"
            message = f"'{name}' is declared nowhere and `judge_when` does not read it"
            findings.warning("S221", ("trace", name), message, remedy, key=True)


def mode_of(form: Form) -> frozenset[str]:
    """The name of the state whose values are the field's modes, or nothing."""
    return frozenset({form.of}) if isinstance(form, Modes) else frozenset()


def _read_by_field(form: Form, declared: Declarations, expressions: Expressions) -> frozenset[str]:
    read = frozenset(name for e in expressions.rates.values() for name in names_in(e))
    read = read.union(*(way.reads for way in expressions.ways))
    if expressions.drawing is not None:
        read = read.union(expressions.drawing.names, expressions.drawing.over)
    return read | frozenset(axes_of(form, declared))


def _warn_of_imitation(read: frozenset[str], declared: Declarations, findings: Findings) -> None:
    sensed = {state.name for state in declared.states if state.role is not Role.DRIVEN}
    if read and not read & sensed:
        findings.warning(
            "S222",
            ("field",),
            "the field reads nothing that is sensed: an imitation, not a behavior "
            "(thesis, section 2.3, caveat 1)",
            "let it depend on a state whose role is `sensed` or `both`",
            key=True,
        )


def _warn_of_unused(
    spec: BehaviorSpec, expressions: Expressions, read: frozenset[str], findings: Findings
) -> None:
    if findings.has_errors:
        return  # what could not be read may well be what uses them
    trees = [
        *expressions.closures.values(),
        *expressions.outputs.values(),
        *expressions.noise.values(),
    ]
    if expressions.judge_when is not None:
        trees.append(expressions.judge_when)
    used = read.union(*map(names_in, trees), spec.realizes)
    sections: tuple[tuple[str, Iterable[str]], ...] = (
        ("control", spec.control),
        ("constants", spec.constants),
    )
    for section, names in sections:
        for name in names:
            if name not in used:
                message = f"nothing reads '{name}'"
                findings.warning("S223", (section, name), message, "use it or remove it", key=True)
