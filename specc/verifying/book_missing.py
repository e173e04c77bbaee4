"""What is still to be recorded of a module: its test procedure, without what was covered."""

from runtime.arbiter import Arbiter
from runtime.program import Program
from spec_schema.diagnostics import SpecError
from specc.verifying.book_modules import Piece
from verifier.procedure.behavior import procedure_of
from verifier.procedure.remaining import remaining_runs
from verifier.procedure.wording import runs_in_words
from verifier.report.examination import Examination


def to_record(piece: Piece, found: Examination | None) -> tuple[str, ...]:
    """Sentences; found: what was recorded shows, None where nothing of it was."""
    if isinstance(piece.spec, Arbiter):
        return () if found is None else found.report.advice
    assert isinstance(piece.spec, Program), "code is not recorded"
    try:
        procedure = procedure_of(piece.spec, is_rehearsed=False)
    except SpecError as error:
        return (error.diagnostics[0].message,)
    coverage = None if found is None else found.report.coverage
    runs = remaining_runs(procedure, coverage)
    advice = () if found is None else found.report.advice
    return (*runs_in_words(procedure, runs), *advice)
