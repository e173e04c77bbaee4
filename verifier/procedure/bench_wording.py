"""The test procedure of an arbiter in words."""

from collections.abc import Iterator

from spec_schema.wording import listed as any_of
from verifier.procedure.bench_model import BenchTest, Biased, Shown
from verifier.report.report import Verdict
from verifier.report.wording import exact, listed, number, often, percent, quantity, seconds


def bench_sentences(test: BenchTest) -> tuple[str, ...]:
    """How to go about it, what to show, what to log, and what the rehearsal showed."""
    return (
        how_sentence(test),
        *shown_sentences(test),
        *rehearsal_sentences(test),
    )


def how_sentence(test: BenchTest) -> str:
    """How long each is shown, how often, and what to log."""
    names = listed([each.name for each in test.readings])
    return (
        f"show the arbiter these {len(test.shown)} sets of readings one after the other, each for"
        f" {seconds(test.seconds)}, all of them {often(test.repeats)}"
        f" ({seconds(test.duration)} in all); log {names} as it read them and its choice, at"
        f" {number(1.0 / test.period)} Hz"
    )


def shown_sentences(test: BenchTest) -> tuple[str, ...]:
    """`ahead 0.12 m, left 1 m and right 1.5 m: turn_away` for each set of readings."""
    return tuple(f"{place}: {_shown(test, each)}" for place, each in enumerate(test.shown, 1))


def _shown(test: BenchTest, each: Shown) -> str:
    told = [
        f"{r.name} {r.values[round(each.values[r.name])]}"
        if r.values
        else f"{r.name} {exact(each.values[r.name], r.unit)}"
        for r in test.readings
    ]
    return f"{listed(told)}: {each.chosen}"


def rehearsal_sentences(test: BenchTest) -> tuple[str, ...]:
    """What the verifier said of it before anybody showed it to a robot."""
    told = (
        f"rehearsed in simulation, the spec's own arbiter gets {test.verdict.upper()}"
        f" ({percent(test.required)} of decisions must agree)"
    )
    biased = tuple(_biased(test, each) for each in test.biased)
    return (told, *biased, *_lacking(test), *_never(test))


def _lacking(test: BenchTest) -> Iterator[str]:
    """What became of those that lack a rule, and which rules nobody would miss."""
    by_verdict: dict[Verdict, list[str]] = {}
    for each in test.lacking:
        by_verdict.setdefault(each.verdict, []).append(str(each.rule))
    for verdict, rules in by_verdict.items():
        untold = "" if verdict is Verdict.FAIL else ": these readings do not tell it apart for sure"
        yield f"one that lacks rule {any_of(rules, last='or')} gets {verdict.upper()}{untold}"
    if test.idle:
        idle = any_of(map(str, test.idle), last="or")
        yield f"one that lacks rule {idle} chooses the same at all of them"


def _never(test: BenchTest) -> Iterator[str]:
    if test.never:
        yield f"no readings that were tried make it choose {listed(list(test.never))}"


def _biased(test: BenchTest, each: Biased) -> str:
    unit = next(r.unit for r in test.readings if r.name == each.reading)
    return (
        f"one that reads {each.reading} {quantity(each.bias, unit)} too high gets"
        f" {each.verdict.upper()}"
    )
