"""The documentation is held against the code: examples, keys, codes, messages, links.

The language is `docs/spec_language.md` and `docs/architecture_language.md`. The first YAML block is
the base spec. A block that begins with `specc:` is a spec of its own; any other is a fragment that
is put into the base as that page says. A comment
`<!-- file: NAME -->` names the file that the next block stands for, `<!-- run -->` a script that
makes one.
"""

import json
import re
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from compiler.check import check
from compiler.compile_file import compile_file
from spec_schema.diagnostics import Severity, render
from spec_schema.expressions.tree import FUNCTIONS
from spec_schema.json_schema import json_schema
from spec_schema.kinds import MODELS
from spec_schema.model_walk import keys_at
from spec_schema.node import plain
from spec_schema.source import Source
from spec_schema.yaml_reader import read
from specc.cli import main
from tests.study import agents

ROOT = Path(__file__).parents[1]
LANGUAGE = "\n".join(
    (ROOT / "docs" / page).read_text(encoding="utf-8")
    for page in ("spec_language.md", "architecture_language.md")
)
ERRORS = (ROOT / "docs" / "errors.md").read_text(encoding="utf-8")
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
BLOCK = re.compile(r"(?:<!-- (?P<mark>[^\n]*) -->\n)?```(?P<kind>\w+)\n(?P<text>.*?)```", re.DOTALL)
GROWING = {"state", "control", "constants", "output", "trace"}
RESHAPING = {"field", "table"}
SAID = re.compile(r": (?:error|warning)\[([SV]\d\d\d)\]: ")


def blocks(kind: str) -> Iterator[tuple[int, str, str]]:
    """Line, mark and text of each block of the page."""
    for found in BLOCK.finditer(LANGUAGE):
        if found["kind"] == kind:
            line = LANGUAGE.count("\n", 0, found.start("text")) + 1
            yield line, found["mark"] or "", found["text"]


EXAMPLES = {f"line {line}": text for line, _, text in blocks("yaml")}
BASE = next(iter(EXAMPLES.values()))


def as_data(text: str) -> dict[str, object]:
    root = read(Source("example", text))
    return {name: plain(entry.value) for name, entry in root.entries.items()}


def whole(text: str) -> dict[str, object]:
    """The spec that an example shows: itself, or the base with it."""
    shown = as_data(text)
    if "specc" in shown:
        return shown
    spec = as_data(BASE)
    for key, value in shown.items():
        before = spec.get(key)
        grows = key in GROWING and isinstance(before, dict) and isinstance(value, dict)
        spec[key] = {**before, **value} if grows else value
    return spec


@pytest.fixture
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files that the page shows."""
    monkeypatch.chdir(tmp_path)
    for kind in ("csv", "python", "yaml"):
        for _, mark, text in blocks(kind):
            if mark.startswith("file: "):
                (tmp_path / mark.removeprefix("file: ")).write_text(text, encoding="utf-8")
            elif mark == "run":
                exec(compile(text, "spec_language.md", "exec"), {})  # noqa: S102  our own page
    return tmp_path


@pytest.mark.parametrize("place", EXAMPLES)
def test_an_example_of_the_language_has_no_error(place: str, beside: Path) -> None:
    text = EXAMPLES[place]
    path = beside / "example.yaml"
    path.write_text(json.dumps(whole(text), indent=1), encoding="utf-8")

    found = check(path)
    assert not [d for d in found if d.severity is Severity.ERROR], render(found)
    if RESHAPING & as_data(text).keys():
        compile_file(path, lambda _what, _done, _of: None, allow_code=True)


@pytest.mark.usefixtures("beside")
def test_the_scenario_of_the_page_runs_with_the_python_that_it_shows(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["simulate", "first_try.yaml", "--allow-code", "-d", "1 s"]) in {0, 1, 4}

    assert "first_try: 1 s simulated, seed 7" in capsys.readouterr().out


@pytest.mark.usefixtures("beside")
def test_no_example_has_the_name_of_another_spec_of_the_library() -> None:
    ours = {path.stem for path in Path().glob("*.yaml")}
    library = {path.stem for path in (ROOT / "specs").rglob("*.yaml")}

    assert {"rover", "to_the_lamp", "first_try"} <= ours
    assert ours & library == set()


@pytest.mark.parametrize("place", EXAMPLES)
def test_an_example_is_read_as_it_stands(place: str) -> None:
    """What the reader of the page copies: the block's own YAML, not what a test makes of it."""
    assert as_data(EXAMPLES[place])


@pytest.mark.parametrize("kind", MODELS)
def test_every_key_is_named_and_shown(kind: str) -> None:
    shown = {pair for text in EXAMPLES.values() for pair in keys_used(whole(text))}

    for keys in models(kind):
        for key in keys:
            assert f"`{key}`" in LANGUAGE, f"the page does not name the key {key}"
            assert (keys, key) in shown, f"no example shows {key} among {sorted(keys)}"


def models(kind: str) -> Iterator[frozenset[str]]:
    """The keys of every mapping with fixed keys in a spec of this kind."""
    schema = json_schema(kind)
    for part in (schema, *schema.get("$defs", {}).values()):
        if "properties" in part:
            yield frozenset(part["properties"])


def keys_used(spec: dict[str, object]) -> Iterator[tuple[frozenset[str], str]]:
    """Each fixed key that the spec uses, with those that could stand beside it."""
    model = MODELS[str(spec["kind"])]
    waiting: list[tuple[tuple[str | int, ...], object]] = [((), spec)]
    while waiting:
        path, value = waiting.pop()
        if isinstance(value, list):
            waiting += [((*path, i), item) for i, item in enumerate(value)]
        if isinstance(value, dict):
            keys = frozenset(keys_at(model, path))
            yield from ((keys, key) for key in value if keys)
            waiting += [((*path, key), item) for key, item in value.items()]


def test_every_choice_and_function_is_named() -> None:
    words = set(re.findall(r"[\w-]+", " ".join(re.findall(r"`([^`\n]+)`", LANGUAGE))))
    choices = {word for kind in MODELS for word in enumerated(json_schema(kind))}

    assert choices - words == set()
    assert FUNCTIONS - words == set()


def enumerated(schema: object) -> Iterator[str]:
    """The words between which a key has the choice."""
    if isinstance(schema, dict):
        yield from (word for word in schema.get("enum", ()) if isinstance(word, str))
        for part in schema.values():
            yield from enumerated(part)
    if isinstance(schema, list):
        for part in schema:
            yield from enumerated(part)


def test_the_list_of_errors_is_that_of_the_sources() -> None:
    folders = ("spec_schema", "compiler", "verifier", "specc")
    sources = [
        path.read_text(encoding="utf-8") for f in folders for path in (ROOT / f).rglob("*.py")
    ]
    raised = {code for text in sources for code in re.findall(r'"([SV]\d\d\d)"', text)}
    listed = re.findall(r"^### ([SV]\d\d\d) ", ERRORS, re.MULTILINE)

    assert sorted(listed) == listed, "in order, each once"
    assert set(listed) == raised
    assert len(set(listed)) == len(listed)


def test_messages_in_the_list_of_errors_are_those_of_the_golden_files() -> None:
    """A code without a golden file is one of a command, whose tests hold its message."""
    files = (ROOT / "tests" / "golden").rglob("*.expected")
    printed = {line for file in files for line in file.read_text(encoding="utf-8").splitlines()}
    golden = {code for line in printed for code in SAID.findall(line)}
    quoted = [line[4:] for line in ERRORS.splitlines() if line.startswith("    ")]

    for line in quoted:
        if golden & set(SAID.findall(line)):
            assert line in printed


@pytest.mark.parametrize("name", ["python.md", "learning.md", "rules.md"])
def test_the_examples_of_a_page_print_what_they_say(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "specs").symlink_to(ROOT / "specs")
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / name).read_text(encoding="utf-8")
    names: dict[str, object] = {}

    for found in BLOCK.finditer(page):
        if found["kind"] != "python":
            continue
        exec(compile(found["text"], name, "exec"), names)  # noqa: S102  our own page
        printed = capsys.readouterr().out.splitlines()
        promised = re.findall(r"^ *print\(.*?\)  # (.*)$", found["text"], re.MULTILINE)
        assert not promised or printed == promised


def test_the_study_of_agents_prints_tables_of_the_form_of_its_page(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(agents, "ProcessPoolExecutor", ThreadPoolExecutor)
    monkeypatch.setattr(agents, "explored", lambda *_: agents.Report(0.5, 0.0, 40.0, 0.1, 9.0))
    page = (ROOT / "docs" / "agents.md").read_text(encoding="utf-8")

    printed = list(agents.table(8, 60.0, 1))

    assert form_of(printed) == form_of(page.splitlines())
    assert [line for line in printed if line.startswith("| world")] == [
        line for line in page.splitlines() if line.startswith("| world")
    ]
    assert "CPU time: 72 s for the walker, 72 s for the cart, 72 s for the deaf cart" in printed


def form_of(lines: list[str]) -> list[tuple[str, int]]:
    """Of each row of a table what it begins with, and how many bars it has."""
    return [(line.split("|")[1], line.count("|")) for line in lines if line.startswith("|")]


def test_every_error_has_an_example() -> None:
    sections = re.split(r"^### ", ERRORS, flags=re.MULTILINE)[1:]

    for section in sections:
        code = section[:4]
        assert re.search(rf"^    \S.*\[{code}\]: ", section, re.MULTILINE), (
            f"{code} shows no message"
        )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if "://" in target:
            continue
        name, _, anchor = target.partition("#")
        file = page.parent / name if name else page
        assert file.exists(), f"{page.name} links to {target}"
        if anchor:
            assert anchor in anchors(file), f"{page.name} links to {target}"


def anchors(page: Path) -> set[str]:
    """The headings of a page as links name them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-") for title in headings}
