"""A refused import costs what uses it: what a module makes of one loads, and fails when used."""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest
from photograd_course.grading.failures import StudentFailure
from photograd_course.grading.remote import USES_REFUSED, Hand, RemoteStudent
from photograd_course.worker.process import WorkerProcess, install_program, plain_command
from photograd_course.worker.screen import PURE, forbidden_imports, without_forbidden

HEAD = """
import numpy as np
import os.path, math as m, sys as s
from collections import deque
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache
from typing import NamedTuple
from numba import njit, prange as each
from torch import *
try:
    import cupy
except ImportError:
    cupy = None
try:
    import cupy as near
finally:
    far = 1.0

EPS = -s.float_info.epsilon / 2
TABLE = np.arange(3.0)
if far:
    import random


class Module(njit.Module):
    pass


@dataclass(frozen=True)
class Pair:
    x: float
    y: float = 0.0


class Axis(IntEnum):
    X = 0


class Named(NamedTuple):
    x: float


@lru_cache
def same(x):
    return x


@njit(fast=True)
def quick(x):
    return x
"""
USES = {
    "a call": "os.path.join('a', 'b')",
    "an attribute": "s.path",
    "a decorated function": "quick(x)",
    "a constant made of one": "x * EPS",
    "a constant of arrays": "TABLE * EPS",
    "a function of NumPy": "np.exp(EPS)",
    "a class": "Module()(x)",
    "a loop": "[k for k in each]",
    "a condition": "1 if s else 2",
    "a comparison": "s == 3",
    "an import in a function": "inner(x)",
    "an import in a branch": "random.random()",
    "without a handler of its own": "near.array(x)",
}
RIGHT = {
    "the handler for a missing module": "x if cupy is None else 0.0",
    "what is allowed beside it": "m.sqrt(x) + len(deque([far]))",
    "what does not use it": "x",
    "what pure modules make": "same(Named(Pair(x).x)[Axis.X])",
}


def functions() -> str:
    """A function for each use."""
    lines = ["def inner(x):\n    import ctypes\n    return ctypes.c_int(3)\n"]
    for k, use in enumerate([*USES.values(), *RIGHT.values()]):
        lines.append(f"def f{k}(x):\n    return {use}\n")
    return HEAD + "\n\n".join(lines)


@pytest.fixture(scope="module")
def student(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RemoteStudent]:
    folder = tmp_path_factory.mktemp("worker")
    command = plain_command(install_program(folder))
    worker = WorkerProcess(command, environment={}, cwd=folder)
    worker.request("start", {}, seconds=60.0)
    opened = RemoteStudent(worker, Hand({"m": functions()}, ("m",), ("numpy",)))
    yield opened
    opened.close()


@pytest.mark.parametrize("use", USES)
def test_what_uses_a_refused_import_fails(student: RemoteStudent, use: str) -> None:
    with pytest.raises(StudentFailure) as caught:
        student.call(f"m.f{list(USES).index(use)}", [4.0], seconds=10.0)
    assert caught.value.reason == "forbidden"
    assert caught.value.text == f"f{list(USES).index(use)} {USES_REFUSED}"
    assert "m.py, line" in caught.value.private


@pytest.mark.parametrize("use", RIGHT)
def test_what_does_not_use_one_works(student: RemoteStudent, use: str) -> None:
    k = len(USES) + list(RIGHT).index(use)
    assert student.call(f"m.f{k}", [4.0], seconds=10.0) in (3.0, 4.0)


def test_each_import_is_named_with_its_line(student: RemoteStudent) -> None:
    lines = functions().splitlines()
    assert len(student.refused) == 5  # more are not said
    for said in student.refused:
        place, module = said.split("; ")[0].split(": imports ")
        assert module.partition(".")[0] in lines[int(place.rpartition(" ")[2]) - 1]


def test_pure_modules_may_be_imported_everywhere() -> None:
    text = "\n".join(f"import {name}\nfrom {name} import x" for name in PURE - {"__future__"})
    assert forbidden_imports("m", text, (), ()) == []
    named = {"dataclasses", "functools", "itertools", "operator", "collections", "enum", "math"}
    assert named | {"typing"} <= PURE


def test_a_module_without_refused_imports_stays_as_it_is() -> None:
    text = functions().replace(HEAD, "import numpy as np\nfrom . import a\n").replace("ctypes", "m")
    tree, found = without_forbidden("m", text, ("numpy", "", "m"), ())
    assert found == []
    assert ast.dump(tree) == ast.dump(ast.parse(text))
