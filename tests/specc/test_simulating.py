"""`specc simulate` of a scenario as a user runs it: statuses, what is printed, files."""

import dataclasses
import json
from pathlib import Path

import pytest

import specc
from runtime.recording.scenario_run import recorded_run
from runtime.run import run
from runtime.world import chipmunk
from runtime.world.chipmunk import OtherPhysicsError
from spec_schema.diagnostics import SpecError
from specc.cli import main
from specc.scenarios.simulating import required_of, simulate_scenario
from tests.runtime.first_light import FILE, first_light, short_run

SPECS = FILE.parents[1]


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    """A copy of the library's scenario that may be changed."""
    text = FILE.read_text(encoding="utf-8").replace("../", f"{SPECS}/")
    path = tmp_path / "first_light.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def require(scenario: Path, *sentences: str) -> str:
    """Put other requirements into the scenario; its path."""
    head, _, _ = scenario.read_text(encoding="utf-8").partition("require:")
    told = "\n".join(f"  - {sentence}" for sentence in sentences)
    scenario.write_text(f"{head}require:\n{told}\n", encoding="utf-8")
    return str(scenario)


@pytest.mark.parametrize(
    ("sentences", "status"),
    [
        (("always r.x > 0 m",), 0),
        (("always r.x > 0 m", "always r.x > 5 m", "eventually within 60 s r.x > 5 m"), 1),
        (("always r.x > 0 m", "eventually within 60 s r.x > 5 m"), 4),
    ],
)
def test_the_status_says_whether_the_run_is_as_required(
    scenario: Path, sentences: tuple[str, ...], status: int
) -> None:
    assert main(["simulate", require(scenario, *sentences), "-d", "1"]) == status


def test_numbers_for_programs(scenario: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = require(scenario, "always r.clearance > 1 mm")

    assert main(["simulate", given, "-d", "1 s", "--seed", "5", "--format", "json"]) in {0, 1}
    found = json.loads(capsys.readouterr().out)

    assert (found["seed"], found["duration"]) == (5, 1.0)
    assert found["state_hash"] == run(first_light(1.0, seed=5)).digest.hex()
    assert found["requirements"][0]["unit"] == "mm"
    assert found["requirements"][0]["witness"]["time"] <= 1.0
    assert found["real_time_factor"] > 0.0
    assert found["robots"]["r"]["acting"].keys() == {"avoid", "seek"}


def test_text_tells_the_requirement_in_the_units_of_its_author(
    scenario: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["simulate", require(scenario, "always r.x > 50 mm"), "-d", "0.5"])

    told = capsys.readouterr().out
    assert "first_light: 0.5 s simulated, seed 7" in told
    assert "satisfied by 4" in told
    assert " mm at " in told
    assert "worst penetration" in told


def test_a_recording_is_written_and_is_that_of_the_run(scenario: Path, tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"

    given = require(scenario, "always r.x > 0 m")
    assert main(["simulate", given, "-d", "1", "-o", str(path)]) == 0

    again = tmp_path / "again.mcap"
    assert main(["simulate", given, "-d", "1", "-o", str(again)]) == 0
    assert path.read_bytes() == again.read_bytes()
    assert len(path.read_bytes()) > len(recorded_run(run(first_light(0.1))))


def test_what_does_not_fit_is_refused_before_anything_runs(
    scenario: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for options in (["-o", "run.csv"], ["--start", "x=1"], ["-d", "-3"]):
        assert main(["simulate", str(scenario), *options]) == 2
    told = capsys.readouterr().err
    assert "V345" in told
    assert "for a behavior alone" in told
    assert "V342" in told


def test_a_physics_that_is_not_known_is_told(
    scenario: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def otherwise() -> None:
        raise OtherPhysicsError("pymunk 7.9.0 keeps bodies in memory otherwise")

    monkeypatch.setattr(chipmunk, "make_sure", otherwise)
    with pytest.raises(SpecError) as caught:
        simulate_scenario(scenario)

    assert [each.code for each in caught.value.diagnostics] == ["V384"]


def test_no_room_is_told_with_its_place(scenario: Path, tmp_path: Path) -> None:
    world = (SPECS / "worlds" / "office.yaml").read_text(encoding="utf-8")
    (tmp_path / "full.yaml").write_text(world.replace("count: 4", "count: 90"), encoding="utf-8")
    text = scenario.read_text(encoding="utf-8")
    scenario.write_text(text.replace(f"{SPECS}/worlds/office.yaml", "full.yaml"), encoding="utf-8")

    with pytest.raises(SpecError) as caught:
        simulate_scenario(scenario)

    assert [each.code for each in caught.value.diagnostics] == ["V381"]
    assert "full.yaml" in caught.value.diagnostics[0].place


def test_code_of_ones_own_runs_only_where_that_is_allowed(scenario: Path, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text(
        "specc: 1\nkind: arbiter\nname: own\nreads: {ahead: {unit: m, domain: [0, 2]}}\n"
        'choices: [flee, go]\nby: {module: "deciding:choose"}\n',
        encoding="utf-8",
    )
    (tmp_path / "deciding.py").write_text(
        "def choose(reads, time):\n    return {'flee': 0.0, 'go': 1.0}\n", encoding="utf-8"
    )
    wiring = (SPECS / "architectures" / "find_light.yaml").read_text(encoding="utf-8")
    wiring = wiring.replace("../arbiters/safe_first.yaml", "own.yaml").replace("../", f"{SPECS}/")
    wiring = wiring.replace("exclusive: choose", "priority: [avoid, seek]")
    (tmp_path / "own_light.yaml").write_text(wiring, encoding="utf-8")
    text = scenario.read_text(encoding="utf-8")
    mine = text.replace(f"{SPECS}/architectures/find_light.yaml", "own_light.yaml")
    scenario.write_text(mine, encoding="utf-8")

    with pytest.raises(SpecError) as caught:
        simulate_scenario(scenario, duration=1.0)

    assert [each.code for each in caught.value.diagnostics] == ["V382"]
    assert "--allow-code" in caught.value.diagnostics[0].message
    allowed = simulate_scenario(scenario, duration=1.0, allow_code=True)
    before, *decided = allowed.run.signals["r.choose.go"].values.tolist()
    assert before == 0.0, "no decision is in effect at the beginning"
    assert set(decided) == {1.0}


def test_requirements_of_a_run_are_judged_from_python() -> None:
    made = short_run()

    results = required_of(made)

    assert [each.text for each in results] == [each.text for each in made.scenario.requirements]
    assert specc.simulate_scenario is simulate_scenario


def test_a_mistake_in_the_scenario_is_a_bad_spec(scenario: Path) -> None:
    assert main(["simulate", require(scenario, "always r.nothing > 0")]) == 2


def test_a_run_that_takes_too_much_memory_is_refused_before_it_begins() -> None:
    with pytest.raises(SpecError) as caught:
        simulate_scenario(first_light(), duration="1e9 s")

    assert [each.code for each in caught.value.diagnostics] == ["V383"]
    assert "of which 4 GB are allowed" in caught.value.diagnostics[0].message


def test_the_light_on_an_endless_floor_has_wider_cells() -> None:
    made = first_light(0.1)
    far = ((0.0, 0.0), (1e5, 0.0), (1e5, 1e5), (0.0, 1e5))
    vast = dataclasses.replace(made, world=dataclasses.replace(made.world, arena=far))

    floor = simulate_scenario(vast, light_every=1.0).run.floor
    assert floor is not None
    assert floor.lux.shape == (1, 400, 400)
    assert floor.xs[-1] == pytest.approx(1e5 - 125.0)
