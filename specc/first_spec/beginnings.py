"""The specs that specc ships, as a beginning for the user's own."""

import re
from importlib import resources
from pathlib import Path

from spec_schema.names import RESERVED
from spec_schema.suggest import did_you_mean
from specc.faults import fault


def templates() -> dict[str, str]:
    """The texts of the specs that specc ships, by name."""
    return {
        name.removesuffix(".yaml"): text
        for name, text in _library().items()
        if name.endswith(".yaml")
    }


def companions(template: str) -> dict[str, str]:
    """The Python modules that a template's field calls, by file name."""
    called = re.findall(r'call: "?(\w+):', templates().get(template, ""))
    return {name: text for name, text in _library().items() if name.removesuffix(".py") in called}


def _library() -> dict[str, str]:
    folder = resources.files("specc") / "templates"
    if not folder.is_dir():  # an editable install: the library stands at the repository's root
        folder = Path(__file__).resolve().parents[2] / "specs"
    entries = sorted(folder.iterdir(), key=lambda entry: entry.name)
    return {
        entry.name: entry.read_text(encoding="utf-8")
        for entry in entries
        if entry.name.endswith((".yaml", ".py"))
    }


def list_templates() -> str:
    """The templates, each with what it is about."""
    rows = []
    for name, text in templates().items():
        about = re.search(r"^about: (.*)$", text, re.MULTILINE)
        rows.append(f"{name:16} {about[1] if about else ''}")
    return "\n".join(rows)


def from_template(template: str, name: str) -> str:
    """A template's text under another name.

    Raises:
        SpecError: there is no such template.
    """
    known = templates()
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
