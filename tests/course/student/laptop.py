"""A laptop: an environment with the course's wheel and what it requires, and nothing else.

The core cannot be imported there, and modules that only POSIX systems have are replaced, so that
every use of them fails here as on Windows.
"""

from __future__ import annotations

import compileall
import re
import subprocess
import sys
import zipfile
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from support.tree import ROOT

COURSE = ROOT / "python" / "photograd_course"

POISON = """
import builtins, os, signal, subprocess, sys

ABSENT = {"resource", "fcntl", "pwd", "grp", "termios", "tty", "pty", "posixpath_x"}


class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ABSENT:
            raise ModuleNotFoundError(f"No module named {name!r} (not on this laptop)", name=name)
        return None


sys.meta_path.insert(0, Absent())
for name in ABSENT:
    sys.modules.pop(name, None)
for module, names in {
    os: ("fork", "forkpty", "setsid", "setuid", "getuid", "geteuid", "killpg", "chown", "mkfifo"),
    signal: ("SIGALRM", "alarm", "setitimer", "SIGKILL", "pthread_kill"),
}.items():
    for name in names:
        if hasattr(module, name):
            delattr(module, name)

Popen = subprocess.Popen.__init__


def start(self, *args, **options):
    for name in ("pass_fds", "preexec_fn", "start_new_session", "process_group", "user", "group"):
        if options.get(name):
            raise ValueError(f"{name} is not supported on this platform")
    Popen(self, *args, **options)


subprocess.Popen.__init__ = start
"""


@dataclass(frozen=True)
class Laptop:
    """One such environment."""

    python: Path

    def run(self, *words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
        """`photograd WORDS...`, without standard input."""
        command = [str(self.python), "-m", "photograd_course", *words]
        return self.call(command, cwd)

    def call(self, command: list[str], cwd: Path) -> subprocess.CompletedProcess[str]:
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(cwd), "COLUMNS": "100"}
        return subprocess.run(
            command,
            cwd=cwd,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )


def make_laptop(folder: Path) -> Laptop:
    """Build the course's wheel from this tree and lay it out with its requirements."""
    return laptop_with(build_wheel(folder / "wheels"), folder)


def build_wheel(target: Path) -> Path:
    """The course's wheel of this tree."""
    subprocess.run(
        [
            sys.executable,
            "-m",
            "pip",
            "wheel",
            "-q",
            "--no-deps",
            "--no-build-isolation",
            "-w",
            str(target),
            str(COURSE),
        ],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    (wheel,) = target.glob("photograd_course-*.whl")
    return wheel


def laptop_with(wheel: Path, folder: Path) -> Laptop:
    """An environment with a wheel and what it requires."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder / "env")], check=True)
    site = next((folder / "env").glob("lib/python3*/site-packages"))
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    compileall.compile_dir(site, quiet=1, maxlevels=20)  # as pip does
    for name in sorted(required("photograd-course")):
        link(name, site)
    (site / "sitecustomize.py").write_text(POISON, encoding="utf-8")
    return Laptop(folder / "env" / "bin" / "python")


def required(distribution: str) -> set[str]:
    """Names of all distributions that one requires, itself left out."""
    found: set[str] = set()
    todo = [distribution]
    while todo:
        for line in metadata.requires(todo.pop()) or []:
            bare, _, marker = line.partition(";")
            name = re.split(r"[^A-Za-z0-9_.-]", bare)[0]
            elsewhere = bool(marker) and not any(metadata.Distribution.discover(name=name))
            if name not in found and "extra" not in marker and not elsewhere:
                found.add(name)
                todo.append(name)
    return found


def link(name: str, site: Path) -> None:
    """Make the files of an installed distribution visible in another environment."""
    distribution = metadata.distribution(name)
    tops = {file.parts[0] for file in distribution.files or [] if file.parts[0] not in ("..", ".")}
    for top in tops:
        source = Path(str(distribution.locate_file(top)))
        target = site / top
        if source.exists() and not target.exists() and top != "__pycache__":
            target.symlink_to(source)
