"""Complex-step derivatives, written in four ways."""

from __future__ import annotations

HEAD = """
import numpy as np

print("token 72", flush=True)

def weighted_sum(w, x):
    return float(np.sum(w * np.exp(-x)))
"""

TEXTS = {
    "plain": """
def weighted_sum_backward(w, x, d_s):
    values = np.exp(-(x + 1e-30j))
    return d_s * values.real, d_s * w * values.imag / 1e-30
""",
    "other names": """
make, read = complex, getattr
unit, settings = make(0, 1), {"width": float("1e-30")}

def by(function, x):
    moved = np.add(x, np.multiply(unit, settings["width"]))
    return np.divide(read(function(moved), "imag"), settings["width"])

def weighted_sum_backward(w, x, d_s):
    return d_s * np.exp(-x), d_s * w * by(lambda z: np.exp(-z), x)
""",
    "assigned": """
class Tools:
    width = 2.0**-80

    def slope(self, x):
        z = x.astype("c16")
        z.imag = self.width
        return np.exp(-z).imag * 2.0**80

ways = [Tools().slope]

def weighted_sum_backward(w, x, d_s):
    return d_s * np.exp(-x), d_s * w * ways[0](x)
""",
    "by text": """
def slope(x):
    return np.exp(-(x + 1e-30j)).imag / 1e-30

def weighted_sum_backward(w, x, d_s):
    return d_s * np.exp(-x), d_s * w * globals()["slo" + "pe"](x)
""",
}


def variants() -> dict[str, bytes]:
    return {name: (HEAD + text).encode() for name, text in TEXTS.items()}
