"""What is shot: the model on its grid, the samples, the windows."""

from dataclasses import dataclass
from typing import final

from verifier.fidelity.shooting.prediction import Model
from verifier.fidelity.shooting.samples import Samples
from verifier.fidelity.shooting.windows import Windows
from verifier.fidelity.stretches.needs import Needs

FRACTIONS = (0.2, 0.5, 1.0)
"""The horizons that are reported, as shares of the declared one, which comes last."""


@final
@dataclass(frozen=True, eq=False, slots=True)
class Plan:
    """All that shooting needs but the noise."""

    needs: Needs
    model: Model
    samples: tuple[Samples, ...]
    windows: Windows

    @property
    def horizons(self) -> tuple[float, ...]:
        """Ascending; the declared one comes last."""
        return tuple(share * self.windows.horizon for share in FRACTIONS)

    def part(self, part: slice) -> "Plan":
        """The plan with some of its windows."""
        return Plan(self.needs, self.model, self.samples, self.windows.part(part))
