"""Learned rules as they stand in an arbiter's YAML, and an arbiter's text with them in it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, TypeGuard, final

import numpy as np

from lcs.policies.decision_list import DecisionList
from lcs.rules.digits import just_below
from runtime.arbiter import Arbiter, Read
from runtime.program import Kind
from spec_schema.arbiter import ArbiterSpec, LearnedRuleSpec, LearnedSpec
from spec_schema.editing.edits import Edit, NewLines, NewText
from spec_schema.editing.in_place import edited
from spec_schema.load import Loaded
from spec_schema.node import Mapping, Node, Plain
from spec_schema.scalars import resolve
from spec_schema.source import Source
from spec_schema.yaml_reader import read

COUNTS: Final = "right", "wrong"
"""How often a rule was right in training, and how often it was not."""


@final
@dataclass(frozen=True, slots=True)
class Spelled:
    """What stands under the learner of an arbiter: what is chosen otherwise, and each rule."""

    otherwise: str
    rules: tuple[dict[str, Plain], ...]


def with_rules(loaded: Loaded, arbiter: Arbiter, learner: str, rules: DecisionList) -> Source:
    """The text of an arbiter that decides by these rules; comments and all else are kept.

    Args:
        loaded: its file.
        arbiter: what that was compiled to.
        learner: `alcsr` or `xcsr`, by which it is said to decide.
        rules: over its reads, in their order.

    Raises:
        EditError: its `by` is written in a way that can't be changed in place.
    """
    return with_spelled(loaded.source, learner, _spelled(arbiter, rules))


def with_spelled(source: Source, learner: str, rules: Spelled) -> Source:
    """The text of an arbiter with these rules, as `with_rules`.

    Raises:
        EditError: its `by` is written in a way that can't be changed in place.
    """
    return edited(source, tuple(_edits(_value(read(source), "by"), learner, rules)))


def spelled_in(spec: ArbiterSpec, learned: LearnedSpec) -> Spelled:
    """What an arbiter says that it learned."""
    otherwise = learned.otherwise or spec.choices[0]
    return Spelled(otherwise, tuple(_said(rule) for rule in learned.rules))


def condition(rules: DecisionList, rule: int, reads: Sequence[Read]) -> str:
    """When a rule holds, as the language has it: `ahead >= 0.2 and ahead < 0.31`; numbers in SI."""
    bounds = zip(reads, rules.lower[rule].tolist(), rules.upper[rule].tolist(), strict=True)
    return " and ".join(part for each, low, high in bounds for part in _parts(each, low, high))


def _edits(by: Node, learner: str, rules: Spelled) -> Iterator[Edit]:
    """As little as can be: the rules and what is chosen otherwise, where both stand there."""
    own = by.entries[learner].value if isinstance(by, Mapping) and learner in by.entries else None
    data: list[Plain] = [*rules.rules]
    lines, otherwise = [_line(rule) for rule in rules.rules], _quoted(rules.otherwise)
    content: dict[str, Plain] = {"otherwise": rules.otherwise, "rules": data}
    is_plain = rules.otherwise == otherwise
    if _stands_in_lines(own) and set(own.entries) == set(content) and data and is_plain:
        yield NewText(("by", learner, "otherwise"), otherwise)
        yield NewLines(("by", learner, "rules"), tuple(lines), data)
        return
    inner = [f"otherwise: {otherwise}", *_listed(lines)]
    if own is not None and _stands_in_lines(by):
        yield NewLines(("by", learner), tuple(inner), content)
    else:
        below = (f"{learner}:", *(f"  {line}" for line in inner))
        yield NewLines(("by",), below, {learner: content})


def _listed(lines: Sequence[str]) -> list[str]:
    return ["rules:", *(f"  {line}" for line in lines)] if lines else ["rules: []"]


def _line(rule: dict[str, Plain]) -> str:
    """A rule as it is written."""
    choose, when = _quoted(str(rule["choose"])), rule.get("when")
    parts = [f"choose: {choose}", *([] if when is None else [f'when: "{when}"'])]
    return f"- {{{', '.join([*parts, *(f'{name}: {rule[name]}' for name in COUNTS)])}}}"


def _spelled(arbiter: Arbiter, rules: DecisionList) -> Spelled:
    """A list in the arbiter's own words."""
    return Spelled(
        arbiter.choices[rules.otherwise], tuple(_rule(arbiter, rules, r) for r in range(len(rules)))
    )


def _said(rule: LearnedRuleSpec) -> dict[str, Plain]:
    said: dict[str, Plain] = {"choose": rule.choose, "right": rule.right, "wrong": rule.wrong}
    return said if rule.when is None else {**said, "when": str(rule.when)}


def _rule(arbiter: Arbiter, rules: DecisionList, rule: int) -> dict[str, Plain]:
    when = condition(rules, rule, arbiter.reads)
    counts: dict[str, Plain] = {name: int(getattr(rules, name)[rule]) for name in COUNTS}
    said: dict[str, Plain] = {"choose": arbiter.choices[rules.action[rule]], **counts}
    return {**said, "when": when} if when else said


def _parts(read: Read, low: float, high: float) -> Iterator[str]:
    """What a rule asks of one read."""
    if read.kind is Kind.DISCRETE:
        yield from _values(read, low, high)
        return
    if np.isfinite(low):
        below = just_below(low)
        yield f"{read.name} >= {low!r}" if below is None else f"{read.name} > {below!r}"
    if np.isfinite(high):
        below = just_below(high)
        yield f"{read.name} < {high!r}" if below is None else f"{read.name} <= {below!r}"


def _values(read: Read, low: float, high: float) -> Iterator[str]:
    """Of a discrete read its value, or those that it is none of."""
    inside = [name for i, name in enumerate(read.values) if low <= i < high]
    if len(inside) == 1:
        yield f"{read.name} == '{inside[0]}'"
        return
    yield from (f"{read.name} != '{name}'" for name in read.values if name not in inside)


def _value(node: Node, key: str) -> Node:
    assert isinstance(node, Mapping), "the language refuses all else"
    return node.entries[key].value


def _stands_in_lines(node: Node | None) -> TypeGuard[Mapping]:
    """Whether a mapping is written with its keys one below the other."""
    if not isinstance(node, Mapping) or not node.entries:
        return False
    first = next(iter(node.entries.values()))
    return (first.key.line, first.key.column) == (node.span.line, node.span.column)


def _quoted(name: str) -> str:
    """A name as YAML reads it as one."""
    return name if resolve(name) == name else f'"{name}"'
