"""Artifacts: what is written reads back, the same bytes each time, and nothing else is read."""

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.artifact import ArtifactError, from_bytes, read, to_bytes, write
from runtime.code import Code
from runtime.container import Member, join
from runtime.flow import flow_of, rates
from runtime.program import (
    Binding,
    Constant,
    ErrorBound,
    Feasibility,
    Fidelity,
    Kind,
    Program,
    Realization,
    Unit,
)
from runtime.table import Method
from tests.runtime.behaviors import (
    NOWHERE,
    formula_program,
    state,
    tabulated_van_der_pol,
    van_der_pol,
)


def complete() -> Program:
    """A program in which no part is missing."""
    program = tabulated_van_der_pol(Method.CUBIC, 9)
    grams = Unit("g", 1e-3)
    mode = replace(
        state("mode", 0.0, 1.0), kind=Kind.DISCRETE, values=("off", "über"), closure=Code("1")
    )
    field = replace(
        program.field, driven=("x", "v", "mode"), bounds=(ErrorBound(1e-7, 1e-6, 10),) * 3
    )
    return replace(
        program,
        about='quotes " and \\ and\nlines, Größe',
        states=(*program.states, mode),
        constants=(Constant("k", grams, 0.1 + 0.2, "", NOWHERE),),
        field=replace(field, formula=None),
        fidelity=Fidelity({"x": 0.05}, 2.0, {"x": (-1.0, 1.0)}, 0.6, NOWHERE),
        bindings=(
            Binding("x", "/odom.x", grams, 0.1, 1.0, -0.5, None, (), NOWHERE),
            Binding("mu", "", grams, 0.0, 1.0, 0.0, 1.5, (), NOWHERE),
            Binding(
                "button", "/joy.b", grams, 0.0, 1.0, 0.0, None, (("up", 0), ("down", 1)), NOWHERE
            ),
        ),
        judge_when=Code("button not x 0 gt and"),
        realizes=(Realization("v", "base.speed", "set-point", NOWHERE),),
        feasibility=Feasibility("plausible", "see thesis"),
    )


PROGRAMS = {"formula": van_der_pol, "tables": tabulated_van_der_pol, "complete": complete}
COMPLETE = to_bytes(complete())


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_reads_back_as_it_was(name: str) -> None:
    program = PROGRAMS[name]()
    data = to_bytes(program)
    found = from_bytes(data)

    assert to_bytes(found) == data
    for before, after in zip(program.field.tables, found.field.tables, strict=True):
        assert before.axes == after.axes
        assert before.coefficients.tobytes() == after.coefficients.tobytes()
    plain = replace(program.field, tables=())
    for part in (
        "states",
        "controls",
        "constants",
        "outputs",
        "fidelity",
        "bindings",
        "judge_when",
    ):
        assert getattr(found, part) == getattr(program, part)
    for part in ("driven", "form", "every", "terms", "bounds", "formula", "origin"):
        assert getattr(found.field, part) == getattr(plain, part)


@given(st.floats(allow_nan=False, allow_infinity=False), st.text(max_size=20))
def test_every_number_and_text_reads_back(number: float, text: str) -> None:
    try:
        text.encode()
    except UnicodeEncodeError:
        return
    constant = Constant("k", Unit("g", 1e-3), number, text, text)
    found = from_bytes(to_bytes(replace(van_der_pol(), constants=(constant,), about=text)))

    assert repr(found.constants[0]) == repr(constant)
    assert found.about == text


def test_whole_numbers_for_real_ones_are_written_as_real_ones() -> None:
    program = van_der_pol()
    whole = replace(program, states=(replace(program.states[0], low=-6), program.states[1]))

    assert to_bytes(whole) == to_bytes(program)


def test_a_zip_program_and_numpy_can_open_it() -> None:
    program = complete()
    with zipfile.ZipFile(io.BytesIO(to_bytes(program))) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["sha256", "program.json", "tables/0.npy"]
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert json.loads(archive.read("program.json"))["program"]["name"] == "behavior"
        with archive.open("tables/0.npy") as file:
            numbers = np.load(io.BytesIO(file.read()))
    np.testing.assert_array_equal(numbers, program.field.tables[0].coefficients)


def test_tables_are_mapped_from_the_file_aligned_and_read_only(tmp_path: Path) -> None:
    path = tmp_path / "behavior.specc"
    program = tabulated_van_der_pol()
    write(program, path)

    found = read(path)

    numbers = found.field.tables[0].coefficients
    assert numbers.ctypes.data % 64 == 0
    assert not numbers.flags.owndata
    assert not numbers.flags.writeable
    x = np.array([0.3, -1.2])
    expected = rates(flow_of(program), x, np.ones(1))
    assert rates(flow_of(found), x, np.ones(1)).tobytes() == expected.tobytes()
    assert path.read_bytes() == to_bytes(program)


def test_a_write_that_fails_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "behavior.specc"
    path.write_bytes(b"old")

    def refuse(*_: object) -> None:
        raise OSError("the disk is full")

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(OSError, match="full"):
        write(van_der_pol(), path)

    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == b"old"


def test_no_bit_can_be_flipped() -> None:
    rng = np.random.default_rng(0)
    frames = [*range(160), *range(len(COMPLETE) - 300, len(COMPLETE))]
    places = [8 * at + bit for at in frames for bit in (0, 7)]
    places += rng.integers(0, 8 * len(COMPLETE), 800).tolist()
    for place in places:
        altered = bytearray(COMPLETE)
        altered[place // 8] ^= 1 << (place % 8)
        with pytest.raises(ArtifactError):
            from_bytes(bytes(altered))


def test_nothing_can_be_cut_off_or_added() -> None:
    rng = np.random.default_rng(1)
    lengths = [*range(100), *range(len(COMPLETE) - 100, len(COMPLETE))]
    for length in [*lengths, *rng.integers(0, len(COMPLETE), 200).tolist()]:
        with pytest.raises(ArtifactError):
            from_bytes(COMPLETE[:length])
    for more in (b"\0", b"PK", COMPLETE):
        with pytest.raises(ArtifactError):
            from_bytes(COMPLETE + more)
        with pytest.raises(ArtifactError):
            from_bytes(more + COMPLETE)


@settings(max_examples=200)
@given(st.binary(max_size=300))
def test_foreign_bytes_are_refused(data: bytes) -> None:
    for candidate in (data, b"PK\x03\x04" + data):
        with pytest.raises(ArtifactError):
            from_bytes(candidate)


def test_an_empty_or_cut_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "behavior.specc"
    for content in (b"", COMPLETE[:-1], COMPLETE[: len(COMPLETE) // 2]):
        path.write_bytes(content)
        with pytest.raises(ArtifactError):
            read(path)


Document = dict[str, Any]


def forged(change: Callable[[Document], None], **parts: bytes) -> bytes:
    """An artifact with a right digest, made by someone who means harm."""
    with zipfile.ZipFile(io.BytesIO(COMPLETE)) as archive:
        contents = {name: archive.read(name) for name in archive.namelist()[1:]}
    document = json.loads(contents["program.json"])
    change(document)
    text = json.dumps(document, sort_keys=True, ensure_ascii=False, indent=1) + "\n"
    contents["program.json"] = text.encode()
    contents.update({name.replace("__", "/"): data for name, data in parts.items()})
    return join([Member(name, memoryview(data)) for name, data in contents.items()])


def setter(*path: str | int, to: object) -> Callable[[Document], None]:
    def change(document: Document) -> None:
        place: Any = document
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = to

    return change


def test_a_forgery_without_a_change_is_the_artifact_itself() -> None:
    assert forged(lambda _: None) == COMPLETE


TABLE = ("program", "field", "tables", 0)
FORGERIES: dict[str, tuple[Callable[[Document], None], str]] = {
    "version": (setter("format", to=4), "format 4, this version reads 3"),
    "format real": (setter("format", to=3.0), "not written by specc"),
    "operation": (setter("program", "judge_when", to="x boom"), "'boom'"),
    "two values": (setter("program", "judge_when", to="x x"), "leaves 2 values"),
    "state in coefficient": (setter("program", "field", "terms", 0, "coefficient", to="x"), "'x'"),
    "code not text": (setter("program", "judge_when", to=5), "must be a str"),
    "term's table": (setter("program", "field", "terms", 0, "table", to=1), "no table"),
    "term's table -2": (setter("program", "field", "terms", 0, "table", to=-2), "no table"),
    "term's column": (setter("program", "field", "terms", 0, "column", to=2), "column 2"),
    "term's component": (setter("program", "field", "terms", 0, "component", to=9), "no driven"),
    "shape": (setter(*TABLE, "coefficients", "shape", to=[11, 11, 3]), "tables/0.npy"),
    "huge shape": (setter(*TABLE, "coefficients", "shape", to=[10**9, 10**9, 2]), "tables/0.npy"),
    "negative shape": (setter(*TABLE, "coefficients", "shape", to=[-11, -11, 2]), "tables/0.npy"),
    "flat shape": (setter(*TABLE, "coefficients", "shape", to=[242]), "tables/0.npy"),
    "member": (setter(*TABLE, "coefficients", "member", to="../../etc/passwd"), "lacks its part"),
    "axis count": (setter(*TABLE, "axes", 0, "count", to=10), "coefficients"),
    "axis name": (setter(*TABLE, "axes", 0, "name", to="w"), "axes"),
    "axis twice": (setter(*TABLE, "axes", 0, "name", to="v"), "axes"),
    "axis empty": (setter(*TABLE, "axes", 0, "low", to=4.0), "empty"),
    "no axes": (setter(*TABLE, "axes", to=[]), "axes"),
    "method": (setter(*TABLE, "method", to="quintic"), "not one of linear, cubic"),
    "no tables": (setter("program", "field", "tables", to=[]), "no table"),
    "driven": (setter("program", "field", "driven", to=["x", "v", "x"]), "drive"),
    "kind": (setter("program", "states", 0, "kind", to="odd"), "not one of"),
    "role unhashable": (setter("program", "states", 0, "role", to=[]), "not one of"),
    "whole for real": (setter("program", "states", 0, "low", to=-4), "must be a float"),
    "real for whole": (setter(*TABLE, "axes", 0, "count", to=9.0), "must be a int"),
    "empty domain": (setter("program", "states", 0, "low", to=4.0), "domain of 'x' is empty"),
    "name twice": (setter("program", "states", 1, "name", to="x"), "two variables are named 'x'"),
    "name with path": (setter("program", "name", to="../x"), "no name"),
    "no states": (setter("program", "states", to=[]), "does not exist"),
    "null state": (setter("program", "states", 0, to=None), "must be a dict"),
    "extra key": (setter("program", "states", 0, "extra", to=1), "extra"),
    "null in the place of a text": (setter("program", "about", to=None), "must be a str"),
    "short tuple": (setter("program", "states", 0, "relates", to=["a"]), "2 entries"),
    "scale": (setter("program", "states", 0, "unit", "scale", to=0.0), "scale 0"),
    "discrete without values": (setter("program", "states", 2, "values", to=[]), "has none"),
    "fidelity": (setter("program", "fidelity", "tolerance", to={"q": 1.0}), "'q'"),
    "other document": (lambda document: document.clear(), "no program"),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forged_program_is_refused_with_the_reason(name: str) -> None:
    change, reason = FORGERIES[name]
    with pytest.raises(ArtifactError, match=reason):
        from_bytes(forged(change))


@pytest.mark.parametrize(
    "content",
    [
        b"[" * 100_000,
        b"[]",
        b'{"format":3,"program":' + b"9" * 10_000 + b"}",
        b'{"format":3,"program":NaN}',
        b"\xff\xfe",
        b"",
    ],
)
def test_a_hostile_document_is_refused(content: bytes) -> None:
    with pytest.raises(ArtifactError):
        from_bytes(forged(lambda _: None, **{"program.json": content}))


def test_hostile_tables_and_parts_are_refused() -> None:
    with zipfile.ZipFile(io.BytesIO(COMPLETE)) as archive:
        table = archive.read("tables/0.npy")
    broken = bytearray(table)
    broken[-8:] = np.float64(np.nan).tobytes()
    pickled = table.replace(b"<f8", b"|O8")
    for altered in (bytes(broken), pickled, table[:-8], table + bytes(8), b""):
        with pytest.raises(ArtifactError):
            from_bytes(forged(lambda _: None, **{"tables__0.npy": altered}))
    with pytest.raises(ArtifactError, match="not written by specc"):
        from_bytes(forged(lambda _: None, **{"tables__1.npy": table}))
    for name in ("tables__00.npy", "..__table.npy", "tables__0.npz"):
        with pytest.raises(ArtifactError, match="other parts"):
            from_bytes(forged(lambda _: None, **{name: table}))
    with pytest.raises(ArtifactError, match="other parts"):
        from_bytes(join([]))


def test_a_program_that_does_not_fit_together_is_not_written() -> None:
    program = van_der_pol()
    broken = replace(program, field=replace(program.field, formula=(Code("v"), Code("y"))))

    with pytest.raises(ArtifactError, match="formula of 'v'"):
        to_bytes(broken)
    infinite = replace(program, controls=(replace(program.controls[0], default=np.inf),))
    with pytest.raises(ArtifactError, match="cannot be written"):
        to_bytes(infinite)


def test_a_stranger_cannot_make_code_that_costs_more_than_its_length() -> None:
    wide = " ".join(["x"] * 50_000 + ["add"] * 49_999)
    program = formula_program((state("x", 0.0, 1.0),), {"x": wide})
    flow = flow_of(from_bytes(to_bytes(program)))

    # A stack of 50,000 values needs few rows, since equal values are computed once.
    assert flow.tape.rows < 100
    too_long = formula_program((state("x", 0.0, 1.0),), {"x": "x" + " neg" * 300_000})
    with pytest.raises(ArtifactError, match="300001 tokens"):
        to_bytes(too_long)
