"""The JSON Schema: fresh, complete, and of one mind with the models about what is a spec."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from spec_schema.json_schema import json_schema
from spec_schema.kinds import MODELS
from spec_schema.node import plain
from spec_schema.source import Source
from spec_schema.yaml_reader import read

ROOT = Path(__file__).parents[2]
BAD = ROOT / "tests" / "golden" / "bad"
TYPES: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "number": (int, float),
    "integer": int,
    "boolean": bool,
}


def faults(schema: dict[str, Any], value: Any, root: dict[str, Any]) -> Iterator[str]:
    """What is wrong with `value`: the part of JSON Schema 2020-12 that our schemas use."""
    if "$ref" in schema:
        yield from faults(root["$defs"][schema["$ref"].removeprefix("#/$defs/")], value, root)
    if "anyOf" in schema and all(list(faults(one, value, root)) for one in schema["anyOf"]):
        yield "anyOf"
    if value != schema.get("const", value) or value not in schema.get("enum", [value]):
        yield "words"
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    fits = [k for k in kinds if isinstance(value, TYPES[k])]
    if kinds and not ("boolean" in fits if isinstance(value, bool) else fits):
        yield "type"
    match value:
        case str():
            yield from text_faults(schema, value)
        case int() | float():
            yield from number_faults(schema, value)
        case list():
            yield from list_faults(schema, value, root)
        case dict():
            yield from mapping_faults(schema, value, root)


def text_faults(schema: dict[str, Any], value: str) -> Iterator[str]:
    if len(value) < schema.get("minLength", 0):
        yield "minLength"
    if not re.search(schema.get("pattern", ""), value):
        yield "pattern"


def number_faults(schema: dict[str, Any], value: float) -> Iterator[str]:
    if not schema.get("minimum", value) <= value <= schema.get("maximum", value):
        yield "limits"
    if value <= schema.get("exclusiveMinimum", value - 1):
        yield "exclusiveMinimum"


def list_faults(schema: dict[str, Any], value: list[Any], root: dict[str, Any]) -> Iterator[str]:
    if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
        yield "items"
    for item in value:
        yield from faults(schema.get("items", {}), item, root)


def mapping_faults(
    schema: dict[str, Any], value: dict[str, Any], root: dict[str, Any]
) -> Iterator[str]:
    if not schema.get("minProperties", 0) <= len(value) <= schema.get("maxProperties", len(value)):
        yield "properties"
    yield from (f"required {key}" for key in schema.get("required", []) if key not in value)
    for key, item in value.items():
        inner = [schema.get("properties", {}).get(key)]
        inner += [s for p, s in schema.get("patternProperties", {}).items() if re.search(p, key)]
        known = [one for one in inner if one is not None]
        if not known:
            more = schema.get("additionalProperties", True)
            if more is False:
                yield f"unknown {key}"
            elif isinstance(more, dict):
                yield from faults(more, item, root)
        for one in known:
            yield from faults(one, item, root)


def parts(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        yield schema
        for key, inner in schema.items():
            if key not in {"examples", "default"}:
                yield from parts(inner)
    if isinstance(schema, list):
        for inner in schema:
            yield from parts(inner)


def document(path: Path) -> Any:
    return plain(read(Source(path.name, path.read_text(encoding="utf-8"))))


@pytest.mark.parametrize("kind", MODELS)
def test_the_committed_schema_is_fresh(kind: str) -> None:
    """If not: `specc schema KIND > docs/schema/KIND.schema.json`."""
    path = ROOT / "docs" / "schema" / f"{kind}.schema.json"

    assert json.loads(path.read_text(encoding="utf-8")) == json_schema(kind)


@pytest.mark.parametrize("kind", MODELS)
def test_every_key_is_described_and_no_mapping_is_open(kind: str) -> None:
    for part in parts(json_schema(kind)):
        for key, inner in part.get("properties", {}).items():
            assert inner.get("description"), key
        if part.get("type") == "object":
            assert "additionalProperties" in part


@pytest.mark.parametrize("kind", MODELS)
def test_every_example_satisfies_the_schema_beside_it(kind: str) -> None:
    root = json_schema(kind)
    for part in parts(root):
        for example in part.get("examples", []):
            assert list(faults(part, example, root)) == []


@pytest.mark.parametrize("path", sorted((ROOT / "specs").glob("*.yaml")), ids=lambda p: p.stem)
def test_every_spec_of_the_library_satisfies_the_schema(path: Path) -> None:
    data = document(path)
    schema = json_schema(data["kind"])

    assert list(faults(schema, data, schema)) == []


@pytest.mark.parametrize(
    "name",
    [
        "missing_key",
        "unknown_key",
        "unknown_role",
        "number_for_a_unit",
        "whole_number_wanted",
        "coverage_above_one",
        "variable_starts_with_a_digit",
        "field_with_two_forms",
        "field_without_a_form",
        "domain_with_three_limits",
        "version_from_the_future",
        "channel_without_a_mode",
        "sketch_without_arrows",
        "no_states",
    ],
)
def test_an_editor_sees_the_mistakes_of_shape(name: str) -> None:
    schema = json_schema("behavior")

    assert list(faults(schema, document(BAD / f"{name}.yaml"), schema))
