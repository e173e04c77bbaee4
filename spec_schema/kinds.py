"""What a spec file can describe, and the model of each."""

from typing import TypeAlias

from spec_schema.behavior import BehaviorSpec
from spec_schema.project import ProjectSpec

AnySpec: TypeAlias = BehaviorSpec | ProjectSpec

MODELS: dict[str, type[AnySpec]] = {"behavior": BehaviorSpec, "project": ProjectSpec}
"""The model for each value of `kind:`."""
