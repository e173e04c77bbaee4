"""The competition of activations, compiled: small steps of Euler and Maruyama."""

from runtime.arrays import Array
from runtime.kernels.cache import kernel


@kernel
def compete(
    u: Array, advantage: Array, suppression: Array, kicks: Array, share: float, noise: float
) -> None:
    """Let the activations u (k,) compete for as many steps as there are rows of `kicks` (s, k).

    share: length of a step in time scales. noise: standard deviation that one step adds.
    suppression: (k, k), row j, column i: how strongly j suppresses i.
    """
    k = u.shape[0]
    for s in range(kicks.shape[0]):
        # All activations move together: the sums are those before the step.
        for i in range(k):
            pressure = 0.0
            for j in range(k):
                if j != i:
                    pressure += suppression[j, i] * u[j] * u[j]
            rate = advantage[i] * u[i] - abs(advantage[i]) * u[i] ** 3 - pressure * u[i]
            kicks[s, i] = share * rate + noise * kicks[s, i]
        for i in range(k):
            u[i] += kicks[s, i]
