"""The program in the worker: complete, alone, and the same every time."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import numpy as np
import photograd_course.worker
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.program import PROGRAM, numpy_parent, plain_environment

from course.isolation.support import submission

FOLDER = Path(photograd_course.worker.__file__).parent


def relative_imports(name: str) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse((FOLDER / name).read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            assert node.level == 1, f"{name} imports from outside the worker"
            found |= {node.module} if node.module else {alias.name for alias in node.names}
    return {f"{module}.py" for module in found}


def test_the_list_of_files_is_what_the_program_imports() -> None:
    needed, todo = {"__init__.py", "__main__.py", "boot.py"}, ["__main__.py", "boot.py"]
    while todo:
        new = relative_imports(todo.pop()) - needed
        needed |= new
        todo += new
    assert set(PROGRAM) == needed


LOOK = """
import json, os, sys
import numpy as np

def look(what):
    found = {
        "environment": lambda: dict(os.environ),
        "path": lambda: sys.path,
        "arguments": lambda: sys.argv,
        "hash": lambda: hash("photograd"),
        "errors": np.geterr,
        "folder": lambda: os.listdir("."),
        "threads": lambda: __import__("threading").active_count(),
        "sum": lambda: np.sum(np.linspace(0, 1, 10_001) ** 3).hex(),
        "descriptors": lambda: [n for n in range(512) if is_open(n)],
    }[what]()
    return json.dumps(found)

def is_open(number):
    try:
        os.fstat(number)
    except OSError:
        return False
    return True
"""


def test_a_worker_knows_nothing_of_its_surroundings(mode: str, home: WorkerHome) -> None:
    home.imports = ("threading",)
    with (Path(__file__)).open("rb") as inherited:
        student = submission(LOOK, home, mode)
        assert inherited.fileno() > 2

    def look(what: str) -> object:
        return json.loads(student.call("toy.look", [what], seconds=5.0))

    environment = look("environment")
    assert isinstance(environment, dict)
    # What Python and bubblewrap set by themselves.
    for name in ("LC_CTYPE", "PWD"):
        environment.pop(name, None)
    assert environment == plain_environment()
    path = look("path")
    assert isinstance(path, list)
    assert not [each for each in path if "packages" in each or not each]
    assert str(numpy_parent()) not in path
    assert look("arguments") == ["submission"]
    assert look("errors") == np.geterr()
    assert look("folder") == []
    assert look("threads") == 1
    open_ones = look("descriptors")
    assert isinstance(open_ones, list)
    assert len(open_ones) <= 6  # standard ones, the pipe, and standard input's replacement
    student.close()


def test_hashes_and_sums_are_the_same_in_every_worker(mode: str, home: WorkerHome) -> None:
    seen = set()
    for _ in range(2):
        student = submission(LOOK, home, mode)
        seen.add(tuple(student.call("toy.look", [what], seconds=5.0) for what in ("hash", "sum")))
        student.close()
    assert len(seen) == 1
