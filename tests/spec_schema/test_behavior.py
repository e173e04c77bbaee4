"""The models: what they accept, what they make of it, and that they can't be changed."""

from typing import Annotated, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, TypeAdapter, ValidationError

from spec_schema.behavior import BehaviorSpec, TableSpec
from spec_schema.diagnostics import SpecError
from spec_schema.field_forms import Arrows, FieldSpec, Formula, Module, Step
from spec_schema.field_grid import Grid
from spec_schema.grid_values import GridValues
from spec_schema.kinds import MODELS
from spec_schema.load import load_source
from spec_schema.source import Source
from spec_schema.trace_mapping import TraceEntry
from spec_schema.value_types import Channel
from spec_schema.variables import StateSpec

HEAD = """\
specc: 1
kind: behavior
name: drift
state:
  x:
    unit: m
    domain: [-2, 2]
    role: both
    relates: {agent: base, environment: wall}
"""
FORMULA = "field: {formula: {x: -x}}\n"


def behavior(rest: str) -> BehaviorSpec:
    spec = load_source(Source("f.yaml", HEAD + rest)).spec
    assert isinstance(spec, BehaviorSpec)
    return spec


def field(form: str) -> FieldSpec:
    return behavior(f"field: {{{form}}}\n").field


def entry(written: str) -> TraceEntry:
    return behavior(f"{FORMULA}trace: {{x: {written}}}\n").trace["x"]


def messages(rest: str, head: str = HEAD) -> list[str]:
    with pytest.raises(SpecError) as caught:
        load_source(Source("f.yaml", head + rest))
    return [found.message for found in caught.value.diagnostics]


def models_below(model: type[BaseModel]) -> dict[str, type[BaseModel]]:
    found: dict[str, type[BaseModel]] = {}

    def visit(inner: Any) -> None:
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            if inner.__name__ in found:
                return
            found[inner.__name__] = inner
            for part in inner.model_fields.values():
                visit(part.annotation)
        for part in getattr(inner, "__args__", ()):
            visit(part)

    visit(model)
    return found


ALL_MODELS = {name: m for top in MODELS.values() for name, m in models_below(top).items()}
ALL_FIELDS = [
    pytest.param(model, name, id=f"{model.__name__}.{name}")
    for model in ALL_MODELS.values()
    for name in model.model_fields
    if name != "root"
]


def test_every_model_is_found_from_the_kinds() -> None:
    assert {"BehaviorSpec", "StateSpec", "TraceEntry", "Arrow", "ProjectSpec"} <= ALL_MODELS.keys()


@pytest.mark.parametrize(("model", "name"), ALL_FIELDS)
def test_every_key_is_described_by_a_sentence_and_an_example(
    model: type[BaseModel], name: str
) -> None:
    key = model.model_fields[name]

    assert key.description
    assert key.description.endswith(".")
    assert key.examples


@pytest.mark.parametrize(("model", "name"), ALL_FIELDS)
def test_the_example_of_every_key_is_accepted(model: type[BaseModel], name: str) -> None:
    key = model.model_fields[name]
    hint: Any = Annotated[key.annotation, "as in the model", *key.metadata]

    for example in key.examples or ():
        TypeAdapter(hint).validate_python(example)


def test_a_form_is_of_its_own_type() -> None:
    assert isinstance(field("formula: {x: -x}").form, Formula)
    assert isinstance(field("arrows: {over: [x], sketch: [{at: [0], go: [1]}]}").form, Arrows)
    assert isinstance(field("grid: {over: [x], values: {x: [1, 0]}}").form, Grid)
    assert isinstance(field("module: {call: a.b:c}").form, Module)
    assert isinstance(field("step: {every: 0.1 s, next: {x: x/2}}").form, Step)


def test_expressions_and_units_stay_text_and_numbers_become_text() -> None:
    form = field("formula: {x: 0}").form

    assert isinstance(form, Formula)
    assert form.rates == {"x": "0"}


@given(st.lists(st.lists(st.floats(-9, 9), min_size=3, max_size=3), min_size=2, max_size=4))
def test_grid_values_are_numbers_in_row_order_with_their_shape(rows: list[list[float]]) -> None:
    form = field(f"grid: {{over: [x, y], values: {{x: {rows!r}}}}}").form

    assert isinstance(form, Grid)
    assert form.values == {
        "x": GridValues((len(rows), 3), tuple(number for row in rows for number in row))
    }


def test_a_bare_path_is_short_for_a_mapping() -> None:
    assert entry("/odom.x") == entry("{path: /odom.x}")
    assert entry("/odom.x").delay == 0.0


def test_the_texts_of_a_signal_stand_for_themselves() -> None:
    assert entry("{path: /a, values: [go, stop]}").values == {"go": "go", "stop": "stop"}
    assert entry("{path: /a, values: {Go!: go}}").values == {"Go!": "go"}


def test_what_is_left_out_has_its_default() -> None:
    spec = behavior(FORMULA)

    assert spec.table == TableSpec()
    assert (spec.table.method, spec.table.budget) == ("cubic", 64 * 2**20)
    assert (spec.control, spec.trace, spec.fidelity) == ({}, {}, None)


@pytest.mark.parametrize(
    ("written", "size"), [("64 MiB", 2**26), ("1.5 kB", 1500), ("2GiB", 2**31), ("512 B", 512)]
)
def test_a_budget_is_a_number_of_bytes(written: str, size: int) -> None:
    assert behavior(f"{FORMULA}table: {{budget: {written}}}\n").table.budget == size


def test_a_channel_is_read_with_its_mode() -> None:
    spec = behavior(f"{FORMULA}realizes: {{x: base.speed as set-point}}\n")

    assert spec.realizes == {"x": Channel("base.speed", "set-point")}


def test_domains_may_be_quantities_and_expressions() -> None:
    spec = load_source(Source("f.yaml", (HEAD + FORMULA).replace("[-2, 2]", "[-pi, 180 deg]"))).spec

    assert isinstance(spec, BehaviorSpec)
    assert spec.state["x"].domain == ("-pi", "180 deg")


@pytest.mark.parametrize("default", ["0", "1", "0.5", "2 km", "-0.0"])
def test_a_default_on_a_limit_is_inside_and_a_quantity_is_not_judged_here(default: str) -> None:
    control = f"control: {{a: {{unit: m, domain: [0, 1], default: {default}}}}}\n"

    assert "a" in behavior(control + FORMULA).control


def test_nothing_can_be_changed() -> None:
    state: Any = behavior(FORMULA).state["x"]

    with pytest.raises(ValidationError):
        state.role = "sensed"


def test_nothing_is_converted() -> None:
    with pytest.raises(ValidationError):
        StateSpec.model_validate({"unit": "m", "domain": ["1", True], "role": "both"})


def test_mistakes_in_different_variables_hide_none_of_each_other() -> None:
    head = HEAD.replace("control:", "").replace("role: both", "role: bath")
    rest = (
        'control:\n  a: {unit: "1", domain: [3, 1], default: 2}\n'
        '  b: {unit: "1", domain: [0, 1], default: 2}\n'
        "field: {grid: {over: [x], values: {x: [1, .nan]}, nodes: {y: [0, 1]}}}\n"
        "trace: {x: {delay: 1}, a: {constant: 1, path: /a}}\n"
    )

    assert messages(rest, head) == [
        "unknown role 'bath'",
        "the lower limit 3 is not below the upper limit 1",
        "2 is outside the domain [0, 1]",
        ".nan is no rate",
        "neither a path in the log nor a constant",
        "a constant was not logged, so it has no 'path'",
    ]


@pytest.mark.parametrize("name", ["x", "_x", "X1", "a" * 64])
def test_an_ascii_identifier_is_a_name(name: str) -> None:
    assert (
        name
        in behavior(
            f"control: {{{name}: {{unit: m, domain: [0, 1], default: 0}}}}\n{FORMULA}"
        ).control
    )


@pytest.mark.parametrize("name", ["1x", "x-y", "x y", "é", "a" * 65, "", "x.y", "x\\n"])
def test_anything_else_is_none(name: str) -> None:
    found = messages(f'control: {{"{name}": {{unit: m, domain: [0, 1], default: 0}}}}\n{FORMULA}')

    assert len(found) == 1
    assert found[0].endswith("can't be a name")
