"""The table of principles is true: each has tests, each named one exists, and the page says so."""

import ast

from tests.conftest import Expect
from tests.principles.page import FOLDER, PAGE, names_of_tests, page
from tests.principles.table import PRINCIPLES

LETTERS = [*(f"1{letter}" for letter in "abcdefgh"), *(f"2{letter}" for letter in "abcdefg")]


def test_every_principle_of_section_2_4_is_there_once_and_in_order() -> None:
    assert [principle.letter for principle in PRINCIPLES] == LETTERS


def test_every_test_that_is_said_to_fail_without_a_principle_exists() -> None:
    for principle in PRINCIPLES:
        assert principle.fails
        assert set(principle.fails) <= set(names_of_tests(principle.letter)), principle.letter


def test_every_test_says_which_principle_it_holds() -> None:
    for letter in LETTERS:
        [module] = FOLDER.glob(f"test_{letter}_*.py")
        tree = ast.parse(module.read_text(encoding="utf-8"))
        tests = [
            node
            for node in tree.body
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
        ]
        assert tests
        for test in tests:
            assert (ast.get_docstring(test) or "").startswith(f"{letter}: "), test.name


def test_the_page_says_what_the_table_says_and_what_is_measured_now(expect: Expect) -> None:
    expect(PAGE, page())
