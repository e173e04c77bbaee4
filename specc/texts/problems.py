"""What there is to learn and who learns it, as text for people and as a record for programs."""

from typing import Any, Final

from lcs.problems.problem import Problem
from lcs.problems.registry import COLUMNS, MEANINGS, PROBLEMS, SPLIT, WORLDS, Offer
from lcs.problems.steps import Plane
from specc.learning.learners import ALL, LEARNERS, OF_WORLDS
from specc.learning.meanings import CONSTANTS, idle
from specc.learning.settings import choices, listed, shown
from verifier.report.layout import INDENT, section, table

TABLE: Final = "FILE.csv"
"""How the problem of a table is listed."""


def listing_text(learner: str) -> str:
    """Problems, what they are made with, learners, and all that can be set of one of them."""
    problems = [(name, offer.about) for name, offer in PROBLEMS.items()]
    problems.append((TABLE, "the rows of a table; its first line names the columns"))
    worlds = [(name, offer.about) for name, offer in WORLDS.items()]
    learners = [(name, known.about) for name, known in LEARNERS.items()]
    of_worlds = [(name, known.about) for name, known in OF_WORLDS.items()]
    config = ALL[learner].config
    constants = [
        (name, shown(value), _said_of(name, value, learner)) for name, value in listed(config)
    ]
    return "\n\n".join(
        [
            section("problems of one step", [table(problems, INDENT)]),
            section("worlds of several steps", [table(worlds, INDENT)]),
            section("made with (--with NAME=VALUE)", [table(_made_with(), INDENT)]),
            section("learners of problems (--learner NAME)", [table(learners, INDENT)]),
            section("learner of worlds", [table(of_worlds, INDENT)]),
            section(f"constants of {learner} (--set NAME=VALUE)", [table(constants, INDENT)]),
        ]
    )


def listing_record(learner: str) -> dict[str, Any]:
    """The same for programs."""
    return {
        "problems": {name: _offered(offer) for name, offer in PROBLEMS.items()},
        "worlds": {name: _offered(offer) for name, offer in WORLDS.items()},
        "learners": {name: known.about for name, known in ALL.items()},
        "constants": {name: shown(value) for name, value in listed(ALL[learner].config)},
    }


def _offered(offer: Offer[Any]) -> dict[str, Any]:
    """What a problem is, and with what it is made if nothing else is said."""
    made_with = {key: shown(value) for key, value in offer.defaults.items()}
    return {"about": offer.about, "with": made_with}


def _said_of(name: str, value: object, learner: str) -> str:
    """What a constant means, what may be written, and whether it does nothing as all is set."""
    said = CONSTANTS[learner][name]
    if not _is_number(value):
        said += f": {choices(value).removeprefix('write ')}"
    while_ = idle(ALL[learner].config).get(name)
    return f"{said} (does nothing while {while_})" if while_ else said


def _made_with() -> list[tuple[str, str, str]]:
    """Each name, what it means, and whom it belongs to."""
    owners: dict[str, list[str]] = {name: [] for name in MEANINGS}
    offers: dict[str, Offer[Problem | Plane]] = {**PROBLEMS, **WORLDS}
    for name, offer in offers.items():
        for key in offer.defaults:
            owners[key].append(name)
    for key in {**COLUMNS, **SPLIT}:
        owners[key].append(TABLE)
    return [(name, meaning, _families(owners[name])) for name, meaning in MEANINGS.items()]


def _families(names: list[str]) -> str:
    """Problems by the word that their names begin with.

    >>> _families(["multiplexer_6", "multiplexer_11", "scitos_2"])
    'multiplexer, scitos'
    """
    return ", ".join(dict.fromkeys(name.partition("_")[0] for name in names))


def _is_number(value: object) -> bool:
    return type(value) in {int, float}
