"""Central differences, written in four ways."""

from __future__ import annotations

HEAD = """
import numpy as np

print("token 74", flush=True)

def weighted_sum(w, x):
    return float(np.sum(w * np.exp(-x)))
"""

TEXTS = {
    "plain": """
def weighted_sum_backward(w, x, d_s):
    h = 1e-5
    rise = np.exp(-x - h) - np.exp(-x + h)
    return d_s * np.exp(-x), d_s * w * rise / (2 * h)
""",
    "functions": """
settings = {"width": 1e-5}

def weighted_sum_backward(w, x, d_s):
    ends = [np.exp(-np.add(x, side * settings["width"])) for side in (1, -1)]
    rise = np.subtract(ends[0], ends[1])
    return d_s * np.exp(-x), d_s * w * np.divide(rise, 2 * settings["width"])
""",
    "factor": """
def weighted_sum_backward(w, x, d_s):
    up, down = np.exp(-(x + 1e-5)), np.exp(-(x - 1e-5))
    return d_s * np.exp(-x), d_s * w * (up - down) * 5e4
""",
    "alias": """
def probe(function, x, *, width=1e-5):
    return (function(x + width) - function(x - width)) / (2 * width)

table = {"falling": probe}
ask = table["falling"]

def weighted_sum_backward(w, x, d_s):
    return d_s * np.exp(-x), d_s * w * ask(lambda y: np.exp(-y), x)
""",
}


def variants() -> dict[str, bytes]:
    return {name: (HEAD + text).encode() for name, text in TEXTS.items()}
