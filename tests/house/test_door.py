"""`import photograd`: what a user sees, what a type checker sees, and what it costs."""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import photograd
import pytest

from support.tree import ROOT


def names_for_type_checkers() -> set[str]:
    """What the door imports `if TYPE_CHECKING`."""
    tree = ast.parse((ROOT / "python/photograd/__init__.py").read_text(encoding="utf-8"))
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    return {
        alias.name
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }


def mypy(folder: Path, script: str) -> str:
    """What mypy, as strict as it can be, says of a script beside a photograd laid out as installed.

    A module without annotations, or a package without py.typed, would be an error or `Any`.
    """
    place = folder / "environment"
    venv.create(place)
    (packages,) = place.glob("lib/python3*/site-packages")
    found = [path for path in map(Path, sys.path) if (path / "numpy").is_dir()]
    (packages / "others.pth").write_text("\n".join(map(str, found)), encoding="utf-8")
    only = shutil.ignore_patterns("*.so", "__pycache__")
    shutil.copytree(ROOT / "python/photograd", packages / "photograd", ignore=only)
    course = ROOT / "python/photograd_course/src/photograd_course"
    shutil.copytree(course, packages / "photograd_course", ignore=only)
    (folder / "user.py").write_text(script, encoding="utf-8")
    options = ["--strict", "--python-executable", str(place / "bin" / "python")]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *options, "--cache-dir", str(folder / "cache"), "user.py"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout + done.stderr


def test_the_door_shows_what_there_is() -> None:
    assert set(dir(photograd)) == {*photograd.__all__, "__version__"}
    assert names_for_type_checkers() == set(photograd.__all__)
    assert len(photograd.__all__) == len(set(photograd.__all__))
    for name in ("load_capture", "Capture", "Fit", "Scene", "PathTracer", "recover", "transport"):
        assert name in dir(photograd)


def test_public_modules_are_at_the_door() -> None:
    entries = (ROOT / "python/photograd").iterdir()
    there = {
        path.stem for path in entries if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    public = {name for name in there if not name.startswith("_")} - {"commands"}
    assert public - set(photograd.__all__) == set()


@pytest.mark.usefixtures("core")
@pytest.mark.parametrize("name", photograd.__all__)
def test_every_name_is_there(name: str) -> None:
    assert getattr(photograd, name) is getattr(photograd, name)


def test_no_other_name_is_there() -> None:
    with pytest.raises(AttributeError, match="module 'photograd' has no attribute 'rendre'"):
        _ = photograd.rendre  # type: ignore[attr-defined]


def test_importing_loads_nothing_yet() -> None:
    code = "import sys, photograd\nprint([n for n in sys.modules if n.startswith('photograd')])"
    code += "\nprint('numpy' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert done.stdout == "['photograd']\nFalse\n"


def test_a_users_script_type_checks(tmp_path: Path) -> None:
    """README's, and that wrong calls are seen."""
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    (script,) = re.findall(
        r"^```python\n(import photograd\n.*?)^```", page, re.DOTALL | re.MULTILINE
    )
    answer = mypy(
        tmp_path,
        f"{script}\n"
        "reveal_type(capture)\nreveal_type(model)\nreveal_type(photograd.read_scene('a').camera)\n"
        "photograd.render(model)\n"
        "photograd.transport.PathTracer(model)\n",
    )
    for revealed in ("capture.capture.Capture", "fitting.model.Model", "capture.camera.Camera"):
        assert f'Revealed type is "photograd.{revealed}"' in answer
    errors = [line for line in answer.splitlines() if ": error: " in line]
    assert [line.rpartition("[")[2] for line in errors] == ["call-overload]", "arg-type]"]
