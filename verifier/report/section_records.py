"""The sections of an examination as JSON values. Quantities stand in the unit that is named."""

import math

from runtime.program import Unit
from verifier.report.diagnosis import Candidate, DepartureAfter, Diagnosis, FittedNumber, Refitted
from verifier.report.features import ComparedFeature, Estimate, FeatureNumber, Features
from verifier.report.findings import Finding
from verifier.report.limits import Caught, Limits
from verifier.report.report import Interval
from verifier.report.scores import Scores, VariableScores
from verifier.report.switching import Jump, Switch, Switching, Timing, Way

SECOND = Unit("s", 1.0)
ONE = Unit("1", 1.0)


def switching_record(switching: Switching) -> dict[str, object]:
    """The changes of mode."""
    return {
        "mode": switching.mode,
        "standing": str(switching.standing),
        "reasons": list(switching.reasons),
        "advice": list(switching.advice),
        "ways": [_way(way) for way in switching.ways],
        "switches": [_switch(switch) for switch in switching.switches],
    }


def diagnosis_record(diagnosis: Diagnosis) -> dict[str, object]:
    """Why the robot departs."""
    return {
        "told": str(diagnosis.told),
        "sentences": list(diagnosis.sentences),
        "refitted": [_refitted(each) for each in diagnosis.refitted],
        "after": [_after(each) for each in diagnosis.after],
        "candidates": [_candidate(each) for each in diagnosis.candidates],
        "differs": [{"name": each.name, "sentence": each.sentence} for each in diagnosis.differs],
    }


def limits_record(limits: Limits) -> dict[str, object]:
    """What the trace can't tell, and what it would have caught."""
    return {
        "not_told": [
            {
                "what": each.what,
                "names": list(each.names),
                "why": each.why,
                "suggestion": each.suggestion,
                "origin": each.origin,
            }
            for each in limits.not_told
        ],
        "caught": [_caught(each) for each in limits.caught],
        "notes": list(limits.notes),
    }


def features_record(features: Features) -> dict[str, object]:
    """The robot's topology beside the spec's."""
    return {
        "axes": list(features.axes),
        "confidence": features.confidence,
        "features": [_feature(each) for each in features.features],
        "notes": list(features.notes),
    }


def scores_record(scores: Scores) -> dict[str, object]:
    """Scores of similarity, for comparison only."""
    return {
        "sentences": list(scores.sentences),
        "variables": {each.name: _scores(each) for each in scores.variables},
    }


def finding_record(finding: Finding) -> dict[str, object]:
    """One finding, with its place in the spec."""
    return {
        "rule": str(finding.rule),
        "level": str(finding.level),
        "subject": finding.subject,
        "message": finding.message,
        "origin": finding.origin,
    }


def _way(way: Way) -> dict[str, object]:
    return {
        "from": way.source,
        "to": way.target,
        "standing": str(way.standing),
        "expected": way.expected,
        "unexpected": way.unexpected,
        "missed": way.missed,
        "wrong_target": way.wrong,
        "timing": None if way.timing is None else _timing(way.timing),
        "jumps": [_jump(jump) for jump in way.jumps],
        "origin": way.origin,
    }


def _timing(timing: Timing) -> dict[str, object]:
    return {
        "count": timing.count,
        "late": _number(timing.late, SECOND),
        "interval": _interval(timing.interval, SECOND),
        "allowed": _number(timing.allowed, SECOND),
        "basis": timing.basis,
        "resolution": _number(timing.resolution, SECOND),
        "standing": str(timing.standing),
    }


def _jump(jump: Jump) -> dict[str, object]:
    return {
        "name": jump.name,
        "unit": jump.unit.text,
        "is_reset": jump.is_reset,
        "count": jump.count,
        "error": _number(jump.error, jump.unit),
        "interval": _interval(jump.interval, jump.unit),
        "tolerance": _number(jump.tolerance, jump.unit),
        "standing": str(jump.standing),
    }


def _switch(switch: Switch) -> dict[str, object]:
    return {
        "time": _number(switch.time, SECOND),
        "from": switch.source,
        "to": switch.target,
        "sort": str(switch.sort),
        "wanted": switch.wanted,
        "late": _number(switch.late, SECOND),
        "doubt": _number(switch.doubt, SECOND),
        "allowed": _number(switch.allowed, SECOND),
    }


def _refitted(number: Refitted) -> dict[str, object]:
    return {
        "kind": str(number.kind),
        "name": number.name,
        "unit": number.unit.text,
        "spec": _number(number.spec, number.unit),
        "value": _number(number.value, number.unit),
        "interval": _interval(number.interval, number.unit),
        "is_moved": number.is_moved,
        "sentence": number.sentence,
        "origin": number.origin,
    }


def _after(after: DepartureAfter) -> dict[str, object]:
    return {
        "name": after.name,
        "unit": after.unit.text,
        "tolerance": _number(after.tolerance, after.unit),
        "noise": _number(after.noise, after.unit),
        "before": _number(after.before, after.unit),
        "after": _number(after.after, after.unit),
        "interval": _interval(after.interval, after.unit),
        "standing": str(after.standing),
        "origin": after.origin,
    }


def _candidate(candidate: Candidate) -> dict[str, object]:
    return {
        "kind": str(candidate.kind),
        "applies_to": list(candidate.applies_to),
        "label": candidate.label,
        "numbers": [_fitted(number) for number in candidate.numbers],
        "evidence": {
            "windows": candidate.evidence.windows,
            "share": _number(candidate.evidence.share, ONE),
            "gain": _number(candidate.evidence.gain, ONE),
            "before": list(candidate.evidence.before),
        },
        "is_taken": candidate.is_taken,
        "alike": list(candidate.alike),
        "sentence": candidate.sentence,
        "origin": candidate.origin,
    }


def _fitted(number: FittedNumber) -> dict[str, object]:
    return {
        "name": number.name,
        "unit": number.unit.text,
        "neutral": _number(number.neutral, number.unit),
        "value": _number(number.value, number.unit),
        "interval": _interval(number.interval, number.unit),
    }


def _caught(caught: Caught) -> dict[str, object]:
    return {
        "fault": str(caught.fault),
        "variable": caught.variable,
        "unit": caught.unit.text,
        "smallest": _number(caught.smallest, caught.unit),
        "largest_not_caught": _number(caught.largest, caught.unit),
        "trials": [
            {"size": _number(trial.size, caught.unit), "verdict": str(trial.verdict)}
            for trial in caught.trials
        ],
        "shown_by": list(caught.shown_by),
        "sentence": caught.sentence,
        "origin": caught.origin,
    }


def _feature(feature: ComparedFeature) -> dict[str, object]:
    return {
        "kind": feature.kind,
        "name": feature.name,
        "claim": feature.claim,
        "in_spec": feature.in_spec,
        "standing": str(feature.standing),
        "visits": feature.visits,
        "numbers": [_feature_number(number) for number in feature.numbers],
        "sentence": feature.sentence,
        "origin": feature.origin,
    }


def _feature_number(number: FeatureNumber) -> dict[str, object]:
    return {
        "name": number.name,
        "unit": number.unit.text,
        "spec": _number(number.spec, number.unit),
        "seen": _estimate(number.seen, number.unit),
        "refitted": _estimate(number.refitted, number.unit),
        "tolerance": _number(number.tolerance, number.unit),
        "allowed_by": number.allowed_by,
        "standing": str(number.standing),
    }


def _estimate(estimate: Estimate | None, unit: Unit) -> dict[str, object] | None:
    if estimate is None:
        return None
    return {"value": _number(estimate.value, unit), "interval": _interval(estimate.interval, unit)}


def _scores(scores: VariableScores) -> dict[str, object]:
    iso = scores.iso
    return {
        "samples": scores.samples,
        "nrmse": _number(scores.nrmse, ONE),
        "r_squared": _number(scores.r_squared, ONE),
        "iso_18571": iso
        and {
            "overall": iso.overall,
            "corridor": iso.corridor,
            "phase": iso.phase,
            "magnitude": iso.magnitude,
            "slope": iso.slope,
        },
    }


def _interval(interval: Interval, unit: Unit) -> list[float | None]:
    return [_number(interval.low, unit), _number(interval.high, unit)]


def _number(value: float, unit: Unit) -> float | None:
    return float(value) / unit.scale if math.isfinite(value) else None
