"""Requirements in words: what they mean, that they print as they read, where mistakes are."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from spec_schema.expressions.tree import Apply, Expr, Name, Number
from spec_schema.requirement_sentences import (
    Compound,
    Predicate,
    Sentence,
    predicates_of,
    read_requirement,
    to_sentence,
)
from spec_schema.requirement_words import RequirementError

NAMES = ("r.x", "r.lamp.light", "crate.heading", "r2.choose.choice")
QUANTITIES = ("5 cm", "0.1 lx", "3 m/s", "90 deg", "1.5 1/s", "2 kg*m/s^2")

leaves = st.one_of(
    st.sampled_from([Name(name) for name in (*NAMES, *QUANTITIES)]),
    st.floats(0, 1e6, allow_nan=False).map(Number),
)


def applied(parts: st.SearchStrategy[Expr]) -> st.SearchStrategy[Expr]:
    two = st.tuples(st.sampled_from(("add", "sub", "mul", "div", "min", "hypot")), parts, parts)
    one = st.tuples(st.sampled_from(("abs", "sin")), parts)
    return st.one_of(
        two.map(lambda t: Apply(t[0], (t[1], t[2]))), one.map(lambda t: Apply(t[0], (t[1],)))
    )


expressions = st.recursive(leaves, applied, max_leaves=6)
comparisons = st.tuples(
    st.sampled_from(("lt", "le", "gt", "ge", "eq", "ne")), expressions, expressions
).map(lambda t: Predicate(Apply(t[0], (t[1], t[2]))))
windows = st.one_of(
    st.just((0.0, None)),
    st.floats(0.001, 1e4).map(lambda last: (0.0, last)),
    st.floats(0.001, 1e4).map(lambda first: (first, None)),
    st.tuples(st.floats(0.001, 1e2), st.floats(200, 1e4)),
)


def joined(parts: st.SearchStrategy[Sentence]) -> st.SearchStrategy[Sentence]:
    plain = st.tuples(st.sampled_from(("and", "or", "implies")), parts, parts)
    timed = st.tuples(st.sampled_from(("always", "eventually")), parts, windows)
    return st.one_of(
        plain.map(lambda t: Compound(t[0], (t[1], t[2]))),
        parts.map(lambda part: Compound("not", (part,))),
        timed.map(lambda t: Compound(t[0], (t[1],), *t[2])),
        st.tuples(parts, parts, windows).map(lambda t: Compound("until", (t[0], t[1]), *t[2])),
    )


sentences = st.recursive(comparisons, joined, max_leaves=6)


@given(sentences)
def test_a_printed_sentence_reads_back_as_the_same(sentence: Sentence) -> None:
    assert read_requirement(to_sentence(sentence)) == sentence


@given(sentences)
def test_brackets_and_spaces_around_it_mean_nothing(sentence: Sentence) -> None:
    assert read_requirement(f" ( ({to_sentence(sentence)}) )  ") == sentence


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("a.x > 1 and a.y > 2 or not a.z > 3", "(a.x > 1 and a.y > 2) or (not a.z > 3)"),
        ("0 m < a.x < 2 m", "0 m < a.x and a.x < 2 m"),
        ("always if a.x > 1 then a.y > 2", "always (if a.x > 1 then a.y > 2)"),
        ("(a.x + 1 m)*2 > 3 m", "(a.x + 1 m)*2 > 3 m"),
        ("always within 1 min a.x>1", "always within 60 s a.x > 1"),
        ("eventually from 500 ms to 2 s (a.x > 1)", "eventually from 0.5 s to 2 s a.x > 1"),
        ("a.x > 1 until after 3 s a.y > 1", "a.x > 1 until after 3 s a.y > 1"),
    ],
)
def test_a_sentence_means_what_it_says(text: str, printed: str) -> None:
    assert to_sentence(read_requirement(text)) == printed


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        ("alwais a.x > 1", "S370", "alwais"),
        ("never a.x > 1", "S370", "never"),
        ("always a.x > 1 and a.y > 2", "S372", "and"),
        ("always a.x > 1 until a.y > 2", "S372", "until"),
        ("a.x > 1 until a.y > 1 or a.z > 1", "S372", "or"),
        ("eventually a.x > 1 within 5 s", "S373", "within"),
        ("always within 5 a.x > 1", "S373", "5"),
        ("always within 5 m a.x > 1", "S125", "5 m"),
        ("always from 5 s to 2 s a.x > 1", "S373", "from 5 s to 2 s"),
        ("always a.x", "S374", "a.x"),
        ("always (a.x > 1", "S370", "1"),
        ("a.x > 5 bananas", "S121", "bananas"),
        ("a.x > @", "S370", "@"),
        ("if a.x > 1 and a.y > 2", "S370", "2"),
    ],
)
def test_a_mistake_is_told_at_its_place(text: str, code: str, marked: str) -> None:
    with pytest.raises(RequirementError) as caught:
        read_requirement(text)

    fault = caught.value.faults[0]
    assert fault.code == code
    assert text[fault.start : fault.end] == marked


@given(st.text(alphabet="ar.x>1 ()<=&'\"0smtilawyenvufo", max_size=40))
def test_no_text_breaks_the_reader(text: str) -> None:
    try:
        assert list(predicates_of(read_requirement(text)))
    except RequirementError as error:
        for fault in error.faults:
            assert 0 <= fault.start < max(fault.end, 1) <= max(len(text), 1)


def test_deep_nesting_is_refused() -> None:
    with pytest.raises(RequirementError):
        read_requirement("not " * 500 + "a.x > 1")
    with pytest.raises(RequirementError):
        read_requirement("(" * 100 + "a.x > 1" + ")" * 100)


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("always r.x > 1 m)", "remove it, or open a bracket"),
        ("always (r.x > 1 m and r.x < 2 m", "add ')'"),
        ("if r.x > 1 m", "write e.g. `if r.x > 1 m then r.speed == 0 m/s`"),
        ("always from 5 s r.x > 1 m", "write e.g. `from 5 s to 60 s`"),
        ("always r.x > .nan", "compare quantities and finite numbers, as in `r.clearance > 5 cm`"),
    ],
)
def test_a_sentence_that_is_none_says_what_to_write(text: str, remedy: str) -> None:
    with pytest.raises(RequirementError) as refused:
        read_requirement(text)

    assert remedy in {fault.help for fault in refused.value.faults}
