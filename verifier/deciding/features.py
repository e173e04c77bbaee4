"""Where truths may change: functions whose zeros hold all boundaries of some conditions.

A comparison changes where its sides are equal. A side with `min`, `max`, `abs`, `clip` or `where`
is one of several simpler ones at a time, so that most conditions change along straight lines.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, final

from runtime.code import Code
from verifier.deciding.conditions import OPPOSITE, Step, parsed

MOST_PIECES: Final = 64
"""A side of more simpler ones is taken whole."""
LOGIC: Final = frozenset({*OPPOSITE, "and", "or", "not"})


@final
@dataclass(frozen=True, slots=True)
class Feature:
    """A function that is zero where a truth may change; whether it is affine in what moves."""

    code: Code
    is_affine: bool


def features_of(codes: Iterable[Code], moving: Collection[str]) -> tuple[Feature, ...]:
    """The functions at whose zeros the truths of some conditions may change, each once.

    moving: the names that vary; everything else is held. A jump of `floor`, `mod` or `wrap` is none
    of them: there a truth may change without a zero.
    """
    found: dict[Code, Feature] = {}
    for code in codes:
        for step in _of_truth(parsed(code)):
            degree = _degree(step, moving)
            if degree:
                found.setdefault(step.code, Feature(step.code, degree == 1))
    return tuple(found.values())


def differences(codes: Sequence[Code], moving: Collection[str]) -> tuple[Feature, ...]:
    """The same for which of some numbers is the greatest, and which are above zero."""
    zero = Code("0")
    pairs = [(a, b) for i, a in enumerate(codes) for b in (*codes[i + 1 :], zero)]
    return features_of([Code(f"{a.text} {b.text} gt") for a, b in pairs], moving)


def _of_truth(step: Step) -> list[Step]:
    """The functions whose zeros bound where the value is true."""
    if step.word in {"and", "or", "not"}:
        return [each for operand in step.operands for each in _of_truth(operand)]
    if step.word in OPPOSITE:
        left, right = step.operands
        sides = [_pieces(side) for side in (left, right)]
        gaps = [Step("sub", pair) for pair in product(*sides)]
        return [*gaps, *_switches(left), *_switches(right)]
    return [*_pieces(step), *_switches(step)]


def _switches(step: Step) -> list[Step]:
    """The functions at whose zeros a number jumps."""
    if step.word in LOGIC:
        return _of_truth(step)
    inner = [each for operand in step.operands for each in _switches(operand)]
    if step.word == "where":
        return [*_of_truth(step.operands[0]), *inner]
    if step.word == "sign":
        return [*_pieces(step.operands[0]), *inner]
    return inner


def _pieces(step: Step) -> list[Step]:
    """The simpler functions of which a number is one at a time."""
    match step.word:
        case "min" | "max" | "clip":
            return [each for operand in step.operands for each in _pieces(operand)]
        case "abs":
            own = _pieces(step.operands[0])
            return [*own, *(Step("neg", (each,)) for each in own)]
        case "where":
            return [each for operand in step.operands[1:] for each in _pieces(operand)]
        case "sign":
            return [Step(text, ()) for text in ("-1", "0", "1")]
        case word if word in LOGIC:
            return [Step(text, ()) for text in ("0", "1")]
        case _:
            sides = [_pieces(operand) for operand in step.operands]
            made = [Step(step.word, operands) for operands in product(*sides)]
            return made if len(made) <= MOST_PIECES else [step]


def _degree(step: Step, moving: Collection[str]) -> int:
    """0 where nothing of it moves, 1 where it is affine in what moves, else 2."""
    if not step.operands:
        return int(step.word in moving)
    degrees = [_degree(operand, moving) for operand in step.operands]
    match step.word:
        case "add" | "sub" | "neg":
            return max(degrees)
        case "mul":
            return min(sum(degrees), 2)
        case "div":
            return degrees[0] if degrees[1] == 0 else 2
        case _:
            return 2 if any(degrees) else 0
