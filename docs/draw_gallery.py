"""Draws the gallery: docs/img/*.svg and docs/gallery.md. Run by `make gallery`."""
# ruff: noqa: INP001  a script, no part of a package

import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

from specc.cli import main

DOCS: Final = Path(__file__).parent
ROOT: Final = DOCS.parent


@final
@dataclass(frozen=True, slots=True)
class Plate:
    """One picture: its file, what `specc` is told, and what is to be seen."""

    name: str
    told: str
    caption: str
    command: str = "portrait"


PLATES: Final = (
    Plate("patrol", "specs/patrol.yaml --sweep going=forward,back",
          "The patrol of the thesis's figure 3.1 as two modes, one panel each: the same cycle "
          "runs through both; dotted, the velocity reverses at once where a mode is left."),
    Plate("patrol_turning", "specs/patrol_turning.yaml",
          "The patrol that turns at a constant acceleration: the upright sides are parabolas."),
    Plate("patrol_sketch", "specs/patrol_sketch.yaml",
          "The same behavior sketched as an orbit: a cycle that attracts, and the focus within "
          "that index theory demands."),
    Plate("two_homes", "specs/two_homes.yaml",
          "A sketch of two attractors: the saddle between them follows."),
    Plate("van_der_pol", "specs/van_der_pol.yaml",
          "Van der Pol's oscillator: nullclines, the cycle, and what is lost over the edge."),
    Plate("van_der_pol_sweep", "specs/van_der_pol.yaml --sweep mu=0.1:3:6 --style journal",
          "Small multiples over a control, in the journal's style."),
    Plate("hopf", "docs/gallery/hopf.yaml --against mu",
          "A bifurcation diagram: where the rhythm is born, located by bisection."),
    Plate("duffing", "docs/gallery/duffing.yaml",
          "Basins of attraction, parted by the stable manifold of the saddle."),
    Plate("duffing_dark", "docs/gallery/duffing.yaml --style dark",
          "The same for a dark page."),
    Plate("fifteen", "docs/gallery/fifteen.yaml",
          "Fifteen fixed points, each proved, and proved to be all there are."),
    Plate("pendulum", "specs/pendulum.yaml",
          "A cylinder: the angle wraps, paths are cut at the seam, the saddle stands on it."),
    Plate("lorenz", "docs/gallery/lorenz.yaml --axes x,y,z",
          "Three variables: the unstable manifold of the origin draws the attractor."),
    Plate("keep_left", "specs/keep_left.yaml", "One variable: a phase line."),
    Plate("thesis_3_2", "specs/architectures/thesis_3_2.yaml",
          "Three base behaviors in parallel and their control interfaces (figure 3.2 of the "
          "thesis); all three reach both channels, which is resolved by priority.", "wiring"),
    Plate("thesis_3_3", "specs/architectures/thesis_3_3.yaml",
          "A control architecture with two levels of control modules (figure 3.3).", "wiring"),
)  # fmt: skip


def draw(plate: Plate) -> str:
    """Draws one plate; gives its lines in the gallery."""
    picture = DOCS / "img" / f"{plate.name}.svg"
    status = main([plate.command, *shlex.split(plate.told), "-o", str(picture)])
    assert status == 0, plate.told
    shown = f"![{plate.name}](img/{picture.name})"
    return f"{plate.caption}\n\n`specc {plate.command} {plate.told}`\n\n{shown}\n"


def draw_all() -> None:
    """Draws every plate and writes the page that shows them."""
    top = "# Gallery\n\nDrawn by `make gallery`; every picture is one command.\n"
    (DOCS / "gallery.md").write_text("\n".join([top, *map(draw, PLATES)]), encoding="utf-8")


if __name__ == "__main__":
    draw_all()
