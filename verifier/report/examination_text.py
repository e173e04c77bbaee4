"""The whole examination as plain text: what `specc verify` prints."""

from verifier.report.examination import Examination
from verifier.report.section_texts import section_texts
from verifier.report.text import as_text


def examination_text(examination: Examination) -> str:
    """The report with its sections; colours are the caller's business."""
    return as_text(examination.report, section_texts(examination))
