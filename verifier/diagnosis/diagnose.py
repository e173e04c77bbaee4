"""The diagnosis: which numbers of the spec moved, and what would explain a departure.

First every explanation is tried beside the spec as it is: numbers of the spec, gains and offsets,
and what changes the structure. Those that predict held-out windows better are taken in, one by
one. Then all numbers that the trace can tell are fitted together, and the verdict's own figures
are worked out again.
"""

from typing import Final

from runtime.program import Fidelity, Program, Unit
from verifier.diagnosis.aftermath import altered_study
from verifier.diagnosis.altered import Effect
from verifier.diagnosis.candidates.bounds import effects_of_bounds
from verifier.diagnosis.candidates.clocks import effects_on_clocks
from verifier.diagnosis.candidates.inputs import effects_on_inputs
from verifier.diagnosis.candidates.rates import effects_on_rates
from verifier.diagnosis.candidates.regions import effects_on_regions
from verifier.diagnosis.candidates.terms import effects_of_terms
from verifier.diagnosis.conclusion import PARTLY, concluded, nothing_to_tell
from verifier.diagnosis.guards import with_guards
from verifier.diagnosis.leftover import Bench
from verifier.diagnosis.parameters import effect_of, parameters_of
from verifier.diagnosis.profiled import setting_of
from verifier.diagnosis.refitting import refitted
from verifier.diagnosis.reporting import candidates_of, departures, reading_of, regions, told_of
from verifier.diagnosis.rereading import Reread, reread
from verifier.diagnosis.rivals import still_alike
from verifier.diagnosis.scene import Scene, scene_of
from verifier.diagnosis.selection import CLEAR, Selection, select
from verifier.fidelity.judging.evidence import evidence_of
from verifier.fidelity.judging.judgement import results_of
from verifier.fidelity.shooting.study import Study
from verifier.fidelity.stretches.needs import needs_of
from verifier.report.diagnosis import Diagnosis, Told
from verifier.report.report import Report, Verdict
from verifier.traces.trace import Trace

AS_GOOD: Final = 0.95
"""A reading has no numbers to fit, and so is preferred to those that gain little more."""
FEWEST: Final = 4
"""With fewer windows nothing can be held out."""


def diagnose(program: Program, trace: Trace, study: Study | None, report: Report) -> Diagnosis:
    """Why the robot in `trace` departs from `program`, as far as the trace tells.

    study, report: as `verifier.fidelity.verify.judged` gives them; without a study, only other
    ways of reading the trace are tried.
    """
    assert program.fidelity is not None, "what was judged has a fidelity"
    found = _of_states(program, program.fidelity, trace, study, report)
    if report.verdict is Verdict.PASS or study is None:
        return found
    return with_guards(found, program, needs_of(program, trace), program.fidelity)


def _of_states(
    program: Program, fidelity: Fidelity, trace: Trace, study: Study | None, report: Report
) -> Diagnosis:
    """Why states end elsewhere than predicted."""
    scene = None if study is None else scene_of(program, study)
    if study is None or scene is None or scene.windows < FEWEST:
        windows = 0 if scene is None else scene.windows
        return _of_unjudged(program, fidelity, trace, report, windows)
    selection = _selected(scene, report, fidelity)
    if report.verdict is Verdict.PASS and selection.share(scene) < PARTLY:
        selection = selection.without()
    best = _better_reading(program, fidelity, trace, scene, selection, report)
    if best is None:
        return _told(program, fidelity, scene, study, selection, report, None)
    other = _selected(best.scene, report, fidelity)
    return _told(program, fidelity, best.scene, best.study, other, report, best)


def _selected(scene: Scene, report: Report, fidelity: Fidelity) -> Selection:
    """What explains the departure, of all that is tried."""
    effects = effects_of(scene, report.verdict)
    return still_alike(scene, select(scene, effects, fidelity.tolerance))


def effects_of(scene: Scene, verdict: Verdict) -> tuple[Effect, ...]:
    """All that is tried, what is preferred among equals first.

    Further terms and parts of the region are looked at only where something is amiss: there are
    many.
    """
    is_passed = verdict is Verdict.PASS
    parameters = parameters_of(scene.program, scene.needs)
    return (
        *(effect_of(each) for each in parameters),
        *effects_on_inputs(scene),
        *effects_on_clocks(scene),
        *effects_on_rates(scene),
        *effects_of_bounds(scene),
        *(() if is_passed else (*effects_of_terms(scene), *effects_on_regions(scene))),
    )


def _of_unjudged(
    program: Program, fidelity: Fidelity, trace: Trace, report: Report, windows: int
) -> Diagnosis:
    """Where too little could be compared as the trace was read: read otherwise, if that helps."""
    found = reread(program, fidelity, trace, None, None)
    if not found or found[0].gain < CLEAR or found[0].scene.windows < FEWEST:
        return nothing_to_tell(windows)
    best = found[0]
    selection = _selected(best.scene, report, fidelity)
    return _told(program, fidelity, best.scene, best.study, selection, report, best)


def _better_reading(
    program: Program,
    fidelity: Fidelity,
    trace: Trace,
    scene: Scene,
    selection: Selection,
    report: Report,
) -> Reread | None:
    """A reading of the trace that explains more than all that was taken."""
    if report.verdict is Verdict.PASS:
        return None
    found = reread(program, fidelity, trace, scene, selection)
    if found and found[0].gain > CLEAR and found[0].lead > -(1.0 - AS_GOOD) * found[0].gain:
        return found[0]
    return None


def _told(
    program: Program,
    fidelity: Fidelity,
    scene: Scene,
    study: Study,
    selection: Selection,
    report: Report,
    best: Reread | None,
) -> Diagnosis:
    parameters = parameters_of(program, scene.needs)
    numbers, joint = refitted(scene, selection.final, parameters, report.confidence)
    setting = setting_of(scene, joint.effects, joint.values)
    altered = altered_study(scene, study, setting)
    results = results_of(fidelity, evidence_of(program, altered, report.trace.source))
    units: dict[str, Unit] = report.units
    after = departures(results, report)
    differs = regions(results, units)
    found = candidates_of(
        Bench(scene, study, fidelity),
        selection,
        report.confidence,
        with_others=report.verdict is not Verdict.PASS or bool(selection.taken),
    )
    share = selection.share(scene) if best is None else 1.0
    if best is not None:
        was_judged = bool(report.variables)
        found = (reading_of(program, best, selection, fidelity, was_judged=was_judged), *found)
    moved = told_of(numbers)
    told, sentences = concluded(selection, share, found, moved, after, differs, report)
    if told is Told.NO_DIFFERENCE:
        found = ()
    return Diagnosis(told, sentences, moved, after, found, differs)
