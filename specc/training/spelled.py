"""Learned rules as they stand in an arbiter's YAML, and an arbiter's text with them in it."""

from collections.abc import Iterator, Sequence
from typing import TypeGuard

import numpy as np

from lcs.policies.decision_list import DecisionList
from lcs.rules.digits import just_below
from runtime.arbiter import Arbiter, Read
from runtime.program import Kind
from spec_schema.editing.edits import Edit, NewLines, NewText
from spec_schema.editing.in_place import edited
from spec_schema.load import Loaded
from spec_schema.node import Mapping, Node, Plain
from spec_schema.scalars import resolve
from spec_schema.source import Source
from spec_schema.yaml_reader import read


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
    source = loaded.source
    by = _value(read(source), "by")
    return edited(source, tuple(_edits(by, arbiter, learner, rules)))


def condition(rules: DecisionList, rule: int, reads: Sequence[Read]) -> str:
    """When a rule holds, as the language has it: `ahead >= 0.2 and ahead < 0.31`; numbers in SI."""
    bounds = zip(reads, rules.lower[rule].tolist(), rules.upper[rule].tolist(), strict=True)
    return " and ".join(part for each, low, high in bounds for part in _parts(each, low, high))


def _edits(by: Node, arbiter: Arbiter, learner: str, rules: DecisionList) -> Iterator[Edit]:
    """As little as can be: the rules and what is chosen otherwise, where both stand there."""
    otherwise = arbiter.choices[rules.otherwise]
    own = by.entries[learner].value if isinstance(by, Mapping) and learner in by.entries else None
    lines, data = _rules(arbiter, rules)
    content: dict[str, Plain] = {"otherwise": otherwise, "rules": data}
    is_plain = _quoted(otherwise) == otherwise
    if _stands_in_lines(own) and set(own.entries) == set(content) and data and is_plain:
        yield NewText(("by", learner, "otherwise"), otherwise)
        yield NewLines(("by", learner, "rules"), tuple(lines), data)
        return
    inner = [f"otherwise: {_quoted(otherwise)}", *_listed(lines)]
    if own is not None and _stands_in_lines(by):
        yield NewLines(("by", learner), tuple(inner), content)
    else:
        below = (f"{learner}:", *(f"  {line}" for line in inner))
        yield NewLines(("by",), below, {learner: content})


def _listed(lines: Sequence[str]) -> list[str]:
    return ["rules:", *(f"  {line}" for line in lines)] if lines else ["rules: []"]


def _rules(arbiter: Arbiter, rules: DecisionList) -> tuple[list[str], list[Plain]]:
    """The rules as lines, and what is read of these."""
    lines: list[str] = []
    data: list[Plain] = []
    for r in range(len(rules)):
        choice, when = arbiter.choices[rules.action[r]], condition(rules, r, arbiter.reads)
        right, wrong = int(rules.right[r]), int(rules.wrong[r])
        parts = [f"choose: {_quoted(choice)}", *([f'when: "{when}"'] if when else [])]
        lines.append(f"- {{{', '.join(parts)}, right: {right}, wrong: {wrong}}}")
        record: dict[str, Plain] = {"choose": choice, "right": right, "wrong": wrong}
        data.append({**record, "when": when} if when else record)
    return lines, data


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
