"""What to write where nothing says by which spec a log is judged: it works as it is told."""

from pathlib import Path
from textwrap import dedent

import pytest

from spec_schema.diagnostics import SpecError
from specc.verifying.spec_finding import find_spec

SPECS = Path(__file__).parents[2] / "specs"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("specs").mkdir()
    for name in ("pendulum.yaml", "van_der_pol.yaml"):
        (Path("specs") / name).write_text((SPECS / name).read_text())
    Path("runs").mkdir()
    Path("runs/van_der_pol_1.csv").write_text("t,x,v\n0,1,0\n")


def advice(trace: Path) -> str:
    """The help where no spec is found; its code stands first."""
    with pytest.raises(SpecError) as caught:
        find_spec(trace, None, lambda path: path)
    (found,) = caught.value.diagnostics
    return f"{found.code}\n{found.help}"


def test_the_project_file_that_is_advised_works_as_written() -> None:
    trace = Path("runs/van_der_pol_1.csv")
    told = advice(trace)
    assert told.startswith("V331")
    Path("specc.yaml").write_text(told.partition("this folder:\n")[2])
    assert find_spec(trace, None, lambda path: path).program == Path("specs/van_der_pol.yaml")


@pytest.mark.parametrize("claims", ["", 'traces:\n  "old/*.csv": specs/pendulum.yaml\n'])
def test_the_line_that_is_advised_for_a_project_file_works_as_written(claims: str) -> None:
    trace, head = Path("runs/van_der_pol_1.csv"), "specc: 1\nkind: project\nname: mine\n"
    head += "specs: [specs/pendulum.yaml, specs/van_der_pol.yaml]\n"
    Path("specc.yaml").write_text(head + claims)
    told = advice(trace)
    assert told.startswith("V334")
    lines = dedent(told.partition(":\n")[2])
    Path("specc.yaml").write_text(head + claims + (f"  {lines}\n" if claims else lines))
    assert find_spec(trace, None, lambda path: path).program == Path("specs/van_der_pol.yaml")
