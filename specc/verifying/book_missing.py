"""What is still to be recorded of a module: its test procedure, without what was covered."""

from collections.abc import Mapping
from typing import TypeAlias

from specc.book.loading import LoadedBook
from specc.book.manifest import Module
from specc.book.trials import Trial
from specc.verifying.book_modules import Place
from verifier.procedure.bench_wording import how_sentence
from verifier.procedure.remaining import remaining_runs
from verifier.procedure.wording import runs_in_words
from verifier.report.examination import Examination

Told: TypeAlias = Mapping[Place, Module]


def told_of(book: LoadedBook) -> Told:
    """What the book tells of each module: its page, and its test procedure."""
    return {
        Place(architecture.name, module.node): module
        for architecture in book.book.architectures
        for module in architecture.modules
    }


def to_record(trial: Trial, found: Examination | None) -> tuple[str, ...]:
    """Sentences; found: what was recorded shows, None where nothing of it was."""
    advice = () if found is None else found.report.advice
    if trial.procedure is not None:
        coverage = None if found is None else found.report.coverage
        runs = remaining_runs(trial.procedure, coverage)
        return (
            *advice,
            *(f"test procedure, {told}" for told in runs_in_words(trial.procedure, runs)),
        )
    if trial.bench is not None:
        return (*advice, f"test procedure: {how_sentence(trial.bench)}; see its page")
    return (*advice, f"there is no test procedure: {trial.without}")
