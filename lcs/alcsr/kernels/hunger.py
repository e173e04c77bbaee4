"""Who was not fed for too long, and for whom it is time to grow."""

from lcs.alcsr.kernels.feeding import remove
from lcs.alcsr.kernels.layout import STARVED, Land, Numbers, Rules, Scratch
from lcs.compiled import part


@part
def starve_hungry(rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, a: int) -> None:
    """One rule is looked at in turn: it dies if it was not fed for too long."""
    if rules.living[a] == 0:
        return
    k = land.met[a] % rules.living[a]
    if land.met[a] - rules.fed_at[a, k] > numbers.hunger:
        scratch.dead[k] = True
        scratch.tally[STARVED] += 1
        remove(rules, scratch, a)


@part
def needs_tending(rules: Rules, land: Land, numbers: Numbers, scratch: Scratch, a: int) -> bool:
    """Whether a body of landscape a is to grow, or a season ends."""
    if numbers.remembers == 0:
        return False
    if land.met[a] >= land.season[a]:
        return True
    return numbers.grows == 1 and due_to_grow(rules, scratch, a) >= 0


@part
def due_to_grow(rules: Rules, scratch: Scratch, a: int) -> int:
    """The last of those fed that has eaten enough since it grew, or -1."""
    due = -1
    for k in scratch.fed[a, : scratch.fed_count[a]]:
        if rules.right[a, k] + rules.wrong[a, k] >= rules.grows_at[a, k]:
            due = k
    return due
