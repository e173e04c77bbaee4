"""Tables of sketches: coordinates cover the whole domain, and narrow gaps are named."""

from itertools import product
from pathlib import Path

import numpy as np

from compiler.check import Checked, check_behavior
from compiler.sketch.fill import filled
from compiler.sketch.gaps import narrowest_gap
from compiler.sketch.lower import plan_sketch
from runtime.machine import evaluate
from spec_schema.behavior import BehaviorSpec
from spec_schema.load import Loaded, load, load_source
from spec_schema.source import Source

CLOSE = """specc: 1
kind: behavior
name: drawn
state:
  x: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: room}}
  y: {unit: m, domain: [-2, 2], role: both, relates: {agent: base, environment: room}}
field:
  sketch:
    over: [x, y]
    orbits:
      - {name: big, through: [[1.5, 0], [0, 1.5], [-1.5, 0], [0, -1.5]], period: 4}
      - {name: near, through: [[1.4, 0], [0, 1.4], [-1.4, 0], [0, -1.4]], period: 4, attracts: no}
""".replace("attracts: no", "attracts: false")


def checked(loaded: Loaded) -> Checked:
    assert isinstance(loaded.spec, BehaviorSpec)
    return check_behavior(loaded, loaded.spec)


def test_coordinates_cover_their_values_over_all_states_and_controls() -> None:
    made = checked(load(Path("specs/patrol_sketch.yaml")))
    assert made.design is not None
    coordinates = plan_sketch(filled(made.design, 0), made.declared, "").coordinates
    assert coordinates
    variables = (*made.declared.states, *made.declared.controls)
    low, high = (np.array([getattr(v, end) for v in variables]) for end in ("low", "high"))
    corners = np.array(list(product((0.0, 1.0), repeat=len(variables))))
    inside = np.random.default_rng(5).random((20_000, len(variables)))
    names = (*(v.name for v in variables), *(c.name for c in made.declared.constants))
    constants = np.array([c.value for c in made.declared.constants])
    places = low + np.concatenate([corners, inside]) * (high - low)
    register = np.hstack([places, np.broadcast_to(constants, (len(places), len(constants)))])

    for coordinate in coordinates:
        values = evaluate([coordinate.code], names, register)
        assert coordinate.low <= values.min()
        assert values.max() <= coordinate.high


def test_the_two_orbits_that_come_closest_are_named_with_their_gap() -> None:
    design = checked(load_source(Source("s.yaml", CLOSE))).design

    assert design is not None
    assert "'near' and 'big' come closest: 0.1 m apart" in narrowest_gap(design)
