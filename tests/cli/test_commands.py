"""The commands as a user runs them: exit statuses, standard output, files."""

import json
from pathlib import Path

import pytest

from specc.cli import main

ROOT = Path(__file__).parents[2]
SPECS = ROOT / "specs"
VDP = str(SPECS / "van_der_pol.yaml")


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def result(capsys: pytest.CaptureFixture[str]) -> object:
    """What standard output holds, as JSON."""
    return json.loads(capsys.readouterr().out)


def test_check_is_content_with_the_library(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(SPECS)]) == 0
    assert "without mistakes" in capsys.readouterr().err


def test_check_lists_mistakes_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    bad = ROOT / "tests" / "golden" / "bad" / "dimension_sum.yaml"

    assert main(["check", str(bad), "--format", "json"]) == 2
    [found] = result(capsys)
    assert found.keys() == {
        "code", "severity", "message", "file", "line", "column", "end_line", "end_column",
        "path", "help",
    }  # fmt: skip
    assert (found["code"], found["line"], found["column"]) == ("S141", 14, 16)
    assert found["path"] == "$.field.formula.x"


def test_check_annotates_for_github(capsys: pytest.CaptureFixture[str]) -> None:
    bad = ROOT / "tests" / "golden" / "bad" / "dimension_sum.yaml"

    assert main(["check", str(bad), "--format", "github"]) == 2
    assert capsys.readouterr().out.startswith("::error file=")


def test_compile_writes_the_same_bytes_twice(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compile", VDP, "-o", "a.specc", "--format", "json"]) == 0
    first = result(capsys)
    assert main(["compile", VDP, "-o", "b.specc"]) == 0

    assert Path("a.specc").read_bytes() == Path("b.specc").read_bytes()
    assert first["artifact"] == "a.specc"
    for table in first["tables"]:
        assert table["error_bound"] <= table["tolerance"]
        assert len(table["shape"]) == len(table["axes"])


def test_a_damaged_artifact_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    main(["compile", VDP, "-o", "whole.specc"])
    data = Path("whole.specc").read_bytes()
    Path("cut.specc").write_bytes(data[: len(data) // 2])
    Path("flipped.specc").write_bytes(data[:3000] + bytes([data[3000] ^ 1]) + data[3001:])

    for name in ("cut.specc", "flipped.specc"):
        assert main(["portrait", name, "--format", "json"]) == 2
    assert "V335" in capsys.readouterr().out


def test_portrait_gives_its_fixed_points_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["portrait", VDP, "--set", "mu=0.5", "--format", "json"]) == 0
    [point] = result(capsys)["fixed_points"]

    assert point["kind"] == "unstable focus"
    assert point["at"] == pytest.approx({"x": 0.0, "v": 0.0}, abs=1e-9)
    for pair in point["eigenvalues"]:
        assert (pair[0], abs(pair[1])) == pytest.approx((0.25, (1.0 - 0.25**2) ** 0.5), abs=1e-6)


@pytest.mark.parametrize("suffix", ["svg", "png", "pdf", "json"])
def test_portrait_draws_in_every_format(suffix: str) -> None:
    assert main(["portrait", str(SPECS / "keep_left.yaml"), "-o", f"p.{suffix}"]) == 0
    assert Path(f"p.{suffix}").stat().st_size > 1000


def test_portrait_sweeps_a_control_and_cuts_a_state_into_slices(
    capsys: pytest.CaptureFixture[str],
) -> None:
    spec = str(SPECS / "wall_follow.yaml")
    with_sweep = ["portrait", spec, "--axes", "distance", "--sweep", "speed=0.2:0.4:3"]
    assert main([*with_sweep, "-f", "json", "-o", "sweep.svg"]) == 0
    swept = result(capsys)
    assert [p["held"]["speed"] for p in swept["portraits"]] == pytest.approx([0.2, 0.3, 0.4])
    assert main(["portrait", spec, "--slices", "heading=2", "-f", "json"]) == 0
    assert [p["axes"] for p in result(capsys)["portraits"]] == [["distance"]] * 2
    assert Path("sweep.svg").stat().st_size > 1000


def test_portrait_holds_values_by_at_and_draws_in_the_style_asked_for() -> None:
    spec = str(SPECS / "keep_left.yaml")
    for style in ("journal", "dark"):
        assert main(["portrait", spec, "--style", style, "-o", f"{style}.svg"]) == 0
    assert "#10151c" in Path("dark.svg").read_text()
    assert "#10151c" not in Path("journal.svg").read_text()


@pytest.mark.parametrize("name", ["van_der_pol", "phototaxis", "line_steps", "corridor"])
def test_a_recording_verifies_against_the_spec_that_it_carries(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (SPECS / f"{name}.yaml").read_text()
    if "fidelity:" not in text:
        driven = {"line_steps": "offset: 1 cm", "corridor": "offset: 1 cm"}[name]
        text += f"fidelity: {{tolerance: {{{driven}}}, horizon: 1 s}}\n"
    Path("spec.yaml").write_text(text)
    assert main(["simulate", "spec.yaml", "-d", "12", "--every", "0.1", "-o", "run.mcap"]) == 0
    capsys.readouterr()

    assert main(["verify", "run.mcap", "--quick", "--format", "json"]) == 0
    verdict = result(capsys)
    assert verdict["verdict"] == "pass"
    for variable in verdict["variables"].values():
        for horizon in variable["horizons"]:
            assert horizon.keys() >= {"horizon", "rmse", "tolerance", "within"}
    assert {"coverage", "losses", "spec", "trace"} <= verdict.keys()


def test_a_csv_whose_columns_bear_the_names_needs_no_trace_block() -> None:
    assert main(["simulate", VDP, "--start", "x=1", "-d", "40", "-o", "run.csv"]) == 0

    assert main(["verify", "run.csv", "--spec", VDP, "--quick"]) == 0


@pytest.mark.parametrize("target", ["/dev/null", "."])
def test_only_ordinary_files_are_written(target: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("trace.csv").write_text("t,x\n0,0\n")

    assert main(["init", "n", "-o", target]) == 2
    assert Path("/dev/null").is_char_device()
    assert "exists already" in capsys.readouterr().err


def test_a_spec_is_never_overwritten_by_its_artifact(capsys: pytest.CaptureFixture[str]) -> None:
    Path("v.yaml").write_text(Path(VDP).read_text())

    assert main(["compile", "v.yaml", "-o", "v.yaml"]) == 2
    assert "V345" in capsys.readouterr().err
    assert Path("v.yaml").read_text() == Path(VDP).read_text()


def test_a_link_is_followed_and_a_device_left_alone(tmp_path: Path) -> None:
    (tmp_path / "link.specc").symlink_to(tmp_path / "real.specc")
    (tmp_path / "device.specc").symlink_to("/dev/null")

    assert main(["compile", VDP, "-o", "link.specc"]) == 0
    assert main(["compile", VDP, "-o", "device.specc"]) == 2
    assert (tmp_path / "real.specc").is_file()
    assert (tmp_path / "link.specc").is_symlink()
    assert Path("/dev/null").is_char_device()


def test_simulate_says_where_a_run_left_the_domain(capsys: pytest.CaptureFixture[str]) -> None:
    run = ["simulate", VDP, "--start", "x=4", "--start", "v=8", "--format", "json"]

    assert main(run) == 0
    record = result(capsys)
    assert record["ending"] == "left domain"
    assert "x" in record["detail"]


def test_a_run_that_takes_too_many_steps_says_what_to_do_and_is_no_success(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["simulate", VDP, "--start", "x=1", "-d", "1e9", "-o", "run.csv"]) == 1

    err = capsys.readouterr().err
    assert "incomplete: 1,000,000 steps reach" in err
    assert "--start x=" in err
    assert Path("run.csv").is_file()


def test_a_portrait_names_units_of_what_is_held_and_gives_round_numbers_round(
    capsys: pytest.CaptureFixture[str],
) -> None:
    text = Path(VDP).read_text(encoding="utf-8")
    Path("turning.yaml").write_text(
        text.replace(
            "control:\n", "control:\n  tilt: {unit: deg, domain: [-60, 60], default: -60}\n"
        ).replace("mu*(1 - x**2)*v", "mu*(1 - x**2)*v + 0*tilt"),
        encoding="utf-8",
    )

    assert main(["portrait", "turning.yaml", "-o", "p.json"]) == 0
    assert "tilt = -60 deg" in capsys.readouterr().out
    assert json.loads(Path("p.json").read_text(encoding="utf-8"))["held"]["tilt"] == -60.0


def test_verify_writes_reports(capsys: pytest.CaptureFixture[str]) -> None:
    trace = str(SPECS / "recordings" / "scitos" / "wall_following.csv")
    run = ["verify", trace, "--spec", str(SPECS / "keep_left.yaml")]
    wanted = ["r.html", "r.json", "r.txt", "r.junit.xml", "r.sarif"]

    assert main([*run, *(part for name in wanted for part in ("-o", name))]) == 0
    assert "PASS" in capsys.readouterr().out
    assert json.loads(Path("r.json").read_text())["verdict"] == "pass"
    assert "http" not in Path("r.html").read_text().replace("http://www.w3.org", "")


def test_verify_runs_nobodys_code(capsys: pytest.CaptureFixture[str]) -> None:
    trace = str(SPECS / "recordings" / "scitos" / "wall_following.csv")

    assert main(["verify", trace, "--spec", str(SPECS / "circling.yaml")]) == 2
    assert "V336" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["simulate", VDP, "--start", "y=1"], "V341"),
        (["simulate", VDP, "--start", "x=40"], "V342"),
        (["simulate", VDP, "--start", "x=1 m"], "V342"),
        (["simulate", VDP, "-d", "-3"], "V342"),
        (["simulate", str(SPECS / "line_steps.yaml"), "--every", "0.03"], "V342"),
        (["simulate", VDP, "-o", "run.txt"], "V345"),
        (["portrait", VDP, "--axes", "x,w"], "V346"),
        (["portrait", VDP, "-o", "p.bmp"], "V345"),
        (["portrait", VDP, "--sweep", "nu=1:2:3"], "no control or state is named 'nu'"),
        (["portrait", VDP, "--sweep", "mu=1:2"], "write mu=LOW:HIGH:COUNT"),
        (["portrait", VDP, "--sweep", "mu=1:9:3"], "outside the domain"),
        (["portrait", VDP, "--sweep", "mu=99"], "1 to 24 values"),
        (["portrait", VDP, "--sweep", "mu=1:2:0"], "1 to 24 values (got 0)"),
        (["portrait", VDP, "--axes", "x,x"], "'x' stands twice among the axes"),
        (["portrait", VDP, "--axes", "x,v,x,v"], "at most 3 axes"),
        (["portrait", VDP, "--axes", ""], "write names of states, such as x,v"),
        (["portrait", VDP, "--styl", "dark"], "did you mean '--style'?"),
        (["portrait", VDP, "--styl", "dark"], "see `specc portrait --help`"),
        (["simulate", VDP, "--set", "x=1"], "it is a state: write --start x=..."),
        (["simulate", VDP, "--start", "mu=1"], "it is a control: write --set mu=..."),
        (["portrait", VDP, "--sweep", "mu=2", "--slices", "v=2"], "take one of"),
        (["portrait", VDP, "--against", "nu"], "no control is named 'nu'"),
        (["portrait", VDP, "--against", "mu=1"], "write mu=LOW:HIGH"),
        (["verify", "nowhere.mcap", "--spec", VDP], "V301"),
        (["verify", str(ROOT / "README.md")], "V334"),
        (["init", "--template", "van_der_poll"], "V343"),
        (["check", "nowhere.yaml"], "S015"),
        (["simulate", VDP, "--start", "x"], "write x=VALUE"),
        (["frobnicate"], "frobnicate"),
    ],
)
def test_bad_usage_is_told_and_exits_with_2(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["verify", VDP], "this is a spec, not a log"),
        (["verify", "empty.csv"], "the file is empty"),
        (["verify", "."], "the folder is empty"),
        (["verify", "run.csv", "--spec", "run.csv"], "this is a log, not a spec"),
        (["check", "run.csv"], "this is a log, not a spec"),
        (["portrait", "run.csv"], "this is a log, not a spec"),
        (["verify"], "TRACE is missing"),
    ],
)
def test_what_was_taken_for_something_else_is_called_what_it_is(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    if "." not in arguments:
        Path("empty.csv").touch()
        Path("run.csv").write_text("t,x\n0,0\n")

    assert main(arguments) == 2
    assert told in capsys.readouterr().err


def test_init_writes_a_spec_that_checks(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", "rhythm"]) == 0
    assert main(["check", "rhythm.yaml"]) == 0
    assert "name: rhythm" in Path("rhythm.yaml").read_text()
    capsys.readouterr()
    assert main(["init", "rhythm"]) == 2, "a file that exists is not overwritten"


def test_the_templates_are_listed_under_either_name(capsys: pytest.CaptureFixture[str]) -> None:
    listed = []
    for option in ("--list", "--templates"):
        assert main(["init", option]) == 0
        listed.append(capsys.readouterr().out)

    assert listed[0] == listed[1]
    assert "wall_follow" in listed[0]


def test_init_brings_the_module_that_a_template_calls() -> None:
    assert main(["init", "orbit", "--template", "circling"]) == 0
    assert main(["compile", "orbit.yaml"]) == 0


def test_init_from_a_log_lists_it_and_writes_a_spec_that_verifies(
    capsys: pytest.CaptureFixture[str],
) -> None:
    log = str(SPECS / "recordings" / "husky" / "husky.mcap")

    assert main(["init", "drive", "--from", log]) == 0
    listing = capsys.readouterr().out
    assert "/imu/data" in listing
    assert "nav_msgs/msg/Odometry" in listing
    assert main(["check", "drive.yaml"]) == 0
    assert main(["verify", log, "--spec", "drive.yaml", "--quick"]) in {0, 1, 4}


def test_schema_prints_json_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "behavior"]) == 0
    assert result(capsys)["$schema"].endswith("2020-12/schema")
