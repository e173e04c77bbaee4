"""specs/README.md lists the library, in the words of the specs themselves."""

import re
from pathlib import Path

SPECS = Path(__file__).parents[1] / "specs"
PARTS = "thesis"
"""A folder of parts of two figures, which the list names as a whole."""


def abouts() -> dict[str, str]:
    """Of each spec in the library: its path, and what it says of itself."""
    found = {}
    for file in SPECS.rglob("*.yaml"):
        if file.parent.name != PARTS:
            told = re.search(
                r"^about: \"?(.*?)\"?$", file.read_text(encoding="utf-8"), re.MULTILINE
            )
            found[file.relative_to(SPECS).as_posix()] = told[1] if told else "no about"
    return found


def test_the_list_names_every_spec_with_what_it_says_of_itself() -> None:
    lines = (SPECS / "README.md").read_text(encoding="utf-8")

    listed = dict(re.findall(r"^\| \[[^\]]*\]\(([^)]*)\) \| (.*) \|$", lines, re.MULTILINE))

    assert listed == abouts()
