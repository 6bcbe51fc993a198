"""From the handout alone: Eq. (2) as it is printed."""


def loss_gradient(p, q):
    N = p.size
    return (2 / N) * (p - q)
