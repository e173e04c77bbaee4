"""The specs that specc ships, as a beginning for the user's own."""

import re
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from spec_schema.names import RESERVED
from spec_schema.suggest import did_you_mean
from specc.faults import fault
from specc.first_spec.sets import FIRST, set_of


def templates() -> dict[str, str]:
    """The texts of the specs that specc ships, by name."""
    return {
        name.removesuffix(".yaml"): text
        for name, text in _library().items()
        if name.endswith(".yaml")
    }


def companions(template: str) -> dict[str, str]:
    """What a template does not stand without, by file name: Python modules, specs that it names."""
    if template in FIRST:
        return dict(list(set_of(template, _folder()).items())[1:])
    called = re.findall(r'call: "?(\w+):', templates().get(template, ""))
    return {name: text for name, text in _library().items() if name.removesuffix(".py") in called}


def _folder() -> Traversable:
    folder = resources.files("specc") / "templates"
    if folder.is_dir():
        return folder
    # An editable install: the library stands at the repository's root.
    return Path(__file__).resolve().parents[2] / "specs"


def _library() -> dict[str, str]:
    entries = sorted(_folder().iterdir(), key=lambda entry: entry.name)
    return {
        entry.name: entry.read_text(encoding="utf-8")
        for entry in entries
        if entry.name.endswith((".yaml", ".py"))
    }


def list_templates() -> str:
    """The templates, each with what it is about."""
    rows = []
    for name, text in {**_firsts(), **templates()}.items():
        about = re.search(r"^about: (.*)$", text, re.MULTILINE)
        rows.append(f"{name:16} {about[1] if about else ''}")
    return "\n".join(rows)


def _firsts() -> dict[str, str]:
    """The first specs of all that is no behavior."""
    return {template: next(iter(set_of(template, _folder()).values())) for template in FIRST}


def from_template(template: str, name: str) -> str:
    """A template's text under another name.

    Raises:
        SpecError: there is no such template.
    """
    known = _firsts() | templates()
    if template not in known:
        remedy = did_you_mean(template, list(known)) or f"there are {', '.join(known)}"
        raise fault("V343", template, f"no template is named '{template}'", remedy)
    return re.sub(
        r"^name: .*$", f"name: {identifier(name)}", known[template], count=1, flags=re.MULTILINE
    )


def identifier(text: str) -> str:
    """A name that a spec may carry, as near to `text` as can be."""
    word = re.sub(r"\W+", "_", text, flags=re.ASCII).strip("_").lower() or "behavior"
    word = f"b_{word}" if word[0].isdigit() else word
    return f"{word}_" if word in RESERVED | {"true", "false", "null"} else word[:64]
