"""The figures of a book as SVG, each for light and for dark pages."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeAlias

from runtime.progress import Progress
from specc.book.contents import Contents
from specc.book.naming import RUN, Names
from specc.figures.decisions import draw_decisions
from specc.figures.palettes import PALETTES
from specc.figures.portrait import draw_portrait
from specc.figures.rate_plane import draw_rate_plane
from specc.figures.style import Picture, rendered
from specc.figures.style_names import Style
from specc.figures.wiring import draw_wiring
from specc.figures.world import draw_world
from specc.scenarios.pictured import pictured
from specc.wired import wired

Draw: TypeAlias = Callable[[Style], Picture]
ENDS = {Style.SCREEN: ".svg", Style.DARK: ".dark.svg"}


def figures_of(contents: Contents, names: Names, progress: Progress) -> dict[str, bytes]:
    """Every figure by its path in the book."""
    wanted = list(_drawings(contents, names))
    found = {}
    for done, (name, draw) in enumerate(wanted):
        progress(f"drawing {name}", done, len(wanted))
        for style, end in ENDS.items():
            found[f"figures/{name}{end}"] = rendered(draw(style), "svg", PALETTES[style])
    return found


def _drawings(contents: Contents, names: Names) -> Iterator[tuple[str, Draw]]:
    if contents.run is not None:
        yield RUN, partial(draw_world, *pictured(contents.run.run, contents.run.requirements))
    for of in contents.architectures:
        yield names.wiring(of.architecture), partial(draw_wiring, wired(of.architecture, of.body))
        for shown in of.nodes:
            for k, view in enumerate(shown.portraits):
                name = names.portrait(of.architecture, shown.node, k)
                yield name, partial(draw_portrait, view.portrait)
            for k, plane in enumerate(shown.speeds, len(shown.portraits)):
                name = names.portrait(of.architecture, shown.node, k)
                yield name, partial(draw_rate_plane, plane)
            for k, decisions in enumerate(shown.decisions):
                name = names.portrait(of.architecture, shown.node, k)
                yield name, partial(draw_decisions, decisions.portrait)
