"""What names of variables, columns and fields commonly mean, so that like can be put to like.

`heading` in a spec, `theta` in a CSV file and `/odom.pose.pose.orientation.@yaw` in a bag are one
quantity under three names. This only ever makes a suggestion.
"""

import re
from collections.abc import Sequence
from difflib import get_close_matches

_PATHS = (
    (r"\.@yaw$", "yaw"),
    (r"position\.x$", "x"),
    (r"position\.y$", "y"),
    (r"position\.z$", "z"),
    (r"(twist|vel\w*)\.linear\.x$", "speed"),
    (r"(twist|vel\w*)\.angular\.z$", "turn"),
    (r"angular_velocity\.z$", "turn"),
)
_WORDS = {
    "yaw": {"yaw", "heading", "theta", "psi", "bearing"},
    "speed": {"speed", "v", "vx", "velocity"},
    "turn": {"turn", "omega", "w", "wz", "yawrate", "turning"},
}
_ASKED = re.compile(r"cmd|command|commanded|set|setpoint|ref|reference|goal|target|desired|des")


def meaning(name: str) -> str:
    """The quantity that a variable, a column or a path names; its last word where that is unknown.

    >>> meaning("/odom.pose.pose.orientation.@yaw"), meaning("theta_deg"), meaning("turn_cmd")
    ('yaw', 'yaw', 'turn')
    """
    for pattern, quantity in _PATHS:
        if re.search(pattern, name):
            return quantity
    inside = name.split(".")[1:]
    if len(inside) > 1 and len(inside[-1]) == 1:
        return ".".join(inside[-2:])  # the x of an orientation is no position
    words = _words(name)
    for quantity, known in _WORDS.items():
        if known & set(words):
            return "turn" if quantity == "yaw" and "rate" in words else quantity
    return "_".join(words)


def is_asked(name: str) -> bool:
    """Whether the name is that of something which the robot is told, not what it does."""
    return any(_ASKED.fullmatch(word) for word in _all_words(name))


def alike(name: str, candidates: Sequence[str]) -> str:
    """The first candidate that means the same as `name`, or one that is spelled nearly so.

    Empty where there is none. Of what is told, what is told comes first.

    >>> alike("/odom.pose.pose.position.x", ["t", "x", "y"])
    'x'
    """
    wanted = meaning(name)
    same = [known for known in candidates if meaning(known) == wanted]
    if same:
        return min(same, key=lambda known: is_asked(known) != is_asked(name))
    close = get_close_matches(name, candidates, n=1, cutoff=0.7)
    return close[0] if close else ""


def _words(name: str) -> list[str]:
    """Of the name's last part, those that say what it is: `/odom.v_cmd` gives `v`."""
    last = re.split(r"[./]", name)[-1]
    words = [word for word in _all_words(last) if not _ASKED.fullmatch(word)]
    return words or [last]


def _all_words(name: str) -> list[str]:
    """`headingGoal_deg` gives `heading`, `goal`, `deg`."""
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    return [word for word in re.split(r"[^a-z0-9]+", parted) if word]
