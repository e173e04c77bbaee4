"""Amounts in sentences."""


def counted(count: int, noun: str) -> str:
    """So many things.

    >>> counted(1, "cycle"), counted(2_000, "episode"), counted(2, "box")
    ('1 cycle', '2,000 episodes', '2 boxes')
    """
    ending = "es" if noun.endswith("x") else "s"
    return f"{count:,} {noun}{ending * (count != 1)}"


def percent(share: float) -> str:
    """A share.

    >>> percent(0.9987)
    '99.87 %'
    """
    return f"{100.0 * share:.2f} %"
