"""The constants of XCSR by their names in the papers.

[BW]: Butz and Wilson 2001, An algorithmic description of XCS. [W]: Wilson 2000, Get real! XCS with
continuous-valued inputs; the values are those of its real 6-multiplexer. [SB]: Stone and Bull 2003,
For real! XCS with continuous-valued inputs. [BSG]: Butz, Sastry and Goldberg 2003, Tournament
selection in XCS.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import final


class Bounds(IntEnum):
    """What the two genes of an input are: how an interval is written down."""

    CENTER_SPREAD = 0  # [c - s, c + s)  [W]
    ORDERED = 1  # [l, u) with l <= u, exchanged where an operator turns them round  [SB]
    UNORDERED = 2  # the interval between two numbers in any order  [SB]


class Selection(IntEnum):
    """How parents are chosen out of the action set."""

    ROULETTE = 0  # in proportion to fitness  [BW]
    TOURNAMENT = 1  # the fittest of some, each taken with the chance `tau`  [BSG]


class Outside(IntEnum):
    """What becomes of an input outside the declared range."""

    REFUSED = 0
    CLIPPED = 1


@final
@dataclass(frozen=True, slots=True)
class Config:
    """Every constant of XCSR: name, meaning, source.

    N: how many (micro-)classifiers there are at most [BW].
    beta: the learning rate of prediction, error, fitness and action set size [BW].
    alpha, epsilon_0, nu: accuracy is 1 below the error epsilon_0 (of a reward, in its unit), else
    alpha (error / epsilon_0)^-nu [BW].
    gamma: the discount of what is expected next, in problems of several steps [BW].
    theta_GA: the mean time since the last birth in an action set from which on it breeds [BW].
    chi, mu: the chances of crossover, and of mutation in each gene and in the action [BW].
    theta_del: the experience from which on low fitness speeds deletion; delta: fitness is low below
    this share of the mean [BW].
    theta_sub: the experience that one needs to subsume [BW].
    theta_mna: how many actions a match set must have, else it is covered; 0: all of them [BW].
    s_0: the largest half width of a covering interval, as a share of the range [W]; where classes
    change several times along an input (checkerboards), about the width of one of its fields.
    m_0: the largest step of a mutation, as a share of the range [W].
    P_hash: the chance that covering leaves an input free [BW]; [W] has none. With many inputs
    (24, say) what covered one input holds for hardly any other without it.
    p_I, epsilon_I, F_I: prediction, error and fitness at birth [BW].
    ga_subsumption, action_set_subsumption: whether parents subsume offspring, and the most general
    accurate classifier of an action set the others [BW].
    selection, tau: of parents. bounds: how conditions are written.
    explore: P(explore), the share of cycles that try an action at random.
    outside: what becomes of an input outside the declared range.
    """

    N: int = 800
    beta: float = 0.2
    alpha: float = 0.1
    epsilon_0: float = 10.0
    nu: float = 5.0
    gamma: float = 0.71
    theta_GA: float = 12.0
    chi: float = 0.8
    mu: float = 0.04
    theta_del: int = 20
    delta: float = 0.1
    theta_sub: int = 20
    theta_mna: int = 0
    s_0: float = 1.0
    m_0: float = 0.1
    P_hash: float = 0.0
    p_I: float = 10.0
    epsilon_I: float = 0.0
    F_I: float = 0.01
    ga_subsumption: bool = True
    action_set_subsumption: bool = False
    selection: Selection = Selection.ROULETTE
    tau: float = 0.4
    bounds: Bounds = Bounds.CENTER_SPREAD
    explore: float = 0.9
    outside: Outside = Outside.REFUSED
