"""The model of a scenario's training: what an arbiter's decisions are rewarded for."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Final, Self, final

from pydantic import Field, model_validator

from spec_schema.mistake import Mistake, refuse
from spec_schema.value_types import Expression, Name, Number, StrictModel, Text

HOW: Final = ("rise", "fall", "most", "least", "mean", "last", "robustness")


@final
class MeasureSpec(StrictModel):
    """A number for each decision, of what happened since the decision before: one of these."""

    rise: Expression | None = Field(
        default=None,
        description="The last value minus the first of a quantity of the run.",
        examples=["r.odom.x"],
    )
    fall: Expression | None = Field(
        default=None,
        description="The first value minus the last of a quantity of the run.",
        examples=["hypot(r.x - 5 m, r.y - 3 m)"],
    )
    most: Expression | None = Field(
        default=None,
        description="The greatest value of a quantity of the run.",
        examples=["r.contacts"],
    )
    least: Expression | None = Field(
        default=None,
        description="The smallest value of a quantity of the run.",
        examples=["r.clearance"],
    )
    mean: Expression | None = Field(
        default=None,
        description="The mean over time of a quantity of the run.",
        examples=["r.lamp.light"],
    )
    last: Expression | None = Field(
        default=None,
        description="The value of a quantity of the run when it decides anew.",
        examples=["r.lamp.light"],
    )
    robustness: Text | None = Field(
        default=None,
        description="A sentence as under `require`: by how much the whole run satisfies it. It is "
        "given at the last decision of the run, and is 0 before.",
        examples=["always r.clearance > 5 cm"],
    )

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        refuse(self._mistakes())
        return self

    def _mistakes(self) -> Iterator[Mistake]:
        given = [key for key in HOW if getattr(self, key) is not None]
        if len(given) != 1:
            what = " and ".join(given) if given else "nothing"
            message = f"a measure is one thing of the run; this one is {what}"
            yield Mistake("S310", message, f"write one of: {', '.join(HOW)}", on_key=True)


@final
class TrainingSpec(StrictModel):
    """How `specc train` trains an arbiter of this scenario."""

    arbiter: Text = Field(
        description="What is trained, as ROBOT.NODE: an arbiter that decides by alcsr or xcsr.",
        examples=["r.choose"],
    )
    reward: Expression = Field(
        description="What each decision is rewarded with: an expression of the measures, which "
        "are plain numbers in SI.",
        examples=["progress - 10 * contact"],
    )
    measures: Annotated[Mapping[Name, MeasureSpec], Field(min_length=1)] = Field(
        description="By name, what happened since the decision before.",
        examples=[{"contact": {"most": "r.contacts"}}],
    )
    ends_when: Text | None = Field(
        default=None,
        description="The episode is over for learning when this first holds: a comparison of "
        "quantities of the run. Without it, only at the end of the run.",
        examples=["hypot(r.x - 5 m, r.y - 3 m) < 0.4 m"],
    )
    discount: Annotated[Number, Field(ge=0, le=1)] = Field(
        default=0.98,
        description="What a reward is worth one decision later, from 0 to 1.",
        examples=[0.98],
    )
