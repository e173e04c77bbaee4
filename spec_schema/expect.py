"""The models of `expect:`: claims about the topology of the field."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Self, final

from pydantic import ConfigDict, Field, RootModel, model_validator

from spec_schema.mistake import Mistake, refuse
from spec_schema.value_types import Domain, Identifier, Name, Quantity, StrictModel, Text
from spec_schema.wording import described

ALL = ""
"""The key of a `within` that is one value for everything."""


@final
class Within(RootModel[Annotated[Mapping[str, Quantity], Field(min_length=1)]]):
    """How far off it may be: one share for everything, or one value for each name."""

    model_config = ConfigDict(
        strict=True,
        frozen=True,
        json_schema_extra={"type": ["string", "object"]},
    )

    @model_validator(mode="before")
    @classmethod
    def _one_for_all(cls, data: Any) -> Any:
        return data if isinstance(data, dict) else {ALL: data}


@final
class Over(RootModel[Annotated[Mapping[Name, Domain | None], Field(min_length=1)]]):
    """Controls that take all values of their domain, or of an interval of it."""

    model_config = ConfigDict(
        strict=True,
        frozen=True,
        json_schema_extra={"type": ["array", "object"], "items": {"type": "string"}},
    )

    @model_validator(mode="before")
    @classmethod
    def _names_alone(cls, data: Any) -> Any:
        if not isinstance(data, list | tuple):
            return data
        for index, name in enumerate(data):
            if not isinstance(name, str):
                message = f"expected the name of a control, got {described(name)}"
                refuse([Mistake("S103", message, "write `over: [gain]`", (index,))])
        return dict.fromkeys(data)


@final
class ClaimOptions(StrictModel):
    """What a claim says beside its sentence."""

    at: Mapping[Name, Quantity] = Field(
        default={},
        description="Where the fixed points counted are: for some states a number in its unit, a "
        "quantity, or an expression of controls and constants.",
        examples=[{"x": 0, "v": "x1/2"}],
    )
    reaches: Mapping[Name, Domain] = Field(
        default={},
        description="How far the cycles counted swing: for some states the lowest and the highest "
        "value, as numbers, quantities, or expressions of controls and constants.",
        examples=[{"x": [-2, 2]}],
    )
    period: Quantity | None = Field(
        default=None,
        description="The period of the cycles counted: a number in seconds, a quantity, or an "
        "expression of controls and constants.",
        examples=["(x1 - x2)/v1 + (x1 - x2)/v2"],
    )
    within: Within | None = Field(
        default=None,
        description="How far `at`, `reaches` and `period` may be off: a share (of the state's "
        "domain, of the period), or for each state a quantity or a share, with the period's under "
        "`period`. Without it, 1 %.",
        examples=["2 %"],
    )
    over: Over | None = Field(
        default=None,
        description="The controls that take all values: names for their whole domains, or an "
        "interval for each.",
        examples=[["v1", "v2"]],
    )
    where: Mapping[Name, Quantity] = Field(
        default={},
        description="Controls at other values than their defaults, and states that are held.",
        examples=[{"mu": 1}],
    )
    called: Identifier | None = Field(
        default=None,
        description="A name for what is counted, for the claims below.",
        examples=["home"],
    )


def _either(schema: dict[str, Any]) -> None:
    """A sentence may stand alone."""
    mapping = {key: schema.pop(key) for key in tuple(schema) if key not in {"title", "description"}}
    schema["anyOf"] = [{"type": "string", "minLength": 1}, {**mapping, "maxProperties": 1}]


@final
class ClaimSpec(RootModel[Annotated[Mapping[Text, ClaimOptions], Field(min_length=1)]]):
    """A claim: a sentence, and what it says beside."""

    model_config = ConfigDict(strict=True, frozen=True, json_schema_extra=_either)

    @property
    def sentence(self) -> str:
        """How many features of which type."""
        return next(iter(self.root))

    @property
    def options(self) -> ClaimOptions:
        """Where, how long, over which controls."""
        return self.root[self.sentence]

    @model_validator(mode="before")
    @classmethod
    def _sentence_alone(cls, data: Any) -> Any:
        return {data: {}} if isinstance(data, str) else data

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        for more in list(self.root)[1:]:
            message = "two claims in one entry"
            yield Mistake("S272", message, "begin each with its own '-'", (more,), on_key=True)
