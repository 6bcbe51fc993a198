"""Where graders really run: containers without the right to make namespaces, and no root at all."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from photograd_course.worker import bubblewrap, landlock
from photograd_course.worker.program import interpreter

from support.missing import missing, need_module
from support.tree import ROOT

WITNESS = [sys.executable, "-m", "course.isolation.witness"]
STRANGER = 61183  # a user without a name, beyond those that `users.py` lends


def run(command: list[str], folder: Path) -> dict[str, Any]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests"), "TMPDIR": str(folder)}
    done = subprocess.run(
        command, env=environment, cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def assert_good(found: dict[str, Any], expected: dict[str, Any]) -> None:
    assert found["wrong"] == expected["wrong"]
    denied = {name: ["raised", "PermissionError"] for name in ("fork", "socket", "signal", "file")}
    endings = found["endings"]
    assert endings.pop("secret") in (["raised", "PermissionError"], ["raised", "FileNotFoundError"])
    assert endings == {
        **denied,
        "loop": ["timeout", ""],
        "crash": ["died", ""],
        "memory": ["raised", "MemoryError"],
    }
    assert found["left"] == []


@pytest.mark.skipif(sys.platform != "linux" or os.geteuid() != 0, reason="needs root on Linux")
def test_root_in_a_container_gets_mode_c(tmp_path: Path, expected: dict[str, Any]) -> None:
    need_module("pyseccomp")
    launcher = str(Path(__file__).parent / "container.py")
    found = run([sys.executable, launcher, *WITNESS, "C"], tmp_path)
    assert found["uid"] == 0
    assert found["works"]["A"] != ""
    assert "unshare: Operation not permitted" in found["works"]["B"]
    assert (found["works"]["C"], found["chosen"]) == ("", "C")
    assert_good(found["seen"]["C"], expected)


def test_without_root(expected: dict[str, Any], tmp_path: Path) -> None:
    if sys.platform != "linux" or landlock.version() == 0:
        missing("needs Linux with Landlock", by_choice=True)
    need_module("pyseccomp")
    prefix, folder = another_user() if os.geteuid() == 0 else ([], tmp_path)
    found = run([*prefix, *WITNESS, "AD"], folder)
    shutil.rmtree(folder, ignore_errors=True)
    assert found["uid"] != 0
    assert found["works"]["B"] == found["works"]["C"] == "needs root"
    assert found["works"]["D"] == ""
    # Whether strangers may make namespaces, and so have mode A, is for the machine to say.
    assert found["chosen"] == ("D" if found["works"]["A"] else "A")
    for seen in found["seen"].values():
        assert_good(seen, expected)


def another_user() -> tuple[list[str], Path]:
    """How to run something as a user without rights, for whom root's home is made passable."""
    program = bubblewrap.find()
    if program is None:
        missing("needs bubblewrap to let another user reach the interpreter")
    # Those of pytest are for this user only.
    folder = Path(tempfile.mkdtemp(prefix="photograd-stranger-"))
    folder.chmod(0o777)
    own = Path(sys.base_prefix)
    prefix = [program, "--dev-bind", "/", "/"]
    if str(own).startswith("/root/"):
        prefix += ["--perms", "0755", "--tmpfs", "/root"]
        parents = [each for each in reversed(own.parents) if Path("/root") in each.parents]
        for parent in parents:
            prefix += ["--perms", "0755", "--dir", str(parent)]
        prefix += ["--ro-bind", str(own), str(own)]
    code = f"""
import os, sys
os.setgroups([]); os.setresgid({STRANGER}, {STRANGER}, {STRANGER})
os.setresuid({STRANGER}, {STRANGER}, {STRANGER})
os.execv(sys.argv[1], sys.argv[1:])
"""
    return [*prefix, interpreter(), "-S", "-c", code], folder
