"""The model of an architecture: behaviors and control modules, wired to one another and a body."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Final, Literal, Self, TypeAlias, final

from pydantic import BeforeValidator, Field, Strict, model_validator

from spec_schema.mistake import Mistake, refuse, refused
from spec_schema.value_types import (
    Callee,
    Expression,
    Identifier,
    Name,
    Quantity,
    StrictModel,
    Text,
    Version,
)
from spec_schema.wires import WireSpec
from spec_schema.wording import described

NodeNames: TypeAlias = Annotated[tuple[Name, ...], Strict(strict=False)]


@final
class Acting(StrictModel):
    """What a choice means: the nodes that act, and the controls that are set while it holds."""

    act: NodeNames = Field(
        default=(), description="The nodes that act while it holds.", examples=[["seek"]]
    )
    set: Mapping[Text, Quantity] = Field(
        default={},
        description="Controls of nodes, as NODE.CONTROL, and their values while it holds.",
        examples=[{"seek.speed": "0.1 m/s"}],
    )


def _spelled_out(value: object) -> object:
    """A bare node, or a list of nodes, as the mapping that it is short for."""
    if isinstance(value, str):
        return {"act": [value]}
    return {"act": value} if isinstance(value, list | tuple) else value


ActingSpec: TypeAlias = Annotated[
    Acting, BeforeValidator(_spelled_out, json_schema_input_type=Text | NodeNames | Acting)
]


@final
class NodeSpec(StrictModel):
    """A behavior or control module that runs in parallel with all others."""

    behavior: Text | None = Field(
        default=None,
        description="A behavior spec, as a path from this file.",
        examples=["seek.yaml"],
    )
    arbiter: Text | None = Field(
        default=None,
        description="An arbiter spec, as a path from this file.",
        examples=["choose.yaml"],
    )
    module: Callee | None = Field(
        default=None,
        description="A Python function of yours that maps what it reads to what it tells; it is "
        "run only where you allow it.",
        examples=["modules:mood"],
    )
    tells: Mapping[Name, Text] = Field(
        default={},
        description="Of a module: what it tells others, each with its unit.",
        examples=[{"urgency": "1"}],
    )
    period: Quantity = Field(
        description="The time between two samples of its inputs.", examples=["50 ms"]
    )
    response_time: Quantity = Field(
        default=0.0,
        description="How much later than its sample it acts, whatever time a computer takes.",
        examples=["50 ms"],
    )
    sense: Mapping[Name, WireSpec] = Field(
        default={},
        description="For each sensed state (of an arbiter or module: each quantity that it reads) "
        "where its value comes from.",
        examples=[{"distance": "left.range"}],
    )
    set: Mapping[Name, WireSpec] = Field(
        default={},
        description="For each control that is not left at its default, where its value comes from.",
        examples=[{"speed": "0.2 m/s"}],
    )
    acts_when: Expression | None = Field(
        default=None,
        description="Of a behavior: it acts only where this expression of its own states, controls "
        "and constants holds; without it, whenever no arbiter keeps it from acting.",
        examples=["distance < near"],
    )
    choices: Mapping[Name, ActingSpec] = Field(
        default={},
        description="Of an arbiter: for each choice the nodes that act.",
        examples=[{"seek": ["seek"], "avoid": {"act": ["avoid"]}}],
    )
    replaces: NodeNames = Field(
        default=(),
        description="Of a combined behavior: the nodes in whose place it acts where all of them "
        "would act at once.",
        examples=[["seek", "avoid"]],
    )

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        kinds = ("behavior", "arbiter", "module")
        given = [key for key in kinds if getattr(self, key) is not None]
        if len(given) != 1:
            what = " and ".join(given) if given else "nothing"
            message = f"a node is a behavior, an arbiter or a module; this one is {what}"
            yield Mistake("S315", message, "write one of them: 'behavior: seek.yaml'", on_key=True)
            return
        only = {"choices": "arbiter", "acts_when": "behavior", "replaces": "behavior"}
        for key, kind in {**only, "tells": "module"}.items():
            if key in self.model_fields_set and given != [kind]:
                message = f"'{key}' is for a node that is {_a(kind)}; this one is {_a(given[0])}"
                yield Mistake("S316", message, f"remove '{key}'", (key,), on_key=True)


def _listed(value: object) -> object:
    """An arbiter by its name, as a list of one."""
    return [value] if isinstance(value, str) else value


ExclusiveSpec: TypeAlias = Annotated[
    NodeNames, BeforeValidator(_listed, json_schema_input_type=Text | NodeNames)
]


WAYS: Final = ("exclusive", "sum", "blend", "priority", "function")

EXAMPLES: Final = {
    "exclusive": "{exclusive: [seek, avoid]} with your nodes, or {exclusive: choose} with your "
    "arbiter",
    "sum": "{sum: [seek, avoid]} with your nodes",
    "blend": "{blend: choose} with your arbiter",
    "priority": "{priority: [avoid, seek]} with your nodes",
    "function": "{function: modules:mix} with your Python function",
}
"""What to write where nothing but the way is named."""


@final
class ResolutionSpec(StrictModel):
    """How a channel is resolved that several behaviors reach: exactly one way."""

    exclusive: ExclusiveSpec | None = Field(
        default=None,
        description="They never act at once; the arbiter that sees to it, or a list of the nodes "
        "where their own conditions do. It is proved.",
        examples=["choose", ["seek", "avoid"]],
    )
    sum: NodeNames | None = Field(
        default=None, description="What they want is added.", examples=[["seek", "avoid"]]
    )
    blend: Name | None = Field(
        default=None,
        description="What they want is weighed by this arbiter's choices, over those that act.",
        examples=["choose"],
    )
    priority: NodeNames | None = Field(
        default=None,
        description="The first of these that acts has its way.",
        examples=[["avoid", "seek"]],
    )
    function: Callee | None = Field(
        default=None,
        description="A Python function of yours; it is run only where you allow it.",
        examples=["modules:mix"],
    )

    @model_validator(mode="before")
    @classmethod
    def _is_mapping(cls, value: object) -> object:
        """A way and its nodes without the brackets that make a mapping of them."""
        if isinstance(value, str):
            way, _, rest = value.strip().partition(" ")
            meant = f"{{exclusive: {value}}}" if value.isidentifier() else EXAMPLES["exclusive"]
            if way in WAYS:
                meant = f"{{{way}: {rest.strip()}}}" if rest else EXAMPLES[way]
            raise refused("S103", f"expected a mapping, got {described(value)}", f"write {meant}")
        return value

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        given = [key for key in WAYS if getattr(self, key) is not None]
        if len(given) != 1:
            what = " and ".join(given) if given else "nothing"
            message = f"a channel is resolved in one way; this one by {what}"
            refuse([Mistake("S317", message, f"write one of: {', '.join(WAYS)}", on_key=True)])
        return self


@final
class ArchitectureSpec(StrictModel):
    """An architecture: nodes that run in parallel, and how they are wired."""

    specc: Version = Field(description="The version of the language: 1.", examples=[1])
    kind: Literal["architecture"] = Field(
        description="What the file describes.", examples=["architecture"]
    )
    name: Identifier = Field(description="The architecture's name.", examples=["find_light"])
    about: Text | None = Field(
        default=None, description="What it does, in a sentence.", examples=["Find the light."]
    )
    body: Text = Field(
        description="The body that it drives: a spec, as a path from this file.",
        examples=["bodies/courier.yaml"],
    )
    nodes: Annotated[Mapping[Name, NodeSpec], Field(min_length=1)] = Field(
        description="The behaviors and control modules.",
        examples=[{"seek": {"behavior": "seek.yaml", "period": "50 ms"}}],
    )
    channels: Mapping[Text, ResolutionSpec] = Field(
        default={},
        description="For each channel that several behaviors reach, how that is resolved.",
        examples=[{"base.turn": {"exclusive": "choose"}}],
    )


def _a(kind: str) -> str:
    return f"an {kind}" if kind == "arbiter" else f"a {kind}"
