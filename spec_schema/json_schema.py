"""The language as JSON Schema 2020-12, for editors that complete and explain keys."""

from typing import Any, final

from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import core_schema

from spec_schema.kinds import MODELS


def json_schema(kind: str) -> dict[str, Any]:
    """The schema of one kind of file. Rules between keys are `specc check`'s alone."""
    schema = MODELS[kind].model_json_schema(schema_generator=_Generator)
    return {"$schema": _Generator.schema_dialect, "title": f"specc {kind}", **schema}


@final
class _Generator(GenerateJsonSchema):
    """Pydantic's schema without titles made from our names, and without null: specs have none."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        """Never: a key is its own title."""
        del schema
        return False

    def nullable_schema(self, schema: core_schema.NullableSchema) -> dict[str, Any]:
        """An optional key may be absent, not null."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> dict[str, Any]:
        """A default of None is the absence of the key."""
        if schema.get("default", "something") is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def dict_schema(self, schema: core_schema.DictSchema) -> dict[str, Any]:
        """A mapping of names: what is no name is no key."""
        found = super().dict_schema(schema)
        return {**found, "additionalProperties": False} if "patternProperties" in found else found

    def model_schema(self, schema: core_schema.ModelSchema) -> dict[str, Any]:
        """A mapping, described by its model's docstring."""
        found = super().model_schema(schema)
        found.pop("title", None)
        return found
