"""Draws the gallery: docs/img/* and docs/gallery.md. Run by `make gallery`.

With names it draws only these pictures again.
"""
# ruff: noqa: INP001  a script, no part of a package

import shlex
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

from specc.cli import main

DOCS: Final = Path(__file__).parent
ROOT: Final = DOCS.parent


@final
@dataclass(frozen=True, slots=True)
class Plate:
    """One picture: its file, what `specc` is told, and what is to be seen.

    option: by which the command is told the file. A run may violate what is required of it.
    """

    name: str
    told: str
    caption: str
    command: str = "portrait"
    option: str = "-o"
    suffix: str = ".svg"


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
          "Three variables: the unstable manifold of the origin draws the attractor.",
          suffix=".png"),
    Plate("keep_left", "specs/keep_left.yaml", "One variable: a phase line."),
    Plate("thesis_3_2", "specs/architectures/thesis_3_2.yaml",
          "Three base behaviors in parallel and their control interfaces (figure 3.2 of the "
          "thesis); all three reach both channels, which is resolved by priority.", "wiring"),
    Plate("thesis_3_3", "specs/architectures/thesis_3_3.yaml",
          "A control architecture with two levels of control modules (figure 3.3): each level "
          "offers fewer controls.", "wiring"),
    Plate("wired_subsumption", "specs/architectures/light_subsumption.yaml",
          "Three of the library's behaviors, coordinated by layers to find a light.", "wiring"),
    Plate("light_subsumption", "specs/scenarios/light_subsumption.yaml",
          "A run of it: the robot's way, coloured by who acts; the light on the floor at the end; "
          "and what was required.", "simulate", "--poster"),
    Plate("light_dynamics", "specs/scenarios/light_dynamics.yaml",
          "The same behaviors, the same world, coordinated by a competition; a mixture is coloured "
          "by its largest part.", "simulate", "--poster"),
    Plate("find_light_wiring", "specs/architectures/find_light.yaml",
          "One arbiter above two behaviors that reach the same two channels.", "wiring"),
    Plate("first_light", "specs/scenarios/first_light.yaml --seed 9",
          "A run of it, around a desk to the lamp.", "simulate", "--poster"),
    Plate("first_light_journal", "specs/scenarios/first_light.yaml --seed 9 --style journal",
          "The same for a journal in grey.", "simulate", "--poster"),
    Plate("bumping_cart", "specs/scenarios/bumping_cart.yaml",
          "Where only one behavior ever acts, ways are coloured by time. A rectangular robot that "
          "backs up and turns gets stuck (section 2.5 of the thesis).", "simulate", "--poster"),
    Plate("random_walker", "specs/scenarios/random_walker.yaml",
          "A round one that moves at random does not: a wall holds it for 1.3 s at most.",
          "simulate", "--poster"),
    Plate("errand_learned", "specs/scenarios/errand_learned.yaml --seed 1003 -d '56 s'",
          "An errand by learned rules: to the charger first, along the wall until the lamp is "
          "seen, and to it.", "simulate", "--poster"),
    Plate("errand_regions", "specs/arbiters/errand_learned.yaml --axes left,right "
          "--sweep used=0.05,0.5 --at dock=1 --at lamp=0 --at ahead=0.9 --at dock_distance=1.2",
          "What these rules decide where the dock is seen: turn away from what is near on the "
          "right, follow what is near on the left, else go to the dock; with half of the battery "
          "used, from nearer to a wall."),
    Plate("light_subsumption_film", "specs/scenarios/light_subsumption.yaml -d '55 s' --speed 8",
          "A film: arcs are what range sensors say, somewhere on each is something; the line is "
          "what the robot sees of the light.", "simulate", "--animate", ".gif"),
)  # fmt: skip


def draw(plate: Plate) -> None:
    """Draws one plate."""
    told = [plate.command, *shlex.split(plate.told), plate.option, str(_file(plate))]
    assert main(told) in ({0, 1, 4} if plate.command == "simulate" else {0}), plate.told


def entry(plate: Plate) -> str:
    """The lines of a plate in the gallery."""
    picture = _file(plate)
    is_usual = (plate.option, plate.suffix) == ("-o", ".svg")
    to = "" if is_usual else f" {plate.option} {picture.name}"
    shown = f"![{plate.name}](img/{picture.name})"
    return f"{plate.caption}\n\n`specc {plate.command} {plate.told}{to}`\n\n{shown}\n"


def _file(plate: Plate) -> Path:
    return DOCS / "img" / f"{plate.name}{plate.suffix}"


def draw_all(names: list[str]) -> None:
    """Draws the plates of these names, all where none is given; writes the page that shows all."""
    for plate in PLATES:
        if not names or plate.name in names:
            draw(plate)
    top = "# Gallery\n\nDrawn by `make gallery`; every picture is one command.\n"
    (DOCS / "gallery.md").write_text("\n".join([top, *map(entry, PLATES)]), encoding="utf-8")


if __name__ == "__main__":
    draw_all(sys.argv[1:])
