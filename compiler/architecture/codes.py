"""Code, read back as a tree: so that what is compiled can be bounded."""

from compiler.architecture.bodies import FAR
from runtime.code import ARITY, Code
from spec_schema.expressions.bounds import bounds
from spec_schema.expressions.tree import Apply, Expr, Name, Number


def tree_of(code: Code) -> Expr:
    """The tree that postfix code stands for."""
    stack: list[Expr] = []
    for token in code.tokens:
        arity = ARITY.get(token)
        if arity is not None:
            operands = tuple(stack[-arity:])
            del stack[-arity:]
            stack.append(Apply(token, operands))
        elif token[0].isalpha() or token[0] == "_":
            stack.append(Name(token))
        else:
            stack.append(Number(float(token)))
    return stack[-1]


def range_of_code(code: Code, box: dict[str, tuple[float, float]]) -> tuple[float, float]:
    """The least and the greatest value over a box; all numbers where that can't be told."""
    low, high = bounds(tree_of(code), box)
    return (max(-FAR, low), min(FAR, high))
