"""The whole examination as JSON values: what `specc verify --format json` prints.

The format is described in docs/json_report.md and docs/schema/report.schema.json. `format` counts
up when a reader would have to change; keys may be added without that.
"""

from typing import Final

from verifier.report.arbitration_record import arbitration_record
from verifier.report.examination import Examination
from verifier.report.findings import findings_of
from verifier.report.record import as_json
from verifier.report.requirement_record import requirements_record
from verifier.report.section_records import (
    diagnosis_record,
    features_record,
    finding_record,
    limits_record,
    scores_record,
    switching_record,
)

FORMAT: Final = 1


def examination_record(examination: Examination) -> dict[str, object]:
    """The report with its sections; null for a section that was not computed."""
    of = examination
    return {
        "format": FORMAT,
        **as_json(of.report),
        "switching": of.switching and switching_record(of.switching),
        "diagnosis": of.diagnosis and diagnosis_record(of.diagnosis),
        "limits": of.limits and limits_record(of.limits),
        "features": of.features and features_record(of.features),
        "scores": of.scores and scores_record(of.scores),
        "arbitration": of.arbitration and arbitration_record(of.arbitration),
        "requirements": requirements_record(of.requirements) or None,
        "findings": [finding_record(each) for each in findings_of(of)],
    }
