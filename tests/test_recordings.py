"""Real robots, and one made by an independent integrator, judged by the specs of the library."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from mcap.writer import Writer
from scipy.integrate import solve_ivp

import specc
from runtime.artifact import to_bytes
from runtime.recording.behavior import self_bound
from specc.cli import main

ROOT = Path(__file__).parents[1]
SPECS = ROOT / "specs"
HUSKY = SPECS / "recordings" / "husky"
DRIVE = SPECS / "husky_drive.yaml"


@pytest.fixture(scope="module")
def husky() -> specc.Report:
    return specc.verify(HUSKY / "husky.mcap", DRIVE, depth="verdict").report


def test_the_husky_drives_as_its_spec_says(husky: specc.Report) -> None:
    assert husky.verdict is specc.Verdict.PASS


@pytest.mark.parametrize("factor", [0.9, 1.1])
def test_a_turn_scale_ten_percent_off_fails_and_names_the_heading(
    tmp_path: Path, factor: float
) -> None:
    text = (SPECS / "husky_drive.yaml").read_text()
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(text.replace("value: 0.944", f"value: {0.944 * factor:.4f}"))

    report = specc.verify(HUSKY / "husky.mcap", wrong, depth="verdict").report

    assert report.verdict is specc.Verdict.FAIL
    assert "heading" in report.reasons[0]


def test_the_same_drive_as_a_ros_1_bag_gives_the_same_figures(husky: specc.Report) -> None:
    bag = specc.verify(HUSKY / "husky.bag", DRIVE, depth="verdict").report

    for one, other in zip(husky.variables, bag.variables, strict=True):
        assert other.declared.rmse == pytest.approx(one.declared.rmse, rel=1e-9)
        assert other.declared.departure == pytest.approx(one.declared.departure, rel=1e-9)


def test_the_scitos_keeps_its_wall_while_it_moves_forward() -> None:
    trace = SPECS / "recordings" / "scitos" / "wall_following.csv"

    report = specc.verify(trace, SPECS / "keep_left.yaml", depth="verdict").report

    assert report.verdict is specc.Verdict.PASS
    assert any("judge_when" in exclusion.cause for exclusion in report.exclusions)


Robot = Callable[[float], Path]
SIGMA = 0.01
"""Measurement noise of the made robot, a fifth of the tolerance of x."""


@pytest.fixture
def robot(tmp_path: Path) -> Robot:
    """A Van der Pol robot's log: scipy's DOP853 on the formula, noise, the spec attached."""
    program = specc.load_program(SPECS / "van_der_pol.yaml")

    def record(mu: float) -> Path:
        times = np.arange(0.0, 80.0, 0.05)
        solved = solve_ivp(
            lambda _t, z: [z[1], mu * (1.0 - z[0] ** 2) * z[1] - z[0]],
            (0.0, 80.0),
            [0.5, 0.0],
            method="DOP853",
            t_eval=times,
            rtol=1e-10,
            atol=1e-12,
        )
        measured = solved.y + np.random.default_rng(5).normal(0.0, SIGMA, solved.y.shape)
        path = tmp_path / f"robot_{mu}.mcap"
        with path.open("wb") as file:
            writer = Writer(file)
            writer.start()
            schema = writer.register_schema("state", "jsonschema", b'{"type": "object"}')
            state = writer.register_channel("/van_der_pol/state", "json", schema)
            control = writer.register_channel("/van_der_pol/control", "json", schema)
            for time, (x, v) in zip(times, measured.T, strict=True):
                stamp = int(time * 1e9)
                for channel, message in ((state, {"x": x, "v": v}), (control, {"mu": 1.0})):
                    writer.add_message(channel, stamp, json.dumps(message).encode(), stamp)
            name = "van_der_pol.specc"
            media_type = "application/vnd.specc"
            data = to_bytes(self_bound(program))
            writer.add_attachment(0, 0, name, media_type, data)
            writer.finish()
        return path

    return record


def test_a_faithful_robot_passes_with_nothing_but_its_file_named(
    robot: Robot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    verification = specc.verify(robot(1.0).name, depth="verdict")

    assert verification.report.verdict is specc.Verdict.PASS
    assert "attached" in verification.found.how
    noise = {result.name: result.noise.sigma for result in verification.report.variables}
    assert noise["x"] == pytest.approx(SIGMA, rel=0.15)


def test_a_robot_with_one_parameter_a_fifth_off_fails(
    robot: Robot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    assert specc.verify(robot(1.2).name, depth="verdict").report.verdict is specc.Verdict.FAIL


def test_an_attached_spec_that_is_not_the_projects_is_refused(
    robot: Robot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    text = (SPECS / "van_der_pol.yaml").read_text()
    (tmp_path / "van_der_pol.yaml").write_text(text.replace("default: 1", "default: 2"))
    (tmp_path / "specc.yaml").write_text(
        "specc: 1\nkind: project\nname: lab\nspecs: [van_der_pol.yaml]\n"
    )

    status = main(["verify", "--quick", robot(1.0).name])

    assert status == 2
    assert "V333" in capsys.readouterr().err
