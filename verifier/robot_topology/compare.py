"""The robot's topology beside the spec's, feature by feature.

Attractors are looked for where the robot rests, cycles in its laps: the trace itself tells. The
field refitted to the trace tells the same a second way, and all that nobody rests at: saddles and
other places that repel. What the trace does not reach is said to be not visited.

Many numbers are judged at once. Each interval is so wide that all of them together hold the truth
at the confidence of the verdict (Bonferroni), so a faithful robot is told that something differs in
about one of twenty traces, not in one of twenty numbers. About: intervals of the refit are those of
a normal distribution, and whether a feature is there is told from a finite number of draws.
"""

from typing import Final

import numpy as np

from runtime.program import Program
from verifier.fidelity.judging.departure import CONFIDENCE
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import needs_of
from verifier.report.features import ComparedFeature, Features, FeatureStanding
from verifier.report.wording import number, percent
from verifier.robot_topology.cycle_features import cycle_features
from verifier.robot_topology.declared import numbers_judged
from verifier.robot_topology.point_features import point_features
from verifier.robot_topology.refit import refitted
from verifier.robot_topology.refitted_points import RefitView
from verifier.robot_topology.resting_places import resting_places
from verifier.robot_topology.rests import allowance
from verifier.robot_topology.robot_alone import rests_of_robot_alone
from verifier.robot_topology.scene import Scene, scene_of
from verifier.topology.slices import SliceError
from verifier.topology.words import settings_words
from verifier.traces.trace import Trace

SEED: Final = 6_180
"""Of draws and resamples: the same trace gives the same features."""
DRAWS: Final = 200
MOST: Final = 0.98
"""Of the time; where the setting held for less, it is told for how much."""


def compare_features(program: Program, trace: Trace, study: Study | None) -> Features:
    """The features of `program` beside those of the robot in `trace`.

    study: of the same trace, as the verdict rests on it; without one nothing is refitted.
    """
    needs = needs_of(program, trace)
    if needs.missing or not needs.series:
        return _nothing(f"not compared: the trace lacks {', '.join(needs.missing)}")
    try:
        scene = scene_of(program, needs, study)
    except SliceError as error:
        return _nothing(f"not compared: {error}")
    rng = np.random.default_rng(SEED)
    anything = scene.portrait.fixed_points or scene.portrait.cycles
    refit = refitted(study, allowance(scene)) if study is not None and anything else None
    each = 1.0 - (1.0 - CONFIDENCE) / max(numbers_judged(scene), 1)
    view = None if refit is None else RefitView(scene, refit, refit.draws(DRAWS, rng), each)
    places = resting_places(scene, each)
    features = (
        *point_features(scene, view, places, each),
        *cycle_features(scene, view, each, rng),
        *rests_of_robot_alone(scene, places),
    )
    return Features(
        axes=tuple(axis.name for axis in scene.axes),
        units=tuple(axis.unit for axis in scene.axes),
        settings=scene.setting.values,
        features=tuple(sorted(features, key=_order)),
        notes=_notes(scene, features, is_refitted=refit is not None),
        confidence=CONFIDENCE,
    )


def _nothing(note: str) -> Features:
    return Features((), (), (), (), (note,), CONFIDENCE)


def _order(feature: ComparedFeature) -> tuple[bool, bool]:
    """Declared features first, those of the robot alone last."""
    return not feature.in_spec, not feature.is_declared


def _notes(
    scene: Scene, features: tuple[ComparedFeature, ...], *, is_refitted: bool
) -> tuple[str, ...]:
    share, values = scene.setting.share, settings_words(scene.program, scene.setting.varied)
    if not features:
        return (_nothing_there(values),)
    notes = []
    if values and share == 0.0:
        notes.append(
            f"the inputs kept changing, and the features move with them: told are those at {values}"
        )
    elif values and share < MOST:
        notes.append(
            f"the inputs varied, and the features move with them: told are those at {values},"
            f" which held for {percent(share)} of the time"
        )
    if not is_refitted:
        notes.append(f"the field was not refitted: {_why_not(scene)}")
    if any(feature.standing is FeatureStanding.EXCEEDED for feature in features):
        notes.append(
            "a feature never changes the verdict: that is about the next"
            f" {number(scene.horizon)} s, a feature is about where the robot ends in the long run"
        )
    return tuple(notes)


def _nothing_there(values: str) -> str:
    where = f" at {values}" if values else ""
    return (
        f"nothing to compare: the spec has no fixed point and no cycle{where}, and the robot was"
        " not seen to rest"
    )


def _why_not(scene: Scene) -> str:
    if scene.program.field.is_map:
        return "the behavior is a step map; what was seen in the trace itself is told"
    if scene.program.field.mode:
        return "the behavior has modes; what was seen in the trace itself is told"
    return "too few windows of one horizon were judged"
