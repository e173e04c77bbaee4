"""Who has its way in a run, as pictures tell it."""

import numpy as np
import pytest

from compiler.architecture.compile import wire_architecture
from runtime.recording.tracks import ActingTrack
from specc.scenarios.pictured import who_acts


@pytest.mark.parametrize("first", [("wander", "patrol"), ("patrol", "wander")])
@pytest.mark.parametrize("way", ["subsumption", "hierarchy", "dynamics"])
def test_names_keep_the_order_of_nodes_whoever_acts_first(way: str, first: tuple[str, str]) -> None:
    architecture = wire_architecture(f"specs/architectures/patrol_{way}.yaml").architecture
    nodes = [node.name for node in architecture.nodes]
    acts = np.array([[node == name for node in nodes] for name in first])
    track = ActingTrack(np.array([0.0, 1.0]), acts, acts.astype(float))

    names, acting = who_acts(architecture, track, np.array([0.5, 1.5]))

    assert names == ("patrol", "wander")
    assert tuple(names[place] for place in acting) == first
