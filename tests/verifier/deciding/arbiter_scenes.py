"""Arbiters of rules, made at random and by hand."""

from collections.abc import Sequence

from hypothesis import strategies as st

from runtime.arbiter import Arbiter, Paradigm, Read, Rule
from runtime.code import Code
from runtime.program import Kind, Origin, Unit

METRE = Unit("m", 1.0)
NAMES = ("ahead", "left", "used")
CHOICES = ("avoid", "dock", "look")


def arbiter(
    rules: Sequence[Rule], paradigm: Paradigm = Paradigm.RULES, weights: Sequence[str] = ()
) -> Arbiter:
    """An arbiter of three reads, each 0 to 1 m, and one discrete one, lamp."""
    reads = [Read(name, METRE, 0.0, 1.0, Kind.CONTINUOUS, (), "", "") for name in NAMES]
    lamp = Read("lamp", Unit("1", 1.0), 0.0, 2.0, Kind.DISCRETE, ("off", "dim", "on"), "", "")
    return Arbiter(
        name="tried",
        about="",
        reads=(*reads, lamp),
        controls=(),
        constants=(),
        outputs=(),
        choices=CHOICES,
        paradigm=paradigm,
        rules=tuple(rules),
        weights=tuple(Code(each) for each in weights),
        competition=None,
        plan=None,
        module="",
        agreement=None,
        bindings=(),
        judge_when=None,
        source=Origin("tried.yaml", "", ""),
    )


def rule(choice: int, when: str = "", until: str = "", lasts: float = 0.0) -> Rule:
    """A rule from postfix code."""
    codes = [Code(each) if each else None for each in (when, until)]
    return Rule(choice, codes[0], codes[1], lasts, "")


NUMBERS = st.integers(0, 20).map(lambda k: k / 20.0)


@st.composite
def comparisons(draw: st.DrawFn) -> str:
    """A read compared with a number, or the sum of two."""
    word = draw(st.sampled_from(["lt", "le", "gt", "ge"]))
    name = draw(st.sampled_from([*NAMES, "ahead left add", "left used min", "lamp"]))
    number = draw(st.integers(0, 2)) if name == "lamp" else draw(NUMBERS)
    return f"{name} {number} {draw(st.sampled_from(['eq', 'ne'])) if name == 'lamp' else word}"


@st.composite
def conditions(draw: st.DrawFn) -> str:
    """One to three comparisons."""
    parts = draw(st.lists(comparisons(), min_size=1, max_size=3))
    joined = parts[0]
    for part in parts[1:]:
        joined = f"{joined} {part} {draw(st.sampled_from(['and', 'and', 'or']))}"
    return joined


@st.composite
def rule_lists(draw: st.DrawFn, *, latching: bool = False) -> list[Rule]:
    """Up to five rules; the last one may always hold."""
    found = []
    for _ in range(draw(st.integers(1, 4))):
        until = draw(comparisons()) if latching and draw(st.booleans()) else ""
        lasts = draw(st.sampled_from([0.0, 0.25])) if latching else 0.0
        found.append(rule(draw(st.integers(0, 2)), draw(conditions()), until, lasts))
    if draw(st.booleans()):
        found.append(rule(draw(st.integers(0, 2))))
    return found
