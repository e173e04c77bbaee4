"""Books: the same program again, numbers for readers without specc, pages that lead somewhere."""

import json
import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import specc
from runtime import architecture_artifact
from runtime.container import ArtifactError
from runtime.flow import flow_of, rates
from spec_schema.diagnostics import SpecError
from specc import loading
from specc.book import folder, manifest
from specc.book.contents import gathered
from specc.book.export import export_book
from specc.book.gridded import LARGEST, interpolated
from specc.book.loading import compile_book
from specc.book.sources import Sources, sources_of
from specc.book.tables import sheets_of
from specc.book.views import views_at, views_of
from specc.cli import main
from specc.origins import files_named, renamed
from tests.specc.book_scenes import ARCHITECTURE, FILES, SCENARIO, laid_down


def quiet(_what: str, _done: int, _of: int) -> None:
    pass


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return laid_down(tmp_path_factory.mktemp("book"))


@pytest.fixture(scope="module")
def book(home: Path) -> Path:
    export_book(home / SCENARIO, home / "made", quiet, with_pdf=False)
    return home / "made"


@pytest.fixture
def copy(book: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(book, tmp_path / "book"))


def contents_of(path: Path) -> dict[str, bytes]:
    """All files but what Python leaves behind where a module of it was imported."""
    found = (p for p in path.rglob("*") if p.is_file() and "__pycache__" not in p.parts)
    return {p.relative_to(path).as_posix(): p.read_bytes() for p in found}


def code_of(error: SpecError) -> set[str]:
    return {each.code for each in error.diagnostics}


def test_the_specs_of_a_book_make_its_artifact_again_byte_for_byte(book: Path) -> None:
    assert compile_book(book) == (book / "scenario.specc").read_bytes()


def test_they_do_so_by_the_plain_command_within_the_book(
    book: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(book)

    assert main(["compile", f"specs/{SCENARIO}", "-o", str(tmp_path / "again.specc")]) == 0
    assert (tmp_path / "again.specc").read_bytes() == Path("scenario.specc").read_bytes()


def test_specc_compile_takes_a_book_and_says_that_it_is_the_same(
    book: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "again.specc"

    assert main(["compile", str(book), "-o", str(out), "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out)["same_as_the_book"] is True
    assert out.read_bytes() == (book / "scenario.specc").read_bytes()


def test_a_book_of_the_architecture_holds_the_part_of_it_alone(home: Path, book: Path) -> None:
    made = export_book(home / ARCHITECTURE, home / "part", quiet, with_pdf=False)
    loaded = specc.load_book(home / "part")
    again = architecture_artifact.to_bytes(*loaded.architectures[0])

    assert (home / "part" / "architecture.specc").read_bytes() == again
    assert made.architectures[0].modules == specc.load_book(book).book.modules
    assert not (home / "part" / "specs" / "room.yaml").exists()


def test_the_same_specs_give_the_same_book_wherever_they_lie(
    book: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = laid_down(tmp_path / "else" / "where")
    monkeypatch.chdir(elsewhere / "robots")
    export_book(f"../{SCENARIO}", "../../again", quiet, with_pdf=False)

    assert contents_of(tmp_path / "else" / "again") == contents_of(book)


def test_copies_of_specs_are_their_own_text(book: Path) -> None:
    assert {n: (book / "specs" / n).read_text("utf-8") for n in FILES} == FILES


def test_a_reader_with_numpy_alone_gets_the_rates_of_the_program(book: Path, home: Path) -> None:
    program = f"""
import sys, json
sys.path.insert(0, {str(book / "data")!r})
from read_table import value
own = {{"specc", "runtime", "compiler", "verifier"}} & {{n.partition(".")[0] for n in sys.modules}}
at = [-3.1, -1.0, 0.2, 2.5, 9.0]
found = [value({str(book / "data" / "module.index.npz")!r}, "rate bearing", {{"bearing": x}}, s)
         for s in ("default", "gain=2") for x in at]
print(json.dumps([sorted(own), [None if x != x else x for x in found]]))
"""
    command = [sys.executable, "-I", "-c", program]
    made = subprocess.run(command, capture_output=True, text=True, check=True, cwd="/")
    own, found = json.loads(made.stdout)
    flow = flow_of(loading.load_program(home / "face.yaml"))
    x = np.array([[-3.1], [-1.0], [0.2], [2.5]])
    exact = [rates(flow, x, np.full((4, 1), gain))[:, 0] for gain in (1.5, 2.0)]

    assert own == []
    assert [found[4], found[9]] == [None, None]  # beyond the domain
    assert np.allclose(found[:4], exact[0], atol=0.006)
    assert np.allclose(found[5:9], exact[1], atol=0.008)


def test_tables_are_off_by_what_the_book_says_also_at_other_places(book: Path) -> None:
    module = next(m for m in specc.load_book(book).book.modules if m.node == "index")
    data = np.load(book / "data" / "module.index.npz")
    chance = np.random.default_rng(1)

    for table in module.tables:
        key = f"{table.setting}/{table.quantity}"
        gain = 2.0 if "=" in table.setting else 1.5
        x = chance.uniform(-np.pi, np.pi, (500, 1))
        found = interpolated((data[f"{key}/bearing"],), data[key], x)
        exact = {
            "rate bearing": -gain * np.sin(x[:, 0]),
            "output turn": gain * np.sin(x[:, 0]),
            "output error": np.degrees(np.abs(x[:, 0])),
        }[table.quantity]
        assert np.abs(found - exact).max() <= 1.1 * table.error + 1e-12
        assert table.error <= 0.004 * table.size


def test_a_field_of_modes_has_a_table_for_each_over_what_matters_in_it() -> None:
    program = loading.load_program(Path(__file__).parents[2] / "specs" / "avoid.yaml")
    sheets = {each.quantity: each.axes for each in sheets_of(program, "default", {}, ())}

    assert sheets["rate heading in to_left"] == ("left",)
    assert sheets["rate heading in to_right"] == ("right",)


def test_a_wired_control_is_an_axis_and_a_map_has_next_states() -> None:
    specs = Path(__file__).parents[2] / "specs"
    wall = loading.load_program(specs / "wall_follow.yaml")
    found = {s.quantity: s for s in sheets_of(wall, "default", {"speed": 0.4}, {"wanted"})}

    assert found["rate heading"].axes == ("distance", "heading", "wanted")
    steps = sheets_of(loading.load_program(specs / "line_steps.yaml"), "default", {}, ())
    assert all(not s.quantity.startswith("rate") for s in steps)


def test_settings_are_the_values_that_choices_set(book: Path) -> None:
    module = next(m for m in specc.load_book(book).book.modules if m.node == "index")

    assert [(s.name, s.by, s.controls) for s in module.settings] == [
        ("default", (), {"gain": 1.5}),
        ("gain=2", ("choose.eager",), {"gain": 2.0}),
    ]


def test_the_csv_says_the_same_as_the_arrays(book: Path) -> None:
    data = np.load(book / "data" / "module.index.npz")
    rows = (book / "data" / "module.index.csv").read_text("utf-8").splitlines()
    head = rows[0].split(",")
    wanted = [row.split(",") for row in rows[1:] if row.startswith("gain=2,output error,deg,")]
    column = {name: [float(row[k]) for row in wanted] for k, name in enumerate(head) if k > 2}

    assert np.allclose(column["value"], data["gain=2/output error"], atol=1e-6)
    assert np.allclose(column["bearing"], data["gain=2/output error/bearing"])


def test_the_manifest_reads_back_and_nothing_else_is_read(book: Path) -> None:
    data = (book / "book.json").read_bytes()

    assert manifest.to_bytes(manifest.from_bytes(data)) == data
    with pytest.raises(ArtifactError):
        manifest.from_bytes(data.replace(b'"kind": "scenario"', b'"kinds": "scenario"'))


def test_the_manifest_names_every_file_with_its_digest(book: Path) -> None:
    named = {file.path for file in specc.load_book(book).book.files}

    assert named == contents_of(book).keys() - {"book.json"}


def test_the_run_of_the_scenario_tells_what_was_met(book: Path) -> None:
    required = specc.load_book(book).book.requirements

    assert [each.outcome for each in required] == ["satisfied"]
    assert "satisfied" in (book / "pages" / "scenario.html").read_text("utf-8")


class Links(HTMLParser):
    """What a page leads to, and the places in it."""

    def __init__(self) -> None:
        super().__init__()
        self.to: list[str] = []
        self.ids: set[str] = set()

    def handle_starttag(self, _tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in {"href", "src", "srcset"} and value:
                self.to.append(value)
            if name == "id" and value:
                self.ids.add(value)


def test_every_link_of_every_page_leads_to_a_file_of_the_book(book: Path) -> None:
    pages = [book / "index.html", *(book / "pages").iterdir()]
    assert {p.name for p in pages} >= {"architecture.html", "building.html", "choose.html"}
    for page in pages:
        links = Links()
        links.feed(page.read_text("utf-8"))
        assert len(links.to) > 5
        for target in links.to:
            file, _, place = target.partition("#")
            assert (page.parent / file).is_file() if file else place in links.ids, (page, target)


def test_pages_load_nothing_from_elsewhere(book: Path) -> None:
    for page in (book / "index.html", *(book / "pages").iterdir()):
        assert not re.search(r'(?:src|href)="(?:https?:)?//', page.read_text("utf-8"))


def test_a_node_called_as_a_page_of_the_book_gets_another_page(book: Path) -> None:
    assert (book / "pages" / "module.index.html").is_file()


@pytest.mark.parametrize(
    ("file", "told"), [("specs/face.yaml", "was changed"), ("data/read_table.py", "is missing")]
)
def test_a_book_that_is_not_as_it_was_written_is_not_loaded(
    copy: Path, file: str, told: str
) -> None:
    if told == "is missing":
        (copy / file).unlink()
    else:
        (copy / file).write_text("specc: 1\n")

    with pytest.raises(SpecError, match=re.escape(f"{file} {told}")) as refused:
        specc.load_book(copy)
    assert code_of(refused.value) == {"V433"}


def test_what_is_no_book_is_not_loaded(tmp_path: Path) -> None:
    with pytest.raises(SpecError) as refused:
        specc.load_book(tmp_path)
    assert code_of(refused.value) == {"V432"}

    (tmp_path / "book.json").write_text("{}")
    with pytest.raises(SpecError) as refused:
        specc.load_book(tmp_path)
    assert code_of(refused.value) == {"V432"}


def test_a_book_takes_the_place_of_a_book(copy: Path) -> None:
    files = contents_of(copy)
    folder.write_folder(copy, {**files, "more.txt": b"more"})

    assert contents_of(copy) == {**files, "more.txt": b"more"}
    assert [p.name for p in copy.parent.iterdir()] == ["book"]


def test_using_the_reader_of_tables_makes_nothing_ones_own(copy: Path) -> None:
    (copy / "data" / "__pycache__").mkdir(exist_ok=True)
    (copy / "data" / "__pycache__" / "read_table.cpython-311.pyc").write_bytes(b"")

    folder.refuse_early(copy)


@pytest.mark.parametrize("own", ["notes.txt", "specs/face.yaml"])
def test_no_book_takes_the_place_of_ones_own_work(copy: Path, own: str) -> None:
    (copy / own).write_text("mine")

    with pytest.raises(SpecError, match=re.escape(own)) as refused:
        folder.refuse_early(copy)
    assert code_of(refused.value) == {"V435"}


def test_a_folder_of_something_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")

    with pytest.raises(SpecError) as refused:
        folder.write_folder(tmp_path, {"book.json": b"{}"})
    assert code_of(refused.value) == {"V434"}
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.txt"]


def test_a_file_in_the_place_of_the_folder_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "book").write_text("mine")

    with pytest.raises(SpecError) as refused:
        folder.refuse_early(tmp_path / "book")
    assert code_of(refused.value) == {"V434"}


def test_where_writing_fails_the_old_book_stands_whole(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = contents_of(copy)
    written = Path.write_bytes

    def fails(path: Path, data: bytes) -> int:
        if path.name == "index.html":
            raise OSError(28, "No space left on device")
        return written(path, data)

    monkeypatch.setattr(Path, "write_bytes", fails)
    with pytest.raises(SpecError, match="no space left") as refused:
        folder.write_folder(copy, {**files, "more.txt": b"more"})
    assert code_of(refused.value) == {"V347"}
    assert contents_of(copy) == files
    assert [p.name for p in copy.parent.iterdir()] == ["book"]


def test_specs_that_name_a_file_by_where_it_lies_on_this_machine_are_refused(
    tmp_path: Path,
) -> None:
    home = laid_down(tmp_path)
    spec = home / ARCHITECTURE
    spec.write_text(spec.read_text().replace("../face.yaml", os.fspath(home / "face.yaml")))

    with pytest.raises(SpecError, match="other machines") as refused:
        export_book(spec, tmp_path / "book", quiet, with_pdf=False)
    assert code_of(refused.value) == {"V431"}
    assert not (tmp_path / "book").exists()


def test_a_behavior_alone_makes_no_book(
    home: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", str(home / "face.yaml"), "-o", str(tmp_path / "b"), "--no-pdf"]) == 2
    assert "V430" in capsys.readouterr().err


def test_a_wrong_spec_is_told_and_nothing_is_written(tmp_path: Path) -> None:
    home = laid_down(tmp_path)
    (home / "face.yaml").write_text(FILES["face.yaml"].replace("role: both", "rolle: both"))

    with pytest.raises(SpecError) as refused:
        export_book(home / ARCHITECTURE, tmp_path / "book", quiet, with_pdf=False)
    assert "S102" in code_of(refused.value)
    assert not (tmp_path / "book").exists()


def test_the_command_says_what_it_made_and_what_it_doubts(
    home: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = [str(home / SCENARIO), "-o", str(tmp_path / "b"), "--no-pdf", "--format", "json"]

    assert main(["export", *arguments]) == 0
    said = capsys.readouterr()
    made = json.loads(said.out)
    assert [module["node"] for module in made["modules"]] == ["index", "choose"]
    assert made["files"] == len(contents_of(tmp_path / "b"))
    assert "S363" in said.err  # the behavior is hypothetical


GRID = "field:\n  grid: {over: [bearing], between: linear, file: rates.csv}\n"
CODE = "field:\n  module: {call: spin:field}\n"
SPIN = "def field(bearing, gain):\n    return {'bearing': -gain * half(np.sin(bearing))}\n"


@pytest.mark.parametrize(
    ("field", "beside", "text"),
    [
        (GRID, "rates.csv", "bearing,bearing\n-3.2,0.1\n0,0\n3.2,-0.1\n"),
        (CODE, "spin.py", "def field(bearing, gain):\n    return {'bearing': -gain * bearing}\n"),
    ],
)
def test_what_lies_beside_a_spec_comes_along_and_makes_the_same_program(
    tmp_path: Path, field: str, beside: str, text: str
) -> None:
    home = laid_down(tmp_path / "home")
    face = FILES["face.yaml"].replace("kind: periodic", "kind: continuous")
    face = face.replace("domain: [-pi, pi]", "domain: [-3.2, 3.2]")
    own = "field:\n  formula:\n    bearing: -gain * sin(bearing)\n"
    (home / "face.yaml").write_text(face.replace(own, field))
    (home / beside).write_text(text)

    first = compiled(home / ARCHITECTURE)
    for path, name in first[1].names.items():
        (tmp_path / "book" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, tmp_path / "book" / name)
    again = compiled(tmp_path / "book" / "specs" / ARCHITECTURE)

    assert f"specs/{beside}" in first[1].names.values()
    assert again[0] == first[0]


def test_what_code_imports_from_beside_it_comes_along(tmp_path: Path) -> None:
    home = laid_down(tmp_path)
    own = "field:\n  formula:\n    bearing: -gain * sin(bearing)\n"
    (home / "face.yaml").write_text(FILES["face.yaml"].replace(own, CODE))
    (home / "spin.py").write_text("import numpy as np\nfrom halves import half\n" + SPIN)
    (home / "halves.py").write_text("def half(value):\n    return 0.5 * value\n")
    (home / "other.py").write_text("nobody = 'imports this'\n")

    files = compiled(home / ARCHITECTURE)[1].names.values()
    assert {"specs/spin.py", "specs/halves.py"} <= set(files)
    assert "specs/other.py" not in files


def test_two_architectures_of_one_name_make_no_book(tmp_path: Path) -> None:
    home = laid_down(tmp_path)
    text = (home / ARCHITECTURE).read_text()
    (home / "robots" / "again.yaml").write_text(text.replace("period: 50 ms", "period: 100 ms"))
    robots = "  r: {architecture: robots/turner.yaml, at: [1 m, 1 m, 90 deg]}\n"
    other = "  s: {architecture: robots/again.yaml, at: [2 m, 1 m, 90 deg]}\n"
    (home / SCENARIO).write_text(FILES[SCENARIO].replace(robots, robots + other))
    with pytest.raises(SpecError, match="V437"):
        gathered(home / SCENARIO, quiet)


def compiled(spec: Path) -> tuple[bytes, Sources]:
    """The artifact that a book of it has, and its sources."""
    made = loading.compile_architecture_spec(spec, quiet, allow_code=True)
    sources = sources_of(spec, made.architecture, made.body)
    parts = renamed((made.architecture, made.body), sources.name_of)
    return architecture_artifact.to_bytes(*parts), sources


def test_origins_are_renamed_and_nothing_else(home: Path) -> None:
    made = loading.compile_architecture_spec(home / ARCHITECTURE, quiet)
    pair = (made.architecture, made.body)
    there_and_back = renamed(renamed(pair, lambda name: f"x/{name}"), lambda name: name[2:])

    assert set(files_named(renamed(pair, lambda _: "one.yaml"))) == {"one.yaml"}
    assert architecture_artifact.to_bytes(*there_and_back) == architecture_artifact.to_bytes(*pair)


def test_a_portrait_of_a_mode_is_over_what_moves_by_itself_in_it() -> None:
    specs = Path(__file__).parents[2] / "specs"
    program = loading.load_program(specs / "patrol_posts.yaml")
    axes = {
        view.title.partition(";")[0]: [axis.name for axis in view.portrait.axes]
        for view in views_of(program, {"speed": 0.25})
    }

    assert axes == {
        "going is west": ["west_bearing", "west_distance"],
        "going is east": ["east_bearing", "east_distance"],
    }


def test_controls_that_do_not_change_the_field_make_no_portraits_more() -> None:
    wander = loading.load_program(Path(__file__).parents[2] / "specs" / "wander.yaml")
    settings = [manifest.Setting(f"{v}", (), {"speed": v, "wildness": 0.4}) for v in (0.1, 0.3)]

    assert len(views_at(wander, settings)) == 1


def test_tables_of_fields_with_jumps_and_kinks_come_to_an_end() -> None:
    specs = Path(__file__).parents[2] / "specs"
    feel = loading.load_program(specs / "feel_wall.yaml")

    for sheet in sheets_of(feel, "default", {}, ()):
        assert sheet.grid.values.size <= LARGEST
        assert np.isfinite(sheet.grid.values).all()
