"""The sentences of `expect:`: what they mean, and where a wrong one is wrong."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.claim_sentences import (
    BASIN,
    FEATURES,
    Sentence,
    SentenceError,
    read_sentence,
)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("one stable cycle", Sentence("stable cycle", 1, 1, other=False)),
        ("no other attractor", Sentence("attractor", 0, 0, other=True)),
        ("exactly two saddles", Sentence("saddle", 2, 2, other=False)),
        ("at least 3 unstable foci", Sentence("unstable focus", 3, None, other=False)),
        ("at most twelve fixed points", Sentence("fixed point", 0, 12, other=False)),
        ("two other stable limit cycles", Sentence("stable cycle", 2, 2, other=True)),
        ("one semi-stable cycle", Sentence("semi-stable cycle", 1, 1, other=False)),
        (
            "at least 95 % of the domain goes to home",
            Sentence(BASIN, 0, None, other=False, share=0.95, goes_to="home"),
        ),
        (
            "at least 7.5% of the domain goes to it",
            Sentence(BASIN, 0, None, other=False, share=0.075, goes_to=""),
        ),
        (
            "all of the domain goes to home",
            Sentence(BASIN, 0, None, other=False, share=1.0, goes_to="home"),
        ),
    ],
)
def test_a_sentence_means(text: str, meant: Sentence) -> None:
    assert read_sentence(text) == meant


@given(st.sampled_from(FEATURES), st.integers(0, 999), st.booleans())
def test_every_feature_can_be_counted(feature: str, count: int, other: bool) -> None:  # noqa: FBT001  hypothesis gives it
    found = read_sentence(f"{count} {'other ' if other else ''}{feature}")

    assert found == Sentence(feature, count, count, other)


@pytest.mark.parametrize(
    ("text", "word", "help_"),
    [
        ("one stabel cycle", "stabel", "did you mean 'stable'?"),
        ("one stable cicle", "cicle", "did you mean 'cycle'?"),
        ("onee saddle", "onee", "did you mean 'one'?"),
        ("at leats one saddle", "at", "write e.g."),
        ("at least 95 % of the domian goes to home", "domian", "write `at least 95 %"),
        ("one saddle at x = 0", "at x = 0", "conditions stand behind a colon"),
        ("at least 120 % of the domain goes to it", "120 %", "write 95 %"),
        ("at least 95 % of the domain goes to 3rd", "3rd", "name what it goes to"),
    ],
)
def test_a_wrong_word_is_pointed_at(text: str, word: str, help_: str) -> None:
    with pytest.raises(SentenceError) as caught:
        read_sentence(text)

    fault = caught.value.fault
    assert text[fault.start : fault.end] == word
    assert fault.help.startswith(help_)


@pytest.mark.parametrize("text", ["one", "one stable", "no other", "exactly", "all of the domain"])
def test_an_unfinished_sentence_is_pointed_at_its_end(text: str) -> None:
    with pytest.raises(SentenceError) as caught:
        read_sentence(text)

    assert caught.value.fault.end == len(text)


@given(st.text(max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    fault = None
    try:
        read_sentence(text)
    except SentenceError as error:
        fault = error.fault
    assert fault is None or 0 <= fault.start <= fault.end <= len(text)
