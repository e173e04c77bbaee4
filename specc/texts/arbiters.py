"""An arbiter's rules as sentences on named quantities with units, sorted by what they decide."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Final, final

from runtime.arbiter import Arbiter, Paradigm
from runtime.program import Unit
from specc.texts.conditions import Speech, phrase, speech_of
from verifier.arbitration.comparisons import infix
from verifier.deciding.conditions import ALWAYS, Values
from verifier.deciding.reading import NOTHING_SET, ReadRule, read_rules
from verifier.report.wording import exact, seconds, suffix

LAYERS: Final = (
    "by layers, the highest first: on each channel the highest acts that holds and uses it"
)


@final
@dataclass(frozen=True, slots=True)
class RuleSentence:
    """A rule, or a layer of a subsumption, in words.

    number: from 1, in the order in which rules are asked. when: the condition alone, empty for
    what always holds. sentence: all of it, without the number. decides: False where earlier rules
    cover it, so that it never does. is_shorter: whether a condition was left out that follows from
    no earlier rule holding. origin: `file:line:column`.
    """

    number: int
    choice: str
    when: str
    sentence: str
    decides: bool
    is_shorter: bool
    origin: str


def rule_sentences(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> tuple[RuleSentence, ...]:
    """The rules of an arbiter in words, in their order; empty where it decides in another way.

    set_to: SI, of controls that are not at their defaults.
    """
    speech = speech_of(arbiter, set_to)
    return tuple(_rule(arbiter, each, speech) for each in read_rules(arbiter, set_to))


def word_of(arbiter: Arbiter) -> str:
    """What its rules are called: those of a subsumption are layers."""
    return "layer" if arbiter.paradigm is Paradigm.SUBSUMPTION else "rule"


def way_of(arbiter: Arbiter) -> str:
    """How it decides, as the end of a sentence that begins with its name: `decides ...`."""
    match arbiter.paradigm:
        case Paradigm.RULES:
            by = f"by rules that {arbiter.learner} learnt" if arbiter.learner else "by rules"
            return f"{by}: the first that holds decides"
        case Paradigm.SUBSUMPTION:
            return LAYERS
        case Paradigm.WEIGHTS:
            return "by weights: each choice counts as much as its expression, negative ones not"
        case Paradigm.COMPETITION:
            return "by a competition of its choices, each of which has an advantage from -1 to 1"
        case Paradigm.PLAN:
            plan = "a plan" if arbiter.plan is None else arbiter.plan.name
            return f"as {plan} does: the mode that it is in is the choice"
        case Paradigm.MODULE:
            return f"by code: {arbiter.module}"


def arbiter_sentences(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> tuple[str, ...]:
    """All that can be said of how it decides: `rule 2: dock, where ahead < 0.31 m`...

    Rules are sorted by what they decide; a choice comes where its first rule does.
    """
    rules = rule_sentences(arbiter, set_to)
    if rules:
        told = [f"{word_of(arbiter)} {each.number}: {each.sentence}" for each in by_choice(rules)]
        return (*told, *_never(arbiter, rules))
    match arbiter.paradigm:
        case Paradigm.WEIGHTS:
            pairs = zip(arbiter.choices, arbiter.weights, strict=True)
            return tuple(f"{choice} counts {infix(code)}" for choice, code in pairs)
        case Paradigm.COMPETITION if arbiter.competition is not None:
            pairs = zip(arbiter.choices, arbiter.competition.advantage, strict=True)
            return tuple(f"{choice} has the advantage {infix(code)}" for choice, code in pairs)
        case _:
            return ()


def arbiter_summary(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> str:
    """The arbiter for people: how it decides, its rules by what they decide, what it reads."""
    lines = [f"{arbiter.name} decides {way_of(arbiter)}"]
    lines += [f"  {sentence}" for sentence in arbiter_sentences(arbiter, set_to)]
    told = quantities(arbiter, set_to)
    if told:
        lines += ["what it reads", *(f"  {each}" for each in told)]
    return "\n".join(lines)


def arbiter_record(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> dict[str, object]:
    """The same for programs."""
    return {
        "name": arbiter.name,
        "spec": arbiter.source.file,
        "decides": str(arbiter.paradigm),
        "choices": list(arbiter.choices),
        "rules": [asdict(each) for each in rule_sentences(arbiter, set_to)],
        "sentences": list(arbiter_sentences(arbiter, set_to)),
        "quantities": list(quantities(arbiter, set_to)),
    }


def by_choice(rules: Sequence[RuleSentence]) -> tuple[RuleSentence, ...]:
    """The rules, those with one choice together, in the order of the first of each.

    A last one that always holds stays the last: it is what is left.
    """
    order = {choice: place for place, choice in enumerate(dict.fromkeys(r.choice for r in rules))}

    def place(rule: RuleSentence) -> tuple[bool, int, int]:
        is_left = rule.number == len(rules) and not rule.when
        return is_left, order[rule.choice], rule.number

    return tuple(sorted(rules, key=place))


def quantities(arbiter: Arbiter, set_to: Values = NOTHING_SET) -> tuple[str, ...]:
    """`ahead: distance to what is ahead, 0 to 2 m`, for each read and each control."""
    told = []
    for read in arbiter.reads:
        what = f"{read.about}, " if read.about else ""
        values = ", ".join(read.values) or _range(read.low, read.high, read.unit)
        told.append(f"{read.name}: {what}{values}")
    for control in arbiter.controls:
        what = f"{control.about}, " if control.about else ""
        now = exact(set_to.get(control.name, control.default), control.unit)
        ends = _range(control.low, control.high, control.unit)
        told.append(f"{control.name}: {what}{now}; a module above may set it, {ends}")
    return tuple(told)


def _range(low: float, high: float, unit: Unit) -> str:
    return f"{low / unit.scale:.6g} to {high / unit.scale:.6g}{suffix(unit)}"


def _rule(arbiter: Arbiter, rule: ReadRule, speech: Speech) -> RuleSentence:
    choice = arbiter.choices[rule.choice]
    when = "" if rule.when == ALWAYS else phrase(rule.when, speech)
    others = "otherwise" if arbiter.paradigm is Paradigm.RULES and rule.place else "always"
    sentence = f"{choice}, where {when}" if when else f"{choice}, {others}"
    if rule.until is not None:
        sentence += f"; once begun, until {phrase(rule.until, speech)}"
    if rule.lasts > 0.0:
        sentence += f"; for {seconds(rule.lasts)} at least"
    if not rule.decides:
        sentence += "; it never decides, because earlier rules hold wherever it does"
    return RuleSentence(
        rule.place + 1, choice, when, sentence, rule.decides, rule.is_shorter, rule.origin
    )


def _never(arbiter: Arbiter, rules: Sequence[RuleSentence]) -> list[str]:
    """A sentence for each choice that no rule decides for."""
    chosen = {rule.choice for rule in rules if rule.decides}
    return [f"{choice}, never" for choice in arbiter.choices if choice not in chosen]
