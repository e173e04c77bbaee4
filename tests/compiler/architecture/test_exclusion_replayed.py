"""What is proved never happens in the scheduler, and what is refuted does happen there."""

from hypothesis import given, note, settings
from hypothesis import strategies as st

from compiler.architecture.exclusion.answer import Proof, Witness
from compiler.architecture.exclusion.decide import decide
from tests.compiler.architecture.exclusions import Case, cases, random_readings


@settings(max_examples=40)
@given(cases(), st.integers(0, 2**32 - 1))
def test_an_answer_is_what_the_scheduler_does(case: Case, seed: int) -> None:
    answer = decide(case.question)
    note(repr(answer))

    if isinstance(answer, Witness):
        assert not answer.assumed
        assert case.replayed(answer)
    if isinstance(answer, Proof):
        for further in range(3):
            assert not case.both_act(random_readings(seed + further, 50), 50)
