"""A first spec from what a log holds.

Most users arrive with a bag and no spec. What is written for them checks, compiles and verifies as
it stands; every guess in it is marked, so that the next step is an edit and not a search.
"""

import math
import re
from collections.abc import Iterator
from pathlib import Path

from specc.first_spec.guesses import Guess, Variable, guess
from specc.first_spec.inventory_text import MOST_FIELDS, looks
from verifier.traces.alike import is_asked
from verifier.traces.inventory import Inventory


def spec_for(found: Inventory, name: str) -> str:
    """A first spec for the log, its `trace:` filled in; raises SpecError V306 and V344."""
    return "\n".join(_spec_lines(found, name, guess(found))) + "\n"


def _spec_lines(found: Inventory, name: str, made: Guess) -> Iterator[str]:
    yield f"# A first spec for {Path(found.source).name}, written by `specc init --from`."
    for line in made.advice:
        yield f"# {line}"
    yield "# Every line marked CHECK is a guess. Then: specc check, specc verify."
    yield "specc: 1"
    yield "kind: behavior"
    yield f"name: {name}"
    yield "about: CHECK what this behavior does, in a sentence"
    yield "state:"
    for state in made.states:
        yield from _state_lines(state)
    for variable in made.discrete:
        yield from _discrete_lines(variable)
    if made.controls:
        yield "control:"
        for control in made.controls:
            default = 0 if control.low <= 0 <= control.high else round(control.low, 6)
            unit, domain = _text(control.unit), _domain(control)
            line = f"  {control.name}: {{unit: {unit}, domain: {domain}, default: {default:g}}}"
            yield f"{line}  # CHECK {control.why}" if control.why else line
    yield "field:"
    yield "  formula:                     # CHECK how each state moves, in its unit per second"
    for state in made.states:
        yield f"    {state.name}: {state.rate}"
    yield "fidelity:"
    yield "  tolerance:                   # CHECK how far off is still the same behavior"
    for state in made.states:
        yield f"    {state.name}: {_tolerance(state)}"
    yield "  horizon: 1 s                 # CHECK how far ahead it must hold"
    yield "trace:"
    for variable in (*made.states, *made.controls):
        yield f"  {variable.name}: {_text(variable.path)}"
    for variable in made.discrete:
        yield f"  {variable.name}: {_discrete_path(variable)}"
    yield from _other_fields(found, made)


def _state_lines(state: Variable) -> Iterator[str]:
    yield f"  {state.name}:"
    yield f"    unit: {_text(state.unit)}"
    domain = "[-pi, pi]" if state.periodic and state.unit == "rad" else _domain(state)
    yield f"    domain: {domain}"
    if state.periodic:
        yield "    kind: periodic             # CHECK " + state.why
    yield "    role: both"
    agent, environment = state.relates
    yield f"    relates: {{agent: {agent}, environment: {environment}}}     # CHECK"


def _discrete_lines(variable: Variable) -> Iterator[str]:
    yield f"  {variable.name}:"
    yield f"    kind: discrete             # CHECK {variable.why}: a mode, guessed"
    yield f"    values: [{', '.join(_text(name) for name, _ in variable.values)}]"
    yield "    role: sensed               # only read: the field may ask for it"
    agent, environment = variable.relates
    yield f"    relates: {{agent: {agent}, environment: {environment}}}     # CHECK"


def _discrete_path(variable: Variable) -> str:
    """The path, with what stands for the values where that is not their name or place."""
    path = _text(variable.path)
    if variable.values[0][1]:
        if all(name == text for name, text in variable.values):
            return path
        pairs = ", ".join(f"{_quoted(text)}: {_text(name)}" for name, text in variable.values)
        return f"{{path: {path}, values: {{{pairs}}}}}"
    if variable.low:
        return f"{{path: {path}, offset: {-variable.low:g}}}"
    return path


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"


def _domain(variable: Variable) -> str:
    return f"[{variable.low:.6g}, {variable.high:.6g}]"


def _tolerance(state: Variable) -> str:
    """As guessed with the variable, else two percent of the range seen, to one digit."""
    if state.tolerance:
        return state.tolerance
    width = 0.02 * (state.high - state.low)
    digits = 10.0 ** math.floor(math.log10(width))
    return f"{round(width / digits) * digits:.3g}"


def _text(text: str) -> str:
    """The text as a YAML scalar."""
    if re.fullmatch(r"[A-Za-z/][\w/.@\[\]-]*", text):
        return text
    return _quoted(text)


def _other_fields(found: Inventory, made: Guess) -> Iterator[str]:
    used = {v.path for v in (*made.states, *made.controls, *made.discrete)}
    others = [
        info
        for topic in found.topics
        for info in topic.fields[:MOST_FIELDS]
        if info.path not in used and (info.low != info.high or len(info.texts) > 1)
    ]
    if others:
        yield "# Also in this log:"
    for info in others:
        told = ", by its name a command" if is_asked(info.path) else ""
        yield f"#   {info.path}   ({looks(info)}{told})"
