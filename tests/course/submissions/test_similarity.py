"""Copies surface under new names and in a new order; the starter and idioms do not count."""

from __future__ import annotations

import numpy as np
from photograd_course.submissions.similarity import (
    FEWEST_SHARED,
    fingerprints,
    normalized,
    similar_pairs,
)

ONE = '''
def descend(gradient, x0, tau, n):
    """Steps."""
    trail = [x0.copy()]
    for k in range(n):
        slope = gradient(trail[-1])
        if abs(slope).max() < 1e-12:
            trail.append(trail[-1].copy())
            continue
        trail.append(trail[-1] - tau * slope / (1 + 0.5 * k))
    return sum(trail) / len(trail)


def smooth(values, width):
    total = 0.0
    out = []
    while len(out) < len(values):
        lo, hi = max(0, len(out) - width), min(len(values), len(out) + width)
        out.append(sum(values[lo:hi]) / (hi - lo) + total * 0)
    return out
'''
TWO = """
import numpy as np


def descend(gradient, x0, tau, n):
    points = np.empty((n + 1, x0.size))
    points[0] = x0
    for i in range(1, n + 1):
        points[i] = points[i - 1] - tau * gradient(points[i - 1])
    return points


def smooth(values, width):
    kernel = np.ones(width) / width
    return np.convolve(np.asarray(values), kernel, mode="same")
"""


def disguised(text: str) -> str:
    """Renamed, reordered, padded with comments, other numbers and docstrings."""
    for old, new in (
        ("trail", "path"),
        ("slope", "g"),
        ("total", "acc"),
        ("out", "res"),
        ("1e-12", "3e-9"),
        ('"""Steps."""', '"""Mine."""'),
    ):
        text = text.replace(old, new)
    first, second = text.split("\n\n\n")
    lines = f"{second}\n\n\n{first}".splitlines()
    return "\n".join(f"{line}  # my own work" if line.strip() else line for line in lines)


def test_a_disguised_copy_surfaces() -> None:
    pairs = similar_pairs({"Ada": ONE, "Bo": disguised(ONE), "Cy": TWO})
    assert [(one, two) for one, two, _ in pairs] == [("Ada", "Bo")]
    assert pairs[0][2] > 0.8


def laboured(text: str) -> str:
    """A statement that does nothing after every other, and functions for operators."""
    for old, new in (
        (
            "trail[-1] - tau * slope / (1 + 0.5 * k)",
            "np.subtract(trail[-1], np.divide(np.multiply(tau, slope), "
            "np.add(1, np.multiply(0.5, k))))",
        ),
        ("sum(trail) / len(trail)", "np.divide(sum(trail), len(trail))"),
        (
            "sum(values[lo:hi]) / (hi - lo) + total * 0",
            "np.add(np.divide(sum(values[lo:hi]), np.subtract(hi, lo)), np.multiply(total, 0))",
        ),
    ):
        assert old in text
        text = text.replace(old, new)
    idle = ("pass", "_ = 0", "0", "...; None")
    lines = []
    for k, line in enumerate(text.splitlines()):
        lines.append(line)
        if line.strip() and not line.endswith(":"):
            lines.append(line[: len(line) - len(line.lstrip())] + idle[k % len(idle)])
    return "\n".join(lines)


def test_idle_statements_and_functions_for_operators_hide_nothing() -> None:
    copy = laboured(ONE)
    compile(copy, "copy.py", "exec")
    assert fingerprints(copy) == fingerprints(ONE)
    assert similar_pairs({"Ada": ONE, "Bo": copy, "Cy": TWO}) == [("Ada", "Bo", 1.0)]


def test_a_few_lines_are_too_little_to_compare() -> None:
    short = "def mean(values):\n    return float(np.sum(values[:-1] * 2.0)) / len(values)\n"
    assert 0 < len(fingerprints(short)) < FEWEST_SHARED
    assert similar_pairs({"Ada": short, "Bo": short}) == []


def test_what_the_starter_holds_does_not_count() -> None:
    assert similar_pairs({"Ada": ONE, "Bo": ONE}, starter=ONE) == []


def test_what_most_have_in_common_does_not_count() -> None:
    rng = np.random.default_rng(5)
    words = ["a", "3", "+", "-", "*", "/", "**", "//", "%", "<", ">", "not", "[", "]", "and", "or"]
    common = {f"s{k}": ONE + " ".join(rng.choice(words, 200)) for k in range(9)}
    assert similar_pairs(common) == []
    assert len(similar_pairs(dict(list(common.items())[:3]))) == 3  # too few to tell


def test_text_that_is_no_program_is_no_error() -> None:
    assert fingerprints("def (((\n") == set()
    assert normalized("'''open") == []
    assert similar_pairs({"a": "", "b": ""}) == []
