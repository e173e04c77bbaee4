"""The light of a poster: as the run's own map has it, only finer, and the same from a recording."""

from pathlib import Path

import numpy as np
import pytest

from specc.recorded import record_run
from specc.scenarios import last_light
from specc.scenarios.pictured import pictured, scene_of, spoken_of
from specc.scenarios.replaying import replayed
from specc.scenarios.simulating import Simulation, simulate_scenario

SCENARIOS = Path(__file__).parents[2] / "specs" / "scenarios"


@pytest.fixture(scope="module")
def made() -> Simulation:
    return simulate_scenario(SCENARIOS / "first_light.yaml", duration="2 s", light_every=1.0)


def test_on_the_runs_own_cells_it_is_the_runs_own_light(
    made: Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    floor = made.run.floor
    assert floor is not None
    assert floor.times[-1] == 2.0
    monkeypatch.setattr(last_light, "CELLS", len(floor.xs))

    scene, _ = pictured(made.run, ())

    assert scene.last_glow is not None
    np.testing.assert_allclose(scene.last_glow.xs, floor.xs, atol=1e-12)
    np.testing.assert_array_equal(scene.last_glow.lux[-1], floor.lux[-1])


def test_a_recording_shows_the_same_fine_light(made: Simulation, tmp_path: Path) -> None:
    record_run(made.run, tmp_path / "run.mcap")

    ours, theirs = pictured(made.run, ())[0].last_glow, replayed(tmp_path / "run.mcap").scene

    assert ours is not None
    assert theirs.last_glow is not None
    assert ours.lux.shape == (1, 600, 800)
    np.testing.assert_allclose(theirs.last_glow.lux, ours.lux, rtol=1e-6)


def test_where_no_light_was_kept_none_is_drawn(made: Simulation) -> None:
    scene = scene_of(made.run.scenario, made.run.layout.things)

    assert scene.glow is None
    assert scene.last_glow is None


def test_things_are_spoken_of_by_requirements_and_by_eyes() -> None:
    tidy = simulate_scenario(SCENARIOS / "tidy_subsumption.yaml", duration="0.1 s").run.scenario

    assert {f"crate_{i}" for i in (1, 2, 3, 4)} <= spoken_of(tidy)
