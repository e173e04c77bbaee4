"""Did you mean: the nearest known word to one that is not known."""

from collections.abc import Iterable, Sequence

LONGEST = 40
"""Longer words are no slips of the pen, and comparing them costs time."""


def nearest(word: str, candidates: Iterable[str]) -> str | None:
    """The candidate that `word` was probably meant to be, or None.

    >>> nearest("gian", ["goal", "gain"]), nearest("velocity", ["x", "v"])
    ('gain', None)
    """
    if len(word) > LONGEST:
        return None
    scored = sorted(
        (distance(_folded(word), _folded(known)), place, known)
        for place, known in enumerate(candidates)
        if abs(len(known) - len(word)) <= _allowed(word)
    )
    if not scored or scored[0][0] > min(_allowed(word), _allowed(scored[0][2])):
        return None
    return scored[0][2]


def did_you_mean(word: str, candidates: Iterable[str]) -> str:
    """`did you mean 'gain'?`, or nothing."""
    known = nearest(word, candidates)
    return did_you_mean_one_of([known] if known else [])


def did_you_mean_one_of(names: Sequence[str]) -> str:
    """The same of names that are found in another way.

    >>> did_you_mean_one_of(["gain", "goal"]), did_you_mean_one_of([])
    ("did you mean 'gain' or 'goal'?", '')
    """
    quoted = " or ".join(f"'{name}'" for name in names)
    return f"did you mean {quoted}?" if names else ""


def distance(a: str, b: str) -> int:
    """How many letters to insert, remove, replace or swap with their neighbour to get from a to b.

    The optimal string alignment distance (Boytsov 2011, section 2.1).
    """
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, start=1):
        new = [i]
        for j, y in enumerate(b, start=1):
            best = min(row[j] + 1, new[-1] + 1, row[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                best = min(best, before[j - 2] + 1)
            new.append(best)
        before, row = row, new
    return row[-1]


def _folded(word: str) -> str:
    return word.casefold().replace("-", "_").replace(" ", "_")


def _allowed(word: str) -> int:
    """How many slips a word of this length may hold: one in three letters, in one letter none."""
    return max(1, len(word) // 3) if len(word) > 1 else 0


def there_are(known: Sequence[str]) -> str:
    """All the names that there are, as a help.

    >>> there_are(["mu"]), there_are(["mu", "gain"]), there_are([])
    ('there is mu', 'there are mu, gain', 'there are none')
    """
    return f"there {'is' if len(known) == 1 else 'are'} {', '.join(known) or 'none'}"
