"""What the language is: which text means which tree, and what is said of any other text."""

import gc
import math
import time
import tracemalloc

import pytest

from spec_schema.expressions.parse import parse
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.rewrite import names_in, resolve_texts, substitute, unknown_names
from spec_schema.expressions.tree import FUNCTIONS, Apply, Name, Number, Text, walk
from spec_schema.faults import ExpressionError, Fault
from spec_schema.names import FUNCTIONS as RESERVED_FUNCTIONS

TEXT = "a text can only be compared with a discrete variable, by == or !="
BARE = "a number in an expression has no unit"


def named(number: str, unit: str) -> str:
    """The help where a unit follows a number."""
    constant = f"margin: {{value: {number} {unit}, unit: {unit}}}"
    return f"name it under `constants` (`{constant}`) and write `margin` here"


def faults(text: str) -> tuple[Fault, ...]:
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    return caught.value.faults


def told(text: str) -> list[tuple[str, str, str]]:
    """What is underlined, the message and the help of each fault."""
    return [(text[f.start : f.end], f.message, f.help) for f in faults(text)]


@pytest.mark.parametrize(
    ("text", "postfix"),
    [
        ("a + b*c", "a b c mul add"),
        ("a - b - c", "a b sub c sub"),
        ("a/b/c", "a b div c div"),
        ("a**b**c", "a b c pow pow"),
        ("-a**2", "a 2 pow neg"),
        ("(-2)**2", "-2 2 pow"),
        ("2**-1", "2 -1 pow"),
        ("--a", "a neg neg"),
        ("+a", "a"),
        ("a % b", "a b mod"),
        ("a < b", "a b lt"),
        ("a < b <= c", "a b lt b c le and"),
        ("a or b and not c", "a b c not and or"),
        ("a and b and c", "a b and c and"),
        ("min(a, b, c)", "a b min c min"),
        ("max(a, b)", "a b max"),
        ("where(a > 0, b, c)", "a 0 gt b c where"),
        ("clip(a, 0, 1)", "a 0 1 clip"),
        ("atan2(a, b)", "a b atan2"),
        ("pi", "3.141592653589793"),
        ("-pi", "-3.141592653589793"),
        ("1e-3 + .5 + 2.", "0.001 0.5 add 2 add"),
        ("1_000", "1000"),
        ("0.1", "0.1"),
        (" \n a +\n\t b\n", "a b add"),
    ],
)
def test_text_means_this_postfix(text: str, postfix: str) -> None:
    assert to_postfix(parse(text)) == postfix


def test_each_function_is_called_by_its_name() -> None:
    for op in FUNCTIONS:
        for count in (1, 2, 3):
            try:
                expr = parse(f"{op}({', '.join('abc'[:count])})")
            except ExpressionError as error:
                assert [fault.code for fault in error.faults] == ["S137"]  # noqa: PT017  # most counts are wrong
            else:
                assert isinstance(expr, Apply)
                assert expr.op == op


def test_no_function_can_be_a_name() -> None:
    assert FUNCTIONS == RESERVED_FUNCTIONS


def test_a_text_is_compared_with_a_name() -> None:
    expr = parse("action == 'Move-Forward' and \"x\" != mode")
    assert [n.text for n in walk(expr) if isinstance(n, Text)] == ["Move-Forward", "x"]


def test_every_node_knows_its_place() -> None:
    text = "theta + (2*sin( x ) - y)**k"
    places = {}
    for node in walk(parse(text)):
        key = node.op if isinstance(node, Apply) else str(getattr(node, "name", "2"))
        places[key] = text[node.start : node.end]
    assert places == {
        "add": text,
        "theta": "theta",
        "pow": "(2*sin( x ) - y)**k",
        "sub": "2*sin( x ) - y",
        "mul": "2*sin( x )",
        "2": "2",
        "sin": "sin( x )",
        "x": "x",
        "y": "y",
        "k": "k",
    }


def test_every_operation_knows_its_operator() -> None:
    text = "  é + (a) * -b ** c\n and not d <= (e) or min(f, g)"
    marks = {n.op: text[slice(*n.mark)] for n in walk(parse(text)) if isinstance(n, Apply)}
    assert marks == {
        "add": "+",
        "mul": "*",
        "neg": "-",
        "pow": "**",
        "and": "and",
        "not": "not",
        "le": "<=",
        "or": "or",
        "min": "min",
    }


@pytest.mark.parametrize(
    ("text", "at", "message", "advice"),
    [
        ("sine(x)", "sine", "no function is named 'sine'", "did you mean 'sin'?"),
        ("np.cos(x)", "np.cos", "no function is named 'np.cos'", "write cos(...)"),
        ("ln(x)", "ln", "no function is named 'ln'", "write log(x)"),
        ("x ^ 2", "^", "'^' is not part of the language", "write ** for a power"),
        ("a && b", "&&", "'&&' is not an operator here", "write and"),
        ("a || b", "||", "'||' is not an operator here", "write or"),
        ("!a", "!", "'!' is not an operator here", "write not"),
        ("a = b", "=", "'=' is not an operator here", "write =="),
        ("a => b", "=>", "'=>' is not an operator here", "write >="),
        ("a ≤ b", "≤", "'≤' is not an operator here", "write <="),
        ("a²", "²", "'²' is not an operator here", "write **2"),
        ("a // b", "//", "'//' is not part of the language", "write floor(a / b)"),
        ("a @ b", "@", "'@' is not part of the language", "write * for a product"),
        ("~a", "~", "'~' is not part of the language", "write not"),
        ("a is b", "a is b", "'is' is not part of the language", "write =="),
        ("2x", "2x", "an operator is missing between '2' and 'x'", "write 2*x"),
        ("front > danger + 5 cm", "5 cm", BARE, named("5", "cm")),
        ("ahead < 30deg", "30deg", BARE, named("30", "deg")),
        ("v > 5 ms/cm**2 - x", "5 ms/cm**2", BARE, named("5", "ms/cm**2")),
        ("v > 5 mm/x", "5 mm", BARE, named("5", "mm")),
        ("v > 2 m", "2 m", BARE, named("2", "m") + "; for a product with 'm' write 2*m"),
        ("x cm", "x cm", "an operator is missing between 'x' and 'cm'", "write * for a product"),
        ("x y", "x y", "an operator is missing between 'x' and 'y'", "write * for a product"),
        ("(a) b", ") b", "an operator is missing between ')' and 'b'", "write * for a product"),
        ("2(x)", "2", "'2' is not a function", "write * for a product"),
        ("x +", "+", "a value is missing after '+'", "write it, or remove '+'"),
        ("* x", "*", "a value is missing before '*'", "write it, or remove '*'"),
        (
            "x + * y",
            "+ *",
            "a value is missing between '+' and '*'",
            "write it, or remove one of both",
        ),
        ("min(a, , b)", ",", "a value is missing before ','", "write it, or remove ','"),
        ("(x", "(", "'(' is never closed", "add ')'"),
        ("x)", ")", "')' closes nothing", "remove it, or open a bracket"),
        ("1 if x > 0 else y", "1 if x > 0 else y", "'if ... else' is not part of the language",
         "write where(x > 0, 1, y)"),
        ("a ? b : c", "?", "'?' is not part of the language",
         "write where(c, a, b) for 'a if c, else b'"),
        ("a.b", "a.b", "'.b' is not part of the language", "names have no dots"),
        ("a[0]", "a[0]", "'[...]' is not part of the language",
         "values have no parts; give each a name"),
        ("lambda: 1", "lambda: 1", "a function (lambda) is not part of the language", ""),
        ("[x for x in y]", "[x for x in y]", "a loop is not part of the language", ""),
        ("(a, b)", "(a, b)", "a list of values is not part of the language", ""),
        ("(x := 1)", "x := 1", "an assignment is not part of the language", ""),
        ("min(*a)", "*", "a value is missing before '*'", "write it, or remove '*'"),
        ("a not in b", "a not in b",
         "'not in' is not part of the language", "write x != 'a' and x != 'b'"),
        ("a is not b", "a is not b", "'is not' is not part of the language", "write !="),
        ("min(a, b=2)", "=", "'=' is not an operator here", "write =="),
        ("True", "True", "'True' is not part of the language", "write 1"),
        ("true", "true", "'true' is not part of the language", "write 1"),
        ("None", "None", "'None' is not part of the language", ""),
        ("2j", "2j", "an operator is missing between '2' and 'j'", "write 2*j"),
        ("sin + 1", "sin", "'sin' is a function and needs its arguments", "write sin(...)"),
        ("sin(a, b)", "sin(a, b)", "sin takes 1 argument (got 2)", ""),
        ("where(a, b)", "where(a, b)", "where takes 3 arguments (got 2)", ""),
        ("min(a)", "min(a)", "min takes at least 2 arguments (got 1)", ""),
        ("1e400", "1e400", "the number 1e400 is too large", "numbers reach up to 1.797e308"),
        ("'go'", "'go'", TEXT, ""),
        ("a < 'go'", "'go'", TEXT, ""),
        ("sin('go')", "'go'", TEXT, ""),
        ("'a' == 'b'", "'a'", TEXT, ""),
        ("a == 'it", "'", "this text is not closed on its line", "texts hold no quotes and no \\"),
        ("a # b", "#", "'#' is not part of the language",
         "a comment belongs outside the expression's text"),
        ("  ", "  ", "the expression is empty", ""),
    ],
)  # fmt: skip
def test_a_mistake_is_explained(text: str, at: str, message: str, advice: str) -> None:
    assert told(text)[0] == (at, message, advice)


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("sine(x) ^ 2 && y = cosine(t)", ["S136", "S134", "S133", "S133", "S136"]),
        ("2x + 3y", ["S133", "S133"]),
        ("(a + ) * b c", ["S133", "S133"]),
        ("foo(1e999, a.b, 'c', True)", ["S136", "S135", "S134", "S134"]),
    ],
)
def test_all_mistakes_are_told_at_once(text: str, codes: list[str]) -> None:
    assert [fault.code for fault in faults(text)] == codes


@pytest.mark.parametrize(
    "text",
    [
        "x" * 10_001,
        "1" * 9_999,
        "9" * 400,
        "-" * 9_999 + "x",
        "(" * 4_000 + "x" + ")" * 4_000,
        "not " * 2_000 + "x",
        "x" + "**2" * 3_000,
        "x" + "+x" * 4_000,
        "x" + "+x" * 300,
        "sin(" * 60 + "x" + ")" * 60,
        "2**" * 250 + "2",
        "x if " * 900 + "x",
        "a<" * 900 + "a",
        "[" * 9_000,
        "lambda:" * 999 + "x",
        "x." * 900 + "x",
        "a" + "(b)" * 700,
        "x\0y",
        "x\ud800",
        "a == '\ud800'",
        "f'{x}'",
        "9" * 5_000 + " + 1",
        "0" * 9_999 + "1",
        "1" + "_1" * 4_000,
    ],
    ids=lambda text: f"{text[:6]!a} {len(text)}",
)
def test_a_hostile_text_is_refused_in_no_time(text: str) -> None:
    gc.collect()
    gc.disable()  # what other tests left is not looked through meanwhile
    tracemalloc.start()
    began = time.process_time()  # of the processor, however busy the machine is
    found = faults(text)
    seconds = time.process_time() - began
    gc.enable()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()

    assert all(0 <= fault.start < fault.end <= len(text) for fault in found)
    assert all(len(fault.message) < 200 for fault in found)
    assert seconds < 1.0
    assert peak < 50e6


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x" * 10_001, "the expression has 10001 characters (at most 10000)"),
        ("x" + "+x" * 1_001, "the expression has 1001 operators (at most 1000)"),
        ("(" * 51 + "x" + ")" * 51, "the expression has over 50 brackets within brackets"),
        ("x" + "+x" * 201, "the expression nests more than 200 operations"),
    ],
    ids=["long", "busy", "bracketed", "deep"],
)
def test_each_limit_is_told(text: str, message: str) -> None:
    (fault,) = faults(text)
    assert (fault.code, fault.message) == ("S132", message)


def test_two_hundred_terms_are_not_too_many() -> None:
    expr = parse("+".join(["x"] * 200))
    assert names_in(expr) == {"x"}
    assert expr == parse("+".join(["x"] * 200))


def test_nothing_of_the_text_is_ever_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SPECC_RAN", "0")
    for text in (
        "__import__('os').environ.update(SPECC_RAN='1')",
        "[c for c in ().__class__.__base__.__subclasses__()]",
        "(lambda: exit())()",
        "f'{exit()}'",
    ):
        assert faults(text)


def test_unknown_names_are_all_told_with_the_nearest() -> None:
    found = unknown_names(parse("x + gian*(goal - x) + gian"), ["x", "gain", "goal"])
    assert [(f.start, f.end, f.message, f.help) for f in found] == [
        (4, 8, "nothing is named 'gian'", "did you mean 'gain'?"),
        (22, 26, "nothing is named 'gian'", "did you mean 'gain'?"),
    ]


def test_texts_become_the_indices_of_their_values() -> None:
    values = {"action": ("Stop", "Move-Forward")}
    expr, found = resolve_texts(parse("action == 'Move-Forward' or 'Stop' != action"), values)
    assert not found
    assert to_postfix(expr) == "action 1 eq 0 action ne or"


@pytest.mark.parametrize(
    ("text", "message", "advice"),
    [
        ("action == 'Move-Forwrad'", "action has no value 'Move-Forwrad'",
         "did you mean 'Move-Forward'?"),
        ("action == 'zzz'", "action has no value 'zzz'", "it has Stop, Move-Forward"),
        ("x == 'Stop'", "x is a number and has no values by name", ""),
    ],
)  # fmt: skip
def test_a_text_that_is_no_value_is_refused(text: str, message: str, advice: str) -> None:
    _, found = resolve_texts(parse(text), {"action": ("Stop", "Move-Forward")})
    (fault,) = found
    assert (text[fault.start : fault.end][0], fault.code) == ("'", "S138")
    assert (fault.message, fault.help) == (message, advice)


def test_names_are_replaced_all_at_once() -> None:
    swapped = substitute(parse("x - y"), {"x": Name("y"), "y": Name("x")})
    assert swapped == parse("y - x")
    assert substitute(parse("-x"), {"x": Number(2.0)}) == Number(-2.0)


def test_pi_is_the_double_nearest_to_pi() -> None:
    assert parse("pi") == Number(math.pi)


@pytest.mark.parametrize(
    ("text", "underlined", "remedy"),
    [
        ("if x > 0 then k*x else 0", "if x > 0 then k*x else 0", "where(x > 0, k*x, 0)"),
        ("1 + (if c then a else b)", "if c then a else b", "where(c, a, b)"),
        ("max(if c then a else b, 3)", "if c then a else b", "where(c, a, b)"),
        (
            "if c then a else if d then e else f",
            "if c then a else if d then e else f",
            "where(c, a, where(d, e, f))",
        ),
        ("if(x > 0, 1, 2)", "if(x > 0, 1, 2)", "where(x > 0, 1, 2)"),
        ("if c then a", "if c then a", "where(c, a, b)"),
    ],
)
def test_a_choice_of_another_language_is_rewritten(text: str, underlined: str, remedy: str) -> None:
    (found,) = told(text)

    assert (found[0], found[2]) == (underlined, f"write {remedy}")
    if not text.endswith("then a"):
        parse(remedy)
