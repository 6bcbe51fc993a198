"""The Gradescope zip in what Gradescope gives it: its Pythons, 768 MB, half a processor."""

from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from photograd_course.assignment.manifest import read_manifest
from photograd_course.build.course_files import build_of
from photograd_course.build.gradescope import constraints, gradescope_zip
from photograd_course.build.products import sealed

from support.missing import missing
from support.tree import ROOT

from .support import SECRET

ASSIGNMENTS = sorted(path.parent for path in (ROOT / "assignments").glob("*/assignment.toml"))
VERSIONS = ("3.10", "3.11", "3.12", "3.13")
MEMORY, HALF = 768 << 20, 50_000  # bytes; microseconds of each 100,000
CONTROL = Path("/sys/fs/cgroup")


def interpreter(version: str) -> Path:
    """Of this version, with the module venv."""
    found = shutil.which(f"python{version}")
    places = sorted((Path.home() / ".pyenv" / "versions").glob(f"{version}.*/bin/python{version}"))
    for place in [*places, *([Path(found)] if found else [])]:
        command = [str(place), "-c", "import ensurepip, venv"]
        if subprocess.run(command, capture_output=True, check=False).returncode == 0:
            break
    else:
        missing(f"Python {version} is not here", by_choice=True)
    return place


def unpacked(folder: Path, scaffold: Path, cache: Path) -> Path:
    """The zip where Gradescope puts it, and a submission beside it."""
    build = build_of(scaffold, secret=SECRET, cache=cache)
    source = folder / "source"
    data = gradescope_zip(build.manifest.id, sealed(build), SECRET)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        archive.extractall(source)
    (folder / "submission").mkdir()
    (folder / "results").mkdir()
    shutil.copyfile(scaffold / "light.py", folder / "submission" / "light.py")
    return source


def run_script(path: Path, folder: Path, python: Path) -> subprocess.CompletedProcess[str]:
    """A script of the zip, where `python3` is the interpreter of a container."""
    tools = folder / "bin"
    tools.mkdir(exist_ok=True)
    if not (tools / "python3").exists():
        (tools / "python3").symlink_to(python)
    environment = {
        "PATH": f"{tools}:/usr/sbin:/usr/bin:/sbin:/bin",
        "HOME": os.environ.get("HOME", "/root"),
        "PHOTOGRAD_HOME": str(folder / "home"),
        "AUTOGRADER": str(folder),
        **{name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")},
        **{name: value for name, value in os.environ.items() if name.startswith(("PIP_", "SSL_"))},
    }
    command = ["bash", str(path)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.exhaustive
@pytest.mark.parametrize("version", VERSIONS)
def test_a_container_of_each_python(
    version: str, scaffold: Path, cache: Path, tmp_path: Path
) -> None:
    if os.geteuid() or shutil.which("apt-get") is None:
        missing("a container's root, with apt-get", by_choice=True)
    python = interpreter(version)
    source = unpacked(tmp_path, scaffold, cache)
    made = run_script(source / "setup.sh", tmp_path, python)
    assert made.returncode == 0, made.stdout[-3000:] + made.stderr[-3000:]
    assert "isolation C (another user): works" in made.stdout
    graded = run_script(source / "run_autograder", tmp_path, python)
    assert graded.returncode == 0, graded.stdout + graded.stderr
    results = json.loads((tmp_path / "results" / "results.json").read_text("utf-8"))
    assert results["score"] == 75
    assert results["extra_data"]["mode"] in {"A", "B", "C"}


def test_versions_are_asked_for_where_they_run() -> None:
    lines = constraints().splitlines()
    (numpy,) = (line for line in lines if line.startswith("numpy=="))
    assert "; python_version >= " in numpy
    assert any(line.startswith("pyseccomp==") for line in lines)


class Cage:
    """A control group with the memory and the processor time of a small container."""

    def __init__(self, name: str) -> None:
        self.memory, self.cpu = (CONTROL / kind / name for kind in ("memory", "cpu"))
        for folder in (self.memory, self.cpu):
            folder.mkdir()
        (self.memory / "memory.limit_in_bytes").write_text(str(MEMORY))
        (self.cpu / "cpu.cfs_period_us").write_text("100000")
        (self.cpu / "cpu.cfs_quota_us").write_text(str(HALF))

    def enter(self) -> None:
        """For the child, before it becomes the grader."""
        for folder in (self.memory, self.cpu):
            (folder / "cgroup.procs").write_text(str(os.getpid()))

    def peak(self) -> int:
        """Bytes, of grader and workers together."""
        return int((self.memory / "memory.max_usage_in_bytes").read_text())

    def failures(self) -> int:
        """How often the kernel has met the limit."""
        return int(
            (self.memory / "memory.oom_control").read_text().split("oom_kill ")[1].split()[0]
        )

    def close(self) -> None:
        for folder in (self.memory, self.cpu):
            folder.rmdir()


@pytest.fixture
def cage() -> Iterator[Cage]:
    try:
        made = Cage(f"photograd-{os.getpid()}")
    except OSError as error:
        missing(f"no control groups to limit a container with: {error}", by_choice=True)
    yield made
    made.close()


def solution_of(folder: Path, target: Path) -> None:
    """What a student hands in who has written the solution."""
    manifest = read_manifest(folder)
    target.mkdir()
    brought = [path for path in folder.parent.glob("*/*.py") if path.stem in manifest.brought]
    for path in (folder / f"{manifest.module}.py", *brought):
        shutil.copyfile(path, target / path.name)


@pytest.mark.exhaustive
@pytest.mark.parametrize("folder", ASSIGNMENTS, ids=lambda path: path.name)
def test_a_small_container_is_enough(folder: Path, cage: Cage, tmp_path: Path) -> None:
    solution_of(folder, tmp_path / "submission")
    (tmp_path / "secret.txt").write_bytes(SECRET)
    places = {"bundle": folder, "metadata": tmp_path / "none.json"}
    places |= {"secret-file": tmp_path / "secret.txt", "submission": tmp_path / "submission"}
    places["results"] = tmp_path / "results.json"
    words = [word for name, place in places.items() for word in (f"--{name}", str(place))]
    program = [sys.executable, "-I", "-m", "photograd_course.build.gradescope_run"]
    done = subprocess.run(
        [*program, read_manifest(folder).id, *words],
        preexec_fn=cage.enter,
        capture_output=True,
        text=True,
        check=False,
    )
    results: dict[str, Any] = json.loads((tmp_path / "results.json").read_text("utf-8"))
    lost = [
        test for test in results["tests"] if test["status"] == "failed" and ".q" not in test["name"]
    ]
    points = read_manifest(folder).points["code"]
    said = f"peak {cage.peak() >> 20} MB, {results['execution_time']} s, {lost[:3]}"
    assert (done.returncode, cage.failures()) == (0, 0), said + done.stdout + done.stderr
    assert results["score"] == points, said
