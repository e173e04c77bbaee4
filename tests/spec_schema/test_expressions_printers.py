"""Every printed form means the same: C by a compiler, Python by numpy, LaTeX by its known text."""

import itertools
import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from spec_schema.expressions.evaluate import evaluate
from spec_schema.expressions.parse import parse
from spec_schema.expressions.printers.c99 import C99_FUNCTIONS, to_c99
from spec_schema.expressions.printers.latex import to_latex
from spec_schema.expressions.printers.numerals import numeral
from spec_schema.expressions.printers.postfix import to_postfix
from spec_schema.expressions.printers.python import to_python
from spec_schema.expressions.printers.text import to_text

CORPUS = [
    "x + y - 2*x/y",
    "x - (y - x)",
    "x - -y",
    "-(-x)",
    "-(x + y)*-2",
    "x/(y*x)/(x/y)",
    "-x**2",
    "(-x)**2",
    "(x + y)**3",
    "x**4 + x**5 + x**-1 + x**0.5 + 2**y",
    "x % 1.5 + (-x) % 1.5 + x % -1.5",
    "abs(x) + sign(y) + floor(3*x)",
    "min(x, y, 1) + max(x, y) + clip(x, -1, y)",
    "hypot(x, y) + atan2(x, y)",
    "exp(x/9) + log(abs(x) + 1) + sqrt(x)",
    "sin(x) + cos(y) + tan(x/3)",
    "asin(x/9) + acos(x/9) + atan(x)",
    "sinh(x/4) + cosh(y/4) + tanh(x)",
    "wrap(3*x) + wrap(x - 20)",
    "(x < y) + (x <= y)*2 + (x > y)*4 + (x >= y)*8 + (x == y)*16 + (x != y)*32",
    "(x < y)/(1 + (y < x))",
    "x and y",
    "not x or not (y and x)",
    "(x < y < 1) + (x and y)*(not y)",
    "where(x > 0 and y, x**2/2, where(y, 1, -1))*3 - where(not x, 1, 2)",
    "where(x, y, 1) < 2",
    "1/x",
    "0.1 + 1e-300 + 123456789012345678",
    "pi*x - 1e20",
]
POINTS = list(itertools.product((-3.7, -1.0, 0.0, 0.4, 2.0, 7.25), repeat=2))


def test_c_gives_the_same_numbers(tmp_path: Path) -> None:
    gcc = shutil.which("gcc")
    if gcc is None:
        pytest.skip("no C compiler here")
    rows = "\n".join(f'        printf("%.17g ", {to_c99(parse(text))});' for text in CORPUS)
    points = ", ".join(f"{{{x!r}, {y!r}}}" for x, y in POINTS)
    program = f"""#include <math.h>
#include <stdio.h>
{C99_FUNCTIONS}
int main(void)
{{
    static const double points[][2] = {{{points}}};
    for (int i = 0; i < {len(POINTS)}; i++) {{
        double x = points[i][0], y = points[i][1];
{rows}
        printf("\\n");
    }}
    return 0;
}}
"""
    source = tmp_path / "corpus.c"
    source.write_text(program)
    flags = ["-std=c99", "-Wall", "-Werror", "-ffp-contract=off", "-O1"]
    command = [gcc, *flags, str(source), "-o", str(tmp_path / "corpus"), "-lm"]
    subprocess.run(command, check=True, capture_output=True, timeout=60)
    out = subprocess.run([str(tmp_path / "corpus")], check=True, capture_output=True, timeout=60)
    found = [list(map(float, line.split())) for line in out.stdout.decode().splitlines()]

    for (x, y), numbers in zip(POINTS, found, strict=True):
        for text, number in zip(CORPUS, numbers, strict=True):
            expected = evaluate(parse(text), {"x": x, "y": y})
            assert number == pytest.approx(expected, rel=1e-13, nan_ok=True), (text, x, y)


@pytest.mark.parametrize("text", CORPUS)
def test_numpy_gives_the_same_numbers(text: str) -> None:
    x, y = np.array(POINTS).T
    with np.errstate(all="ignore"):
        source = f"lambda np, x, y: {to_python(parse(text))}"
        found = np.broadcast_to(eval(source)(np, x, y), x.shape)  # noqa: S307  # our own text
    expected = [evaluate(parse(text), {"x": a, "y": b}) for a, b in POINTS]
    assert list(found) == pytest.approx(expected, rel=1e-13, abs=1e-14, nan_ok=True)


@pytest.mark.parametrize("text", CORPUS)
def test_the_language_reads_its_own_text(text: str) -> None:
    assert parse(to_text(parse(text))) == parse(text)


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("((a))+(b*c)", "a + b*c"),
        ("a-(b-c)", "a - (b - c)"),
        ("(a-b)-c", "a - b - c"),
        ("(a**b)**c", "(a**b)**c"),
        ("a**(b**c)", "a**b**c"),
        ("(-a)**2", "(-a)**2"),
        ("-(a**2)", "-a**2"),
        ("a<b<c", "a < b and b < c"),
        ("not(a and b)", "not (a and b)"),
        ("(not a)==b", "(not a) == b"),
        ("2.0*pi", "2*pi"),
        ('s == "it"', "s == 'it'"),
    ],
)
def test_text_has_the_brackets_that_it_needs(text: str, written: str) -> None:
    assert to_text(parse(text)) == written


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("x**2 + y", "specc_square(x) + y"),
        ("(x + 1)**3", "specc_cube(x + 1.0)"),
        ("x**4 + x**5", "specc_fourth(x) + pow(x, 5.0)"),
        ("0.1*x", "0.1 * x"),
        ("x < y and not z", "(double)((x < y) && (!(z != 0.0)))"),
        ("where(x >= 0, x, -x)", "(x >= 0.0 ? x : -x)"),
    ],
)
def test_c_is_as_people_write_it(text: str, written: str) -> None:
    assert to_c99(parse(text)) == written


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("a/b", r"\frac{a}{b}"),
        ("(a/b)**2", r"\left(\frac{a}{b}\right)^{2}"),
        ("sqrt(x**2 + 1)", r"\sqrt{x^{2} + 1}"),
        ("2*x*y", r"2 \, x \, y"),
        ("x*2", r"x \cdot 2"),
        ("theta_dot - omega1", r"\theta_{\mathrm{dot}} - \omega_{1}"),
        ("speed*v_max_2", r"\mathit{speed} \, v_{\mathrm{max\_2}}"),
        ("exp(-x)", "e^{-x}"),
        ("abs(x) + floor(y)", r"\left|x\right| + \left\lfloor y\right\rfloor"),
        ("a - -b", r"a - \left(-b\right)"),
        ("1e-7*pi", r"10^{-7} \, \pi"),
        ("2.5e-7", r"2.5 \cdot 10^{-7}"),
        ("atan2(y, x)", r"\operatorname{atan2}\left(y, x\right)"),
        ("asin(x)*sin(x)", r"\arcsin\left(x\right) \, \sin\left(x\right)"),
        ("x <= y and not z", r"x \le y \land \lnot z"),
        ("s == 'Move_on'", r"s = \text{Move\_on}"),
        ("where(x > 0, 1, 2)",
         r"\begin{cases} 1 & \text{if } x > 0 \\ 2 & \text{otherwise} \end{cases}"),
    ],
)  # fmt: skip
def test_latex_is_as_a_textbook_prints_it(text: str, written: str) -> None:
    assert to_latex(parse(text)) == written


@pytest.mark.parametrize(
    "value", [0.0, -0.0, 1.0, -2.0, 0.1, 1 / 3, 1e15, 1e16, 1e22, 5e-324, 1.7976931348623157e308]
)
def test_a_numeral_reads_back_as_the_same_double(value: float) -> None:
    assert float(numeral(value)) == value
    assert math.copysign(1.0, float(numeral(value))) == math.copysign(1.0, value)


def test_postfix_is_one_line_of_tokens() -> None:
    assert to_postfix(parse("where(x > 0, -x**2, 1e-3)")) == "x 0 gt x 2 pow neg 0.001 where"
