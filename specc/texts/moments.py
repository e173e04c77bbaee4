"""Why an arbiter decided as it did, in sentences: stretch by stretch, or at one moment."""

from collections.abc import Mapping
from typing import Final

from runtime.arbiter import Arbiter, Read
from specc.explaining import Explained
from specc.texts.arbiter_portraits import choice_name
from specc.texts.arbiters import RuleSentence, rule_sentences, way_of, word_of
from specc.texts.choices import shares_record, shares_text
from verifier.deciding.conditions import Values
from verifier.deciding.reasons import held_by
from verifier.deciding.stretches import Change, Near, Stretch, decision_at, near_at
from verifier.report.layout import INDENT, table
from verifier.report.wording import exact, listed, number, percent, quantity, seconds

DIFFERS: Final = "DIFFERS"
AGAIN: Final = "    "


def explained_text(found: Explained) -> str:
    """How often each was chosen, and each stretch: its rule, what began it, what was nearest."""
    lines = [_head(found)]
    if len(found.stretches) > 1:
        lines += ["", shares_text(found)]
    rules = rules_of(found)
    for stretch in found.stretches:
        lines += ["", *_stretch(found, stretch, rules)]
    return "\n".join(lines)


def moment_text(found: Explained, at: float) -> str:
    """One decision: what was read, and for each read what would change the choice."""
    place = decision_at(found.moments.decisions.times, at)
    stretch = stretch_at(found, place)
    arbiter, time = found.arbiter, found.moments.decisions.times[place]
    rules = rules_of(found)
    lines = [
        f"{found.name} at {number(time, 5)} s: {_chosen(found, stretch)}",
        f"{INDENT}{_rule(found, stretch, rules)}",
    ]
    reason = _because(found, stretch, place)
    lines += [INDENT + reason] if reason else []
    near = {} if found.margins is None else _by_read(found, place)
    rows = []
    for k, read in enumerate(arbiter.reads):
        value = value_text(read, float(found.moments.decisions.register[place, k]))
        told = _would(arbiter, near[k]) if k in near else _unchanged(found)
        rows.append((read.name, value, told))
    return "\n".join([*lines, table(rows, INDENT)])


def explained_record(found: Explained) -> dict[str, object]:
    """All stretches for programs: SI times, values in the spec's units."""
    rules = rules_of(found)
    return {
        "node": found.name,
        "recording": found.source,
        "arbiter": found.arbiter.name,
        "decisions": int(found.moments.decisions.times.size),
        "agreeing": int((found.moments.agrees & found.moments.decisions.judged).sum()),
        "judged": int(found.moments.decisions.judged.sum()),
        "shares": shares_record(found),
        "stretches": [_stretch_record(found, each, rules) for each in found.stretches],
    }


def moment_record(found: Explained, at: float) -> dict[str, object]:
    """One decision for programs."""
    place = decision_at(found.moments.decisions.times, at)
    stretch = stretch_at(found, place)
    near = {} if found.margins is None else _by_read(found, place)
    return {
        "node": found.name,
        "time": float(found.moments.decisions.times[place]),
        **_choice_record(found, stretch, rules_of(found)),
        "reads": {
            read.name: {
                "value": _value_record(read, float(found.moments.decisions.register[place, k])),
                "nearest": _near_record(found.arbiter, near[k]) if k in near else None,
            }
            for k, read in enumerate(found.arbiter.reads)
        },
    }


def rules_of(found: Explained) -> Mapping[int, RuleSentence]:
    """The rules in words by place, with controls as they were set at the first decision."""
    return {rule.number - 1: rule for rule in rule_sentences(found.arbiter, controls_of(found))}


def controls_of(found: Explained) -> Values:
    """SI values of the controls at the first decision."""
    arbiter, register = found.arbiter, found.moments.decisions.register
    if not len(register):
        return {}
    return {
        control.name: float(register[0, arbiter.register.index(control.name)])
        for control in arbiter.controls
    }


def stretch_at(found: Explained, place: int) -> Stretch:
    """The stretch that a decision is in."""
    return next(each for each in found.stretches if each.first <= place <= each.last)


def value_text(read: Read, value: float) -> str:
    """A value of a read: with its unit, or by its name."""
    if not read.values:
        return quantity(value, read.unit)
    place = round(value) if value == value else -1  # noqa: PLR0124  NaN was not read
    return read.values[place] if 0 <= place < len(read.values) else "unknown"


def _head(found: Explained) -> str:
    moments = found.moments
    decisions = moments.decisions
    count = decisions.times.size
    if not count:
        return f"{found.name}: no decision was recorded"
    span = f"{number(decisions.times[0], 5)} to {number(decisions.times[-1], 5)} s"
    judged = int(decisions.judged.sum())
    agreeing = int((moments.agrees & decisions.judged).sum())
    if agreeing == judged:
        told = "the robot chose as the spec each time"
    else:
        share = percent(agreeing / judged)
        told = f"the robot chose as the spec in {share} of them ({judged - agreeing} differ)"
    decides = f"{found.arbiter.name} decides {way_of(found.arbiter)}"
    every = f", every {seconds(decisions.period)}" if count > 1 else ""
    return f"{found.name}: {count} decisions, {span}{every}; {told}\n{decides}"


def _stretch(found: Explained, stretch: Stretch, rules: Mapping[int, RuleSentence]) -> list[str]:
    span = f"{number(stretch.start, 5)} to {number(stretch.end, 5)} s"
    lines = [f"{span}: {_chosen(found, stretch)}", AGAIN + _rule(found, stretch, rules)]
    reason = _because(found, stretch, stretch.first)
    lines += [AGAIN + reason] if reason else []
    if stretch.began:
        told = listed([change_text(found.arbiter, each) for each in stretch.began])
        alone = "" if len(stretch.began) == 1 else ", each of which was needed"
        lines.append(f"{AGAIN}it began as {told}{alone}")
    if stretch.nearest is not None:
        time = number(float(found.moments.decisions.times[stretch.nearest_at]), 5)
        read = found.arbiter.reads[stretch.nearest.read]
        value = value_text(read, stretch.nearest.value)
        told = _would(found.arbiter, stretch.nearest)
        lines.append(
            f"{AGAIN}nearest to another choice at {time} s: {read.name} was {value}, {told}"
        )
    return lines


def _chosen(found: Explained, stretch: Stretch) -> str:
    chosen, expected = (
        choice_name(found.arbiter, each) for each in (stretch.chosen, stretch.expected)
    )
    if stretch.agrees:
        return chosen if stretch.chosen == stretch.expected else f"{chosen} (not judged)"
    return f"{DIFFERS}: the robot chose {chosen}, the spec {expected}"


def _rule(found: Explained, stretch: Stretch, rules: Mapping[int, RuleSentence]) -> str:
    """The rule that decides by the spec, in words."""
    if stretch.place in rules:
        rule = rules[stretch.place]
        return f"{word_of(found.arbiter)} {rule.number}: {rule.sentence}"
    if rules:
        return f"no {word_of(found.arbiter)} holds"
    return f"decided {way_of(found.arbiter)}"


def _because(found: Explained, stretch: Stretch, at: int) -> str:
    """The quantities that held the rule, or that it went on."""
    if stretch.place < 0:
        return ""
    arbiter, register = found.arbiter, found.moments.decisions.register
    names = held_by(arbiter, stretch.place, register[at])
    if names is None:
        rule = arbiter.rules[stretch.place]
        why = "for the least time that it lasts" if rule.until is None else "it has not ended yet"
        return f"it held before and goes on: {why}"
    reads = {read.name: (k, read) for k, read in enumerate(arbiter.reads)}
    told = [
        f"{name} is {value_text(reads[name][1], float(register[at, reads[name][0]]))}"
        for name in names
        if name in reads
    ]
    return f"because {listed(told)}" if told else ""


def change_text(arbiter: Arbiter, change: Change) -> str:
    """`ahead fell from 0.36 to 0.24 m`."""
    read = arbiter.reads[change.read]
    if read.values:
        before, after = value_text(read, change.before), value_text(read, change.after)
        return f"{read.name} went from {before} to {after}"
    way = "fell" if change.after < change.before else "rose"
    before = number(change.before / read.unit.scale)
    return f"{read.name} {way} from {before} to {quantity(change.after, read.unit)}"


def _would(arbiter: Arbiter, near: Near) -> str:
    """`0.11 m above the boundary to avoid (0.25 m)`."""
    read, then = arbiter.reads[near.read], choice_name(arbiter, near.becomes)
    if read.values:
        return f"with {value_text(read, near.change)} it would be {then}"
    limit = exact(round_near(near.value + near.change), read.unit)
    if near.change == 0.0:
        return f"on the boundary to {then} ({limit})"
    way = "below" if near.change > 0.0 else "above"
    return f"{quantity(abs(near.change), read.unit)} {way} the boundary to {then} ({limit})"


def round_near(value: float) -> float:
    """A boundary without the last digits, in which sums are not exact."""
    return float(f"{value:.9g}")


def _unchanged(found: Explained) -> str:
    if found.margins is None:
        return ""
    return "no value of it alone makes another choice"


def _by_read(found: Explained, place: int) -> dict[int, Near]:
    assert found.margins is not None, "it has boundaries"
    return {near.read: near for near in near_at(found.moments, found.margins, place, place)}


def _stretch_record(
    found: Explained, stretch: Stretch, rules: Mapping[int, RuleSentence]
) -> dict[str, object]:
    arbiter, times = found.arbiter, found.moments.decisions.times
    near = stretch.nearest
    nearest = None
    if near is not None:
        nearest = {"time": float(times[stretch.nearest_at]), **_near_record(arbiter, near)}
    return {
        "start": stretch.start,
        "end": stretch.end,
        "decisions": stretch.decisions,
        **_choice_record(found, stretch, rules),
        "because": _because(found, stretch, stretch.first) or None,
        "began": [change_text(arbiter, each) for each in stretch.began],
        "nearest": nearest,
    }


def _choice_record(
    found: Explained, stretch: Stretch, rules: Mapping[int, RuleSentence]
) -> dict[str, object]:
    return {
        "chosen": choice_name(found.arbiter, stretch.chosen),
        "by_spec": choice_name(found.arbiter, stretch.expected),
        "agrees": stretch.agrees,
        "rule": stretch.place + 1 if stretch.place >= 0 else None,
        "told": _rule(found, stretch, rules),
    }


def _near_record(arbiter: Arbiter, near: Near) -> dict[str, object]:
    read = arbiter.reads[near.read]
    if read.values:
        change: object = value_text(read, near.change)
        boundary: object = None
    else:
        change = near.change / read.unit.scale
        boundary = round_near(near.value + near.change) / read.unit.scale
    return {
        "read": read.name,
        "value": _value_record(read, near.value),
        "change": change,
        "boundary": boundary,
        "unit": read.unit.text,
        "becomes": choice_name(arbiter, near.becomes),
    }


def _value_record(read: Read, value: float) -> object:
    if value != value:  # noqa: PLR0124  NaN: it was not recorded
        return None
    return value_text(read, value) if read.values else value / read.unit.scale
