"""Helpers for the hidden checks of several tasks."""

from ..common import on_points


def bowls(t, n):
    """A quadratic, its gradient and a start; of n variables, or of one."""
    a = t.rng.uniform(0.5, 2.0, max(n, 1))
    f, grad = lambda x: float(0.5 * x @ (a * x)), lambda x: a * x
    return *on_points(len(a), f, grad), t.rng.uniform(1.0, 2.0, len(a))


FAR = {"sizes": (0, 1, 2), "large": 300}  # steps: none, and more than any example takes


MANY = 320  # steps, more than any other call takes


def asked_once_a_step(t, function, gradient, call):
    """The gradient is asked for once in each of many steps, as the text has it.

    Args:
        t: the trial.
        function: its name, for the sentence.
        gradient: of what is minimized.
        call: calls the function for `MANY` steps, with this gradient.
    """
    asked = []

    def counted(x):
        asked.append(x)
        return gradient(x)

    call(counted)
    said = f"{function}: asks for {len(asked)} derivatives in {MANY} steps; one a step is enough"
    t.require(len(asked) == MANY, said)


def rate(n):
    """A learning rate with which n steps go far, and do not arrive."""
    return 3.0 / (n + 10)
