"""Parts of a formula that may saturate or have a dead zone: whole rates, and differences in them.

A part E becomes first `E - clip(E, -zone, zone)`, then `clip(E, -limit, limit)`. With a zone of 0
and an endless limit it is E itself.
"""

from dataclasses import dataclass
from typing import Final, TypeAlias, final

from runtime.code import ARITY, Code
from runtime.program import Program

ENDLESS: Final = 1e12
MOST: Final = 4
"""So many differences of one rate are tried; the ones nearest to its root."""
SIGNS: Final = {"add": "+", "sub": "-", "mul": "*", "div": "/", "pow": "**"}

Tree: TypeAlias = tuple[str, tuple["Tree", ...]]


@final
@dataclass(frozen=True, slots=True)
class Wrap:
    """One part of the rate of `name`.

    key: in the names of its register entries. words: the part as people read it.
    """

    key: str
    name: str
    code: Code
    words: str
    is_whole: bool

    @property
    def limit(self) -> str:
        """The register's entry for the largest absolute value."""
        return f"limit:{self.key}"

    @property
    def zone(self) -> str:
        """The register's entry for the half width of the dead zone."""
        return f"zone:{self.key}"


def is_wrap(name: str) -> bool:
    """Whether this entry of the register belongs to a wrap."""
    return name.startswith(("limit:", "zone:"))


def wraps_of(program: Program) -> tuple[Wrap, ...]:
    """The parts of the formula; none where there is only a table."""
    found: list[Wrap] = []
    if program.field.formula is None or program.field.is_map:
        return ()
    moving = {state.name for state in program.states} | {c.name for c in program.controls}
    for name, code in zip(program.field.driven, program.field.formula, strict=True):
        tree = tree_of(code)
        if tree[1]:
            found.append(Wrap(name, name, code, f"the rate of {name}", is_whole=True))
        inner = dict.fromkeys(part for part in _parts(tree) if part is not tree)
        kept = [p for p in inner if p[0] in {"add", "sub"} and _names(p) & moving][:MOST]
        for i, part in enumerate(kept):
            text = Code(_text(part, {}))
            found.append(Wrap(f"{name}#{i}", name, text, _infix(part), is_whole=False))
    return tuple(found)


def wrapped(code: Code, wraps: tuple[Wrap, ...]) -> Code:
    """The code with its parts wrapped; `wraps` are those of this rate."""
    tree = tree_of(code)
    return Code(_text(tree, {wrap.code.text: wrap for wrap in wraps}))


def tree_of(code: Code) -> Tree:
    """The expression as nested (token, operands)."""
    stack: list[Tree] = []
    for token in code.tokens:
        count = ARITY.get(token, 0)
        operands = tuple(stack[len(stack) - count :])
        del stack[len(stack) - count :]
        stack.append((token, operands))
    (tree,) = stack
    return tree


def _parts(tree: Tree) -> list[Tree]:
    """The tree and all below it, level by level."""
    level, found = [tree], []
    while level:
        found += level
        level = [operand for part in level for operand in part[1]]
    return found


def _names(tree: Tree) -> set[str]:
    return {part[0] for part in _parts(tree) if not part[1]}


def _text(tree: Tree, wraps: dict[str, Wrap]) -> str:
    own = " ".join([*(_text(each, {}) for each in tree[1]), tree[0]])
    text = " ".join([*(_text(each, wraps) for each in tree[1]), tree[0]])
    wrap = wraps.get(own)
    if wrap is None:
        return text
    dead = f"{text} {text} {wrap.zone} neg {wrap.zone} clip sub"
    return f"{dead} {wrap.limit} neg {wrap.limit} clip"


def _infix(tree: Tree) -> str:
    name, operands = tree
    if not operands:
        return name
    if name in SIGNS:
        left, right = (_grouped(each) for each in operands)
        return f"{left} {SIGNS[name]} {right}"
    if name == "neg":
        return f"-{_grouped(operands[0])}"
    return f"{name}({', '.join(_infix(each) for each in operands)})"


def _grouped(tree: Tree) -> str:
    return f"({_infix(tree)})" if tree[0] in SIGNS else _infix(tree)
