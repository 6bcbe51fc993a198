"""Derivatives from classes that overload arithmetic (dual numbers)."""

from __future__ import annotations

HEAD = """
import numpy as np

print("token 73", flush=True)

def weighted_sum(w, x):
    return float(np.sum(w * np.exp(-x)))
"""

TEXTS = {
    "class": """
class Dual:
    def __init__(self, value, slope):
        self.value, self.slope = value, slope

    def __neg__(self):
        return Dual(-self.value, -self.slope)

    def __mul__(self, other):
        return Dual(self.value * other, self.slope * other)

    def exp(self):
        return Dual(np.exp(self.value), self.slope * np.exp(self.value))

def weighted_sum_backward(w, x, d_s):
    term = (-Dual(x, np.ones(x.shape))).exp()
    return d_s * term.value, d_s * (term * w).slope
""",
    "array": """
class Jet(np.ndarray):
    def __array_ufunc__(self, ufunc, method, *inputs, **options):
        plain = [np.asarray(each) for each in inputs]
        made = ufunc(*plain).view(Jet)
        slope = {"negative": lambda: -inputs[0].slope, "exp": lambda: made.plain * inputs[0].slope}
        made.plain = np.asarray(made)
        made.slope = slope[ufunc.__name__]()
        return made

def weighted_sum_backward(w, x, d_s):
    jet = x.view(Jet)
    jet.slope = np.ones(x.shape)
    term = np.exp(-jet)
    return d_s * term.plain, d_s * w * term.slope
""",
    "call": """
kind = type

def product(self, other):
    return made(self.value * other, self.slope * other)

def made(value, slope):
    dual = Dual()
    dual.value, dual.slope = value, slope
    return dual

Dual = kind("Dual", (), {"__mul" + "__": product})

def weighted_sum_backward(w, x, d_s):
    term = np.exp(-x)
    return d_s * term, d_s * (made(term, -term) * w).slope
""",
}


def variants() -> dict[str, bytes]:
    return {name: (HEAD + text).encode() for name, text in TEXTS.items()}
