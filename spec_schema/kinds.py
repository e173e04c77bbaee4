"""What a spec file can describe, and the model of each."""

from typing import TypeAlias

from spec_schema.arbiter import ArbiterSpec
from spec_schema.architecture import ArchitectureSpec
from spec_schema.behavior import BehaviorSpec
from spec_schema.body import BodySpec
from spec_schema.project import ProjectSpec
from spec_schema.scenario import ScenarioSpec
from spec_schema.world import WorldSpec

AnySpec: TypeAlias = (
    BehaviorSpec
    | ProjectSpec
    | BodySpec
    | ArbiterSpec
    | ArchitectureSpec
    | WorldSpec
    | ScenarioSpec
)

MODELS: dict[str, type[AnySpec]] = {
    "behavior": BehaviorSpec,
    "project": ProjectSpec,
    "body": BodySpec,
    "arbiter": ArbiterSpec,
    "architecture": ArchitectureSpec,
    "world": WorldSpec,
    "scenario": ScenarioSpec,
}
"""The model for each value of `kind:`."""
