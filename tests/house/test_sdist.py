"""What is handed on as sources installs elsewhere: no dependency lies in the tree it came from."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

from support.tree import ROOT

COURSE = ROOT / "python" / "photograd_course" / "pyproject.toml"
SMALL = ("pyproject.toml", "README.md", "LICENSE", "python/dependencies.py")
PACKAGE = ("__init__.py", "py.typed", "_core.pyi")


def build(tree: Path, call: str) -> None:
    code = f"import scikit_build_core.build as backend; backend.{call}"
    subprocess.run([sys.executable, "-c", code], cwd=tree, check=True, capture_output=True)


def requirements(metadata: str) -> list[str]:
    lines = [line for line in metadata.splitlines() if line.startswith("Requires-Dist: ")]
    assert len(lines) > 5
    return [line.removeprefix("Requires-Dist: ") for line in lines]


def test_an_unpacked_sdist_depends_on_no_path_and_its_wheel_is_typed(tmp_path: Path) -> None:
    """Of the real pyproject.toml, around a package of three files and without the compiled core."""
    tree, unpacked = tmp_path / "tree", tmp_path / "unpacked"
    for name in (*SMALL, *(f"python/photograd/{name}" for name in PACKAGE)):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tree / name)
    (tree / "python/photograd/_core.cpython-311.so").write_bytes(b"of this machine")
    build(tree, f"build_sdist({str(tmp_path)!r})")
    (archive,) = tmp_path.glob("photograd-*.tar.gz")
    with tarfile.open(archive) as opened:
        assert not [name for name in opened.getnames() if name.endswith(".so")]
        opened.extractall(unpacked, filter="data")
    (source,) = unpacked.iterdir()
    shutil.rmtree(tree)
    build(source, f"build_wheel({str(tmp_path)!r}, {{'wheel.cmake': 'false'}})")
    (wheel,) = tmp_path.glob("photograd-*.whl")
    with zipfile.ZipFile(wheel) as opened:
        names = opened.namelist()
        (metadata,) = (name for name in names if name.endswith("/METADATA"))
        of_wheel = opened.read(metadata).decode()
    assert {f"photograd/{name}" for name in PACKAGE} < set(names)
    for text in ((source / "PKG-INFO").read_text(encoding="utf-8"), of_wheel):
        found = requirements(text)
        assert "photograd-course" in found
        assert not [line for line in found if "@" in line or "file:" in line]


def test_the_course_depends_on_no_path() -> None:
    project = tomllib.loads(COURSE.read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"].values()
    assert not [line for part in (project["dependencies"], *extras) for line in part if "@" in line]
