"""Chance: each consumer has a generator of its own, so that one more changes no other's numbers."""

from hashlib import blake2b

import numpy as np


def generator(seed: int, what: str, name: str) -> np.random.Generator:
    """The generator of one consumer: Philox, keyed by a digest of the seed and who asks.

    what, name: the kind of the consumer and its full name, such as "sensor" and "r.ahead". The
    same three give the same numbers whenever and wherever they are asked for. Philox is
    counter-based (Salmon et al. 2011): streams of different keys do not overlap.

    >>> generator(7, "node", "r.roam").random() == generator(7, "node", "r.roam").random()
    True
    >>> generator(7, "node", "r.roam").random() == generator(8, "node", "r.roam").random()
    False
    """
    # Lengths keep ("a", "bc") apart from ("ab", "c").
    text = f"{seed}:{len(what)}:{what}:{len(name)}:{name}"
    key = blake2b(text.encode(), digest_size=16).digest()
    return np.random.Generator(np.random.Philox(key=int.from_bytes(key, "little")))
