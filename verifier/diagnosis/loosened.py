"""A program with more numbers in its register, so that a fit can move them without a compiler.

The rate of each driven state becomes

    time_scale * (gain * (f * (1 - is_given) + given) + offset)

with constants that leave it as it is: 1, 1, 0, 0, 0. `given` is a rate as a function of time, put
in from outside. Parts of a formula can saturate and have dead zones (`wraps`), and a state can stop
at bounds: its rate is then clipped to `(least - x) * pace` and `(most - x) * pace`, so that with a
pace of one step it comes to rest at the bound within a step or two. It works on the
formula where there is one, since then every constant of the spec can be moved; else on the tables'
coefficients. A step map's gain and offset act on how far it goes in a step.
"""

from dataclasses import replace
from typing import Final

from runtime.code import Code
from runtime.flow import Flow, Source, flow_of
from runtime.program import Constant, Control, Field, Kind, Program, State, Term, Unit
from verifier.diagnosis.wraps import ENDLESS, wrapped, wraps_of

ONE: Final = Unit("1", 1.0)
TIME_SCALE: Final = "time:scale"
PACE: Final = "bound:pace"
"""The register's entry for how fast (1/s) a state comes to rest at its bounds."""
ROOM: Final = 1.0
"""How far beyond its domain a formula is followed, in widths of the domain."""


def gain_of(name: str) -> str:
    """The register's entry for the gain of a rate."""
    return f"gain:{name}"


def offset_of(name: str) -> str:
    """The register's entry for the offset of a rate."""
    return f"offset:{name}"


def given_of(name: str) -> str:
    """The register's entry for a rate that is put in from outside."""
    return f"given:{name}"


def is_given_of(name: str) -> str:
    """The register's entry that is 1 where the rate is put in from outside."""
    return f"is_given:{name}"


def least_of(name: str) -> str:
    """The register's entry for the lower bound of a state."""
    return f"bound:least:{name}"


def most_of(name: str) -> str:
    """The register's entry for the upper bound of a state."""
    return f"bound:most:{name}"


def is_bound(name: str) -> bool:
    """Whether this entry of the register belongs to the bounds of a state."""
    return name.startswith("bound:")


def loosened_flow(program: Program, *, wraps: bool) -> Flow:
    """The flow of the loosened program, whose parts saturate and whose states stop if `wraps`.

    Both have the same register.
    """
    source = Source.TABLES if program.field.formula is None else Source.FORMULA
    return flow_of(_loosened(program, is_wrapped=wraps), source)


def _loosened(program: Program, *, is_wrapped: bool) -> Program:
    """The program with the constants above; with a formula, its domains are wider, too."""
    field = program.field
    extra = [Constant(TIME_SCALE, ONE, 1.0, "", ""), Constant(PACE, ONE, 1.0, "", "")]
    for name in field.driven:
        plain = {gain_of(name): 1.0, offset_of(name): 0.0}
        plain |= {given_of(name): 0.0, is_given_of(name): 0.0}
        plain |= {least_of(name): -ENDLESS, most_of(name): ENDLESS}
        extra += [Constant(key, ONE, value, "", "") for key, value in plain.items()]
    wraps = wraps_of(program)
    for wrap in wraps:
        extra.append(Constant(wrap.limit, ONE, ENDLESS, "", ""))
        extra.append(Constant(wrap.zone, ONE, 0.0, "", ""))
    constants = (*program.constants, *extra)
    if field.formula is None:
        return replace(program, constants=constants, field=_loosened_terms(field))
    formula = tuple(
        _loosened_code(
            wrapped(code, tuple(w for w in wraps if w.name == name and is_wrapped)),
            name,
            is_map=field.is_map,
            is_bounded=is_wrapped and not field.is_map,
        )
        for code, name in zip(field.formula, field.driven, strict=True)
    )
    return replace(
        program,
        constants=constants,
        field=replace(field, formula=formula, terms=(), tables=(), coordinates=()),
        states=tuple(_roomy_state(state) for state in program.states),
        controls=tuple(_roomy_control(control) for control in program.controls),
    )


def _loosened_code(code: Code, name: str, *, is_map: bool, is_bounded: bool) -> Code:
    low, high = (f"{bound} {name} sub {PACE} mul" for bound in (least_of(name), most_of(name)))
    before, after = (f"{name} sub", f"{name} add") if is_map else ("", "")
    parts = [
        code.text,
        before,
        f"1 {is_given_of(name)} sub mul {given_of(name)} add",
        f"{gain_of(name)} mul {offset_of(name)} add {TIME_SCALE} mul",
        after,
        f"{low} {high} clip" if is_bounded else "",
    ]
    return Code(" ".join(part for part in parts if part))


def _loosened_terms(field: Field) -> Field:
    """Terms with the constants in their coefficients; those of a map keep their own size."""
    terms: list[Term] = []
    for term in field.terms:
        name = field.driven[term.component]
        if field.is_map:
            terms.append(term)
            continue
        factor = f"1 {is_given_of(name)} sub mul {gain_of(name)} mul {TIME_SCALE} mul"
        terms.append(replace(term, coefficient=Code(f"{term.coefficient.text} {factor}")))
    for component, name in enumerate(field.driven):
        rate = f"{given_of(name)} {gain_of(name)} mul {offset_of(name)} add {TIME_SCALE} mul"
        terms.append(Term(component, Code(rate), -1, 0))
    return replace(field, terms=tuple(terms))


def _roomy_state(state: State) -> State:
    if state.kind is not Kind.CONTINUOUS:
        return state
    width = ROOM * (state.high - state.low)
    return replace(state, low=state.low - width, high=state.high + width)


def _roomy_control(control: Control) -> Control:
    width = ROOM * (control.high - control.low)
    return replace(control, low=control.low - width, high=control.high + width)
