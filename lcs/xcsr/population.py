"""The classifiers of one learner, with room for N of them."""

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from lcs.arrays import Array, Integers
from lcs.faults import LearnerError
from lcs.state import Arrays, arrays_of, filled
from lcs.xcsr.config import Config
from lcs.xcsr.kernels.layout import LINES, ROOM_BESIDES, Classifiers, Numbers, Scratch, Space

KEPT: Final = ("classifiers", "scratch")
"""What is saved; the rest is made anew from the config and the range."""


@final
@dataclass(slots=True)
class Population:
    """All that a learner knows; kernels change the arrays in place."""

    classifiers: Classifiers
    space: Space
    numbers: Numbers
    scratch: Scratch


def all_arrays(population: Population) -> Arrays:
    """Copies of the arrays that change, by name."""
    parts = {name: getattr(population, name) for name in KEPT}
    return {key: each for name in KEPT for key, each in arrays_of(name, parts[name]).items()}


def restored(population: Population, arrays: Arrays) -> Population:
    """What `all_arrays` were of; the population is of the same config.

    Raises:
        LearnerError: an array is missing or of another type or shape, or names what is not there.
    """
    parts = {name: filled(name, getattr(population, name), arrays) for name in KEPT}
    for name in KEPT:
        for mine, theirs in zip(getattr(population, name), parts[name], strict=True):
            if mine.shape != theirs.shape:
                raise LearnerError(f"an array of '{name}' is {theirs.shape}, and not {mine.shape}")
    whole = replace(population, **parts)
    them, scratch = whole.classifiers, whole.scratch
    lines = them.counts[LINES]
    if not 0 <= lines <= them.action.size or _is_unknown(them.action, scratch.votes.size):
        raise LearnerError("there are more classifiers than room, or unknown actions")
    for members, size in zip(scratch.sets, scratch.sizes, strict=True):
        if not 0 <= size <= lines or _is_unknown(members[:size], lines):
            raise LearnerError("a set names classifiers that are not there")
    return whole


def _is_unknown(named: Integers, count: int) -> bool:
    return bool(np.any((named < 0) | (named >= count)))


def empty(actions: int, config: Config, low: Array, high: Array) -> Population:
    """Nobody yet; the range of inputs is low to high, (n,)."""
    n, room = low.size, config.N + ROOM_BESIDES
    them = Classifiers(
        counts=np.zeros(5, np.int64),
        first=np.zeros((n, room)),
        second=np.zeros((n, room)),
        lower=np.zeros((n, room)),
        upper=np.zeros((n, room)),
        action=np.zeros(room, np.int64),
        prediction=np.zeros(room),
        error=np.zeros(room),
        fitness=np.zeros(room),
        numerosity=np.zeros(room, np.int64),
        experience=np.zeros(room, np.int64),
        set_size=np.zeros(room),
        born=np.zeros(room, np.int64),
        right=np.zeros(room, np.int64),
        wrong=np.zeros(room, np.int64),
    )
    return Population(them, Space(low, high), numbers_of(config), scratch_of(actions, n, room))


def scratch_of(actions: int, n: int, room: int) -> Scratch:
    """Room to work in."""
    return Scratch(
        sets=np.zeros((2, room), np.int64),
        sizes=np.zeros(2, np.int64),
        holds=np.zeros(room, np.int64),
        shares=np.zeros(room),
        votes=np.zeros(actions),
        totals=np.zeros(actions),
        actions=np.zeros(actions, np.int64),
        first=np.zeros((2, n)),
        second=np.zeros((2, n)),
    )


def numbers_of(config: Config) -> Numbers:
    """The constants for kernels."""
    return Numbers(
        most=config.N,
        beta=config.beta,
        alpha=config.alpha,
        epsilon_0=config.epsilon_0,
        nu=config.nu,
        gamma=config.gamma,
        theta_ga=config.theta_GA,
        chi=config.chi,
        mu=config.mu,
        theta_del=config.theta_del,
        delta=config.delta,
        theta_sub=config.theta_sub,
        theta_mna=config.theta_mna,
        s_0=config.s_0,
        m_0=config.m_0,
        p_hash=config.P_hash,
        prediction=config.p_I,
        error=config.epsilon_I,
        fitness=config.F_I,
        ga_subsumption=config.ga_subsumption,
        action_set_subsumption=config.action_set_subsumption,
        selection=int(config.selection),
        tau=config.tau,
        bounds=int(config.bounds),
        explore=config.explore,
    )
