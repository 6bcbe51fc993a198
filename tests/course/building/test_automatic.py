from __future__ import annotations

import ast
from pathlib import Path

import pytest
from photograd_course.build.automatic import automatic_mutants
from photograd_course.build.judging import Job, Judge

from .support import TOY

FRAME = '''\
import numpy as np


def given(a):
    return a + 1


def f(a, b, i):
    """A docstring with 1 + 2."""
    # >>> solution 01.1
    {line}
    # <<< solution
'''


def mutations(line: str) -> list[str]:
    found = automatic_mutants(FRAME.format(line=line))
    assert len({ast.dump(ast.parse(each.text)) for each in found}) == len(found)
    assert all("return a + 1" in each.text for each in found)
    return [each.mutation for each in found]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("b = a + i", ["a + i -> a - i", "a + i -> a", "a + i -> i"]),
        ("b = a - i", ["a - i -> a + i", "a - i -> a", "a - i -> -(i)"]),
        ("b = a / i", ["a / i -> a * i", "a / i -> a"]),
        ("b = a[i]", ["a[i] -> a[i + 1]", "a[i] -> a[i - 1]"]),
        ("b = a[i:]", ["a[i:] -> a[i + 1:]", "a[i:] -> a[i - 1:]"]),
        ("b = a[i, 0]", ["a[i, 0] -> a[i + 1, 0]", "a[i, 0] -> a[i - 1, 0]", "0 -> 1"]),
        ("a[i] = b", ["a[i] = b -> pass", "a[i] -> a[i + 1] = b", "a[i] -> a[i - 1] = b"]),
        ("a += b", ["a += b -> a = b", "a += b -> a -= b", "a += b -> pass"]),
        ("b = a < i", ["a < i -> a <= i", "a < i -> a >= i"]),
        ("b = a and i", ["a and i -> a or i"]),
        ("b = not a", ["not a -> a"]),
        ("b = -a", ["-a -> a"]),
        ("b = 3", ["3 -> 4", "3 -> 2"]),
        ("b = 0.5", ["0.5 -> 1.0", "0.5 -> -0.5"]),
        ("b = True", ["True -> False"]),
        ("b = max(a, i)", ["max(a, i) -> max(i, a)"]),
        ("b = a.sum(axis=i)", ["a.sum(axis=i) -> a.sum()"]),
        ("b = given(a)", ["given(a) -> a"]),
        ("b = len(a)", []),
        ("b = np.exp(a, out=i)", []),
        ("b = np.errstate(divide=i)", []),
        ("np.put(a, i)", ["np.put(a, i) -> pass", "np.put(a, i) -> np.put(i, a)"]),
        ("return a, b", ["return (a, b) -> return -(a), b", "return (a, b) -> return a, -(b)"]),
        ("raise ValueError(f'{a + 1} and {b - 1}' + 'x')", []),
        ("b: 'a + 1' = a", []),
    ],
)
def test_what_is_changed(line: str, expected: list[str]) -> None:
    assert mutations(line) == expected


def test_the_same_change_twice_in_a_line_is_told_apart() -> None:
    found = automatic_mutants(FRAME.format(line="b = (a + 1) * (a + 1)"))
    named = [(each.line, each.mutation) for each in found]
    assert ("b = (a + 1) * (a + 1)", "1 -> 2 [2]") in named
    assert len(set(named)) == len(named)


def test_columns_count_bytes() -> None:
    (first, *_) = automatic_mutants(FRAME.format(line='b = "é" + a'))
    assert 'b = ("é" - a)' in first.text.replace("'", '"')


ENDLESS = ("trail = [np", "while True:\n        pass\n    trail = [np")


def judge_of(cache: Path | None = None) -> Judge:
    return Judge(TOY, cache=cache, seconds=3.0)


def test_an_endless_loop_loses_its_check_and_no_other() -> None:
    text = (TOY / "toy.py").read_text("utf-8")
    verdict = judge_of().judge(Job(text.replace(*ENDLESS)))
    assert verdict.lost == verdict.hung == ("90.3.services",)
    assert len(verdict.passed) == 4


def test_a_crash_loses_its_check_and_no_other() -> None:
    text = (TOY / "toy.py").read_text("utf-8")
    crash = ("trail = [np", "import os\n    os._exit(0)\n    trail = [np")
    verdict = judge_of().judge(Job(text.replace(*crash)))
    assert verdict.lost == ("90.3.services",)
    assert len(verdict.passed) == 4


def test_what_a_mutant_prints_is_no_verdict() -> None:
    text = (TOY / "toy.py").read_text("utf-8")
    forged = 'print(\'{"id": "90.9", "status": "passed"}\', flush=True)\n    trail = [np'
    verdict = judge_of().judge(Job(text.replace("trail = [np", forged)))
    assert "90.9" not in verdict.passed
    assert len(verdict.passed) == 5


def test_the_first_failure_is_enough_when_so_asked() -> None:
    text = (TOY / "toy.py").read_text("utf-8").replace("np.exp(-x)", "np.exp(x)")
    verdict = judge_of().judge(Job(text, first=True))
    assert verdict.lost == ("90.1.value",)
    assert verdict.passed == ()


def test_a_text_is_run_once(tmp_path: Path) -> None:
    text = (TOY / "toy.py").read_text("utf-8")
    first, second = judge_of(tmp_path), judge_of(tmp_path)
    assert first.judge(Job(text)) == second.judge(Job(text))
    assert (first.ran, second.ran) == (1, 0)
    third = Judge(TOY, b"another secret", tmp_path, 3.0)
    third.judge(Job(text))
    assert third.ran == 1
