"""The recording of a scenario judged: requirements and nodes, by what it carries or by --spec."""

import json
import shutil
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import specc
from runtime.recording.scenario_run import recorded_run
from runtime.run import Run
from spec_schema.diagnostics import SpecError
from specc.cli import main
from specc.loading import compile_scenario_spec
from specc.scenarios.simulating import Simulation, simulate_scenario
from specc.texts.runs import runs_table
from specc.verifying.recording import RunVerification
from specc.verifying.runs import verifications, verify_together
from verifier.report.report import Verdict

SPECS = Path(__file__).parents[2] / "specs"
SCENARIO = SPECS / "scenarios" / "first_light.yaml"
LAYERS = SPECS / "scenarios" / "light_subsumption.yaml"
DURATION = 14.0


def simulated(
    scenario: Path,
    requirements: tuple[str, ...] = (),
    duration: float = DURATION,
    seed: int | None = None,
) -> Simulation:
    """The beginning of a run: the robot turns to the lamp and gets there."""
    text = scenario.read_text()
    if requirements:
        listed = "\n".join(f"  - {each}" for each in requirements)
        text = text[: text.index("require:")] + f"require:\n{listed}\n"
    other = scenario.with_name("other.yaml")
    other.write_text(text)
    compiled = compile_scenario_spec(other).scenario
    other.unlink()
    chosen = compiled.seed if seed is None else seed
    return simulate_scenario(replace(compiled, duration=duration, seed=chosen))


def kept(run: Run, path: Path) -> Path:
    """The run, recorded."""
    path.write_bytes(recorded_run(run))
    return path


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of all specs, to be changed."""
    folder = tmp_path_factory.mktemp("library") / "specs"
    ignored = shutil.ignore_patterns("recordings", "*.md")
    shutil.copytree(SPECS, folder, ignore=ignored)
    return folder


REQUIRED = (
    "always r.clearance > 5 mm",
    "eventually within 10 s r.lamp.light > 8 lx",
    "always (r.x > 0 m and crate.y > 0 m)",
    "always abs(r.heading) < 229 deg",
    "always r.seek.turn < 2 rad/s",
    "eventually r.choose.choice == 'go'",
    "r.contacts < 1 until r.speed > 0.05 m/s",
)


@pytest.fixture(scope="module")
def made(library: Path) -> Simulation:
    """A faithful run, with requirements of every sort of quantity."""
    return simulated(library / "scenarios" / "first_light.yaml", REQUIRED)


@pytest.fixture(scope="module")
def recording(made: Simulation, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its recording."""
    return kept(made.run, tmp_path_factory.mktemp("recordings") / "run.mcap")


@pytest.fixture(scope="module")
def sabotaged(library: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A faithful robot, and one that turns to the light half as eagerly as its spec says."""
    folder = tmp_path_factory.mktemp("sabotaged")
    behavior = library / "phototaxis.yaml"
    own = behavior.read_text()
    weak = own.replace("is: gain * sin", "is: 0.5 * gain * sin")
    assert weak != own
    scenario = library / "scenarios" / LAYERS.name
    faithful = kept(simulated(scenario, duration=50.0).run, folder / "faithful.mcap")
    behavior.write_text(weak)
    run = simulated(scenario, duration=50.0).run
    behavior.write_text(own)
    return faithful, kept(run, folder / "weak.mcap")


def test_a_recording_says_of_requirements_what_the_run_itself_says_to_the_last_bit(
    made: Simulation, recording: Path
) -> None:
    found = specc.verify_run(recording, depth="verdict").requirements

    assert found is not None
    assert found.examination.requirements == made.requirements
    assert len(made.requirements) == len(REQUIRED)


def test_exactly_the_node_that_was_sabotaged_fails(sabotaged: tuple[Path, Path]) -> None:
    faithful, weak = (specc.verify_run(path, LAYERS, depth="verdict") for path in sabotaged)

    assert [each.part for each in weak.nodes] == ["r.avoid", "r.seek", "r.wander", "r.choose"]
    failed = {each.part for each in weak.nodes if each.report.verdict is Verdict.FAIL}
    assert failed == {"r.seek"}
    assert weak.verdict is Verdict.FAIL
    assert faithful.node("r.seek").report.verdict is Verdict.PASS
    assert all(each.report.verdict is not Verdict.FAIL for each in faithful.nodes)


def test_a_behavior_that_never_acted_is_open_and_says_why(recording: Path) -> None:
    avoid = specc.verify_run(recording, depth="verdict").node("r.avoid").report

    assert avoid.verdict is Verdict.INCONCLUSIVE
    assert avoid.reasons == ("it never acted in 13.9 s",)
    assert avoid.exclusions[0].cause == "it was inhibited"


@pytest.mark.parametrize(
    ("spec", "nodes", "requires"),
    [
        ("scenarios/first_light.yaml", ["r.avoid", "r.seek", "r.choose"], True),
        ("architectures/find_light.yaml", ["r.avoid", "r.seek", "r.choose"], False),
        ("seek_light.yaml", ["r.seek"], False),
        ("arbiters/safe_first.yaml", ["r.choose"], False),
    ],
)
def test_a_spec_that_is_named_judges_what_it_is_about(
    recording: Path,
    spec: str,
    nodes: list[str],
    requires: bool,  # noqa: FBT001  of a table
) -> None:
    found = specc.verify_run(recording, SPECS / spec, depth="verdict")

    assert [each.part for each in found.nodes] == nodes
    assert (found.requirements is not None) == requires


def test_a_compiled_architecture_judges_as_the_attached_one(
    recording: Path, tmp_path: Path
) -> None:
    path = tmp_path / "find_light.specc"
    assert main(["compile", str(SPECS / "architectures/find_light.yaml"), "-o", str(path)]) == 0

    found = specc.verify_run(recording, path, depth="verdict")

    assert [each.report.verdict for each in found.nodes] == [
        each.report.verdict for each in specc.verify_run(recording, depth="verdict").nodes
    ]


def test_a_scenario_about_another_robot_is_refused_with_those_that_there_are(
    recording: Path, library: Path
) -> None:
    scenario = library / "scenarios" / "renamed.yaml"
    text = SCENARIO.read_text().replace("  r:", "  q:")
    scenario.write_text(text.replace(" r.", " q.").replace("(if r.", "(if q."))

    with pytest.raises(SpecError) as error:
        specc.verify_run(recording, scenario)
    (told,) = error.value.diagnostics
    assert told.code == "V392"
    assert "robot 'q', which is not in this recording" in told.message
    assert told.help == "robots in it: r"


def test_a_requirement_about_what_was_not_recorded_is_told_with_what_was(
    recording: Path, library: Path
) -> None:
    body = library / "bodies" / "courier.yaml"
    own = body.read_text()
    body.write_text(own.replace("  lamp:", "  eye: {senses: light}\n  lamp:"))
    scenario = library / "scenarios" / "eye.yaml"
    scenario.write_text(SCENARIO.read_text().replace("r.lamp.light", "r.eye.light"))

    try:
        with pytest.raises(SpecError) as error:
            specc.verify_run(recording, scenario)
    finally:
        body.write_text(own)
    (told,) = error.value.diagnostics
    assert told.code == "V394"
    assert "'r.eye.light', which is not in this recording" in told.message
    assert "r.lamp.light" in (told.help or "")


def test_a_behavior_that_no_node_runs_is_refused_with_those_that_run(recording: Path) -> None:
    with pytest.raises(SpecError) as error:
        specc.verify_run(recording, SPECS / "patrol.yaml")

    assert error.value.diagnostics[0].code == "V392"
    assert "back_off, safe_first, seek_light" in (error.value.diagnostics[0].help or "")


def test_verify_sends_the_recording_of_a_scenario_to_verify_run(recording: Path) -> None:
    with pytest.raises(SpecError) as error:
        specc.verify(recording)
    assert error.value.diagnostics[0].code == "V393"
    assert error.value.diagnostics[0].help == "use specc.verify_run"

    husky = SPECS / "recordings" / "husky" / "husky.mcap"
    with pytest.raises(SpecError) as other:
        specc.verify_run(husky)
    assert other.value.diagnostics[0].code == "V393"


def test_every_form_of_report_has_requirements_and_nodes(
    sabotaged: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    weak = sabotaged[1]
    outputs = [tmp_path / f"r.{kind}" for kind in ("html", "json", "txt", "junit.xml", "sarif")]
    options = [part for path in outputs for part in ("-o", str(path))]
    status = main(["verify", str(weak), "--spec", str(LAYERS), "--quick", *options])

    assert status == 1
    printed = capsys.readouterr().out
    assert printed.splitlines()[-1].startswith("FAIL  requirements and 4 nodes of 1")
    for path in outputs:
        text = path.read_text()
        assert "r.seek" in text, path
        assert "r.clearance" in text or path.suffix == ".sarif", path  # what holds is silent there
    record = json.loads(outputs[1].read_text())
    assert [each["part"] for each in record["runs"]] == [
        "requirements",
        "r.avoid",
        "r.seek",
        "r.wander",
        "r.choose",
    ]
    assert record["runs"][0]["requirements"][0]["outcome"] == "satisfied"
    suites = ET.fromstring(outputs[3].read_text())  # noqa: S314  our own
    failing = {suite.attrib["name"]: suite.attrib["failures"] for suite in suites}
    assert failing[f"{weak}: r.seek"] != "0"
    assert sum(int(count) for name, count in failing.items() if "r.seek" not in name) == 0
    rules = {each["ruleId"] for each in json.loads(outputs[4].read_text())["runs"][0]["results"]}
    assert "tolerance-exceeded" in rules


def test_no_advice_on_a_recorded_node_speaks_of_logs(sabotaged: tuple[Path, Path]) -> None:
    (seek,) = specc.verify_run(sabotaged[1], SPECS / "phototaxis.yaml").nodes

    told = " ".join((*seek.report.advice, *seek.report.reasons))
    assert seek.examination.diagnosis is not None
    assert "specc fit" not in told
    assert "`trace:`" not in told
    assert "judge_when" not in told


@pytest.fixture(scope="module")
def both(
    recording: Path, library: Path, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, Path]:
    """Two recordings of one scenario, with other seeds."""
    other = simulated(library / "scenarios" / "first_light.yaml", REQUIRED, 12.0, seed=5)
    return recording, kept(other.run, tmp_path_factory.mktemp("second") / "second.mcap")


def test_several_recordings_of_a_scenario_have_one_row_for_each_requirement_and_node(
    both: tuple[Path, Path],
) -> None:
    runs = verify_together(both, depth="verdict")
    lines = runs_table(runs).splitlines()

    for text in REQUIRED:
        (row,) = [line for line in lines if line.startswith(text)]
        assert " in 2 of 2  " in row
        results = {
            each.report.trace.source.rpartition(": ")[0]: result
            for each in verifications(runs.outcomes)
            for result in each.examination.requirements
            if result.text == text
        }
        worst = min(results, key=lambda source: results[source].robustness)
        assert f"{worst}: {results[worst].detail}" in " ".join(" ".join(lines).split())
    nodes = [line.split()[0] for line in lines if line.startswith("r.") and "  " in line]
    assert [name for name in nodes if name in {"r.avoid", "r.seek", "r.choose"}] == [
        "r.avoid",
        "r.seek",
        "r.choose",
    ]
    assert not any("r.choose, INCONCLUSIVE" in line for line in lines)
    assert "requirements and 3 nodes in 2 recordings" in lines[-1]


def test_the_nodes_of_several_runs_are_judged_together(both: tuple[Path, Path]) -> None:
    runs = verify_together(both, depth="verdict")

    pooled = {pool.members[0].part: pool.report.verdict for pool in runs.pools}
    assert pooled["r.seek"] is Verdict.PASS
    windows = [pool.report.starts.size for pool in runs.pools if pool.members[0].part == "r.seek"]
    alone = [specc.verify_run(each, depth="verdict").node("r.seek") for each in both]
    assert windows == [sum(each.report.starts.size for each in alone)]


def test_a_torn_recording_tells_its_losses_at_every_node(recording: Path, tmp_path: Path) -> None:
    torn = tmp_path / "torn.mcap"
    data = bytearray(recording.read_bytes())
    middle = data.index(b"/r/seek/state") + 100_000
    data[middle : middle + 400] = bytes(400)
    torn.write_bytes(data)

    found = specc.verify_run(torn, depth="verdict")
    assert all(each.report.losses for each in found.nodes)

    with pytest.raises(SpecError) as error:
        specc.verify_run(torn, strict=True)
    assert error.value.diagnostics[0].code == "V313"


@pytest.fixture(scope="module")
def avoiding(library: Path) -> Simulation:
    """A run in which it has to avoid something, and the lamp is hidden for a while."""
    return simulated(library / "scenarios" / "first_light.yaml", duration=30.0, seed=9)


def test_a_state_that_is_only_reckoned_is_judged_by_how_the_body_moved(
    avoiding: Simulation, tmp_path: Path
) -> None:
    run = avoiding.run
    own = specc.verify_run(kept(run, tmp_path / "own.mcap"), depth="verdict")
    poses = run.world.poses.copy()
    poses[:, -1, 2] *= 0.5
    slow = replace(run, world=replace(run.world, poses=poses))
    turned = specc.verify_run(kept(slow, tmp_path / "slow.mcap"), depth="verdict")

    def departure(found: RunVerification) -> float:
        results = found.node("r.avoid").report.variables
        return next(each.declared.departure for each in results if each.name == "heading")

    # It spins by 1.2 rad/s, which is told, and half of which was measured: 0.3 rad in 0.5 s.
    assert departure(own) < 0.01
    assert departure(turned) == pytest.approx(0.3, abs=0.03)


def test_what_went_on_before_and_what_was_not_seen_is_not_a_behaviors_doing(
    avoiding: Simulation, tmp_path: Path
) -> None:
    run = avoiding.run
    seek = specc.verify_run(kept(run, tmp_path / "run.mcap"), depth="verdict").node("r.seek")

    quantities = run.signals
    seen, turn = quantities["r.beacon.seen"], quantities["r.seek.turn"]
    for start in seek.report.starts:
        inside = (seen.times > start) & (seen.times < start + 1.0)
        assert np.all(seen.values[inside] == 1.0), start
    # From the first judged instant on, the body turns as this node asks, 0.1 s before or so.
    real = quantities["r.turn"]
    asked = np.interp(seek.report.starts - 0.1, turn.times, turn.values)
    got = np.interp(seek.report.starts, real.times, real.values)
    assert np.abs(asked - got).max() < 0.2
    causes = {each.cause for each in seek.report.exclusions}
    assert "the body still did what it was told before" in causes
    assert "bearing: beacon was not seen (the last reading stands)" in causes


@pytest.mark.parametrize("name", ["first_light.scenario.json", "r.specc"])
def test_a_damaged_attachment_is_told_by_its_name(
    recording: Path, tmp_path: Path, name: str
) -> None:
    data = bytearray(recording.read_bytes())
    place = data.index(name.encode()) if name != "r.specc" else data.index(b"\x07\0\0\0r.specc")
    data[place + 200] ^= 0x55
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)

    with pytest.raises(SpecError) as error:
        specc.verify_run(damaged)
    (found,) = error.value.diagnostics
    assert found.code == "V332"
    assert found.message.startswith(f"the attached {name} can't")
