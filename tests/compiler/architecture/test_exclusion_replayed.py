"""What is proved never happens in the scheduler, and what is refuted does happen there."""

from hypothesis import given, note, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.decide import decide
from tests.compiler.architecture.at_large import cases_at_large
from tests.compiler.architecture.exclusion_law import fate_of
from tests.compiler.architecture.exclusions import Case, cases

seeds = st.integers(0, 2**32 - 4)


def _obeys(case: Case, seed: int, steps: int) -> None:
    answer = decide(case.question)
    note(repr(answer))
    fate_of(case, answer, range(seed, seed + 3), steps)


@settings(max_examples=40)
@given(cases(), seeds)
def test_an_answer_is_what_the_scheduler_does(case: Case, seed: int) -> None:
    _obeys(case, seed, 50)


@settings(max_examples=8)
@given(cases_at_large(), seeds)
def test_so_it_is_where_behaviors_combine_and_readings_inhibit(case: Case, seed: int) -> None:
    _obeys(case, seed, 30)
