"""Prove that a wheel needs nothing of the machine: run it where nothing else is.

Usage: bare_root.py PYTHON DIST

    PYTHON   an interpreter
    DIST     a folder with the wheels of the course and of the core for that interpreter

Both are installed into an environment of their own. Then `photograd` runs in a root (bubblewrap)
that holds this environment, the interpreter, and the shared libraries that the interpreter and its
own modules load: no Embree, no OpenVDB, no compiler, no network.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ALLOWED = (
    *("libstdc++.so.6", "libgcc_s.so.1", "libm.so.6", "libz.so.1"),
    *("libpthread.so.0", "libdl.so.2", "librt.so.1", "libutil.so.1"),  # empty since glibc 2.34
)
"""What a wheel for manylinux may expect, beside the C library."""
TAG = "import sys; print('cp%d%d' % sys.version_info[:2])"
WORDS = (
    ("version",),
    (
        "capture",
        "--views",
        "4",
        "--test-views",
        "1",
        "--size",
        "16",
        "--spp",
        "1",
        "--out",
        "photos",
    ),
    ("fit", "photos", "--out", "model", "--resolution", "8", "--steps", "4", "--rays", "64"),
    ("evaluate", "model", "photos"),
    ("convert", "model", "scene.vdb"),
    ("trace", "cornell-box", "--size", "8", "--spp", "2", "--out", "room.exr"),
    ("course", "start", "00"),
)


def loaded(file: Path) -> set[Path]:
    """The shared libraries that a file loads, by the name under which they are looked for."""
    told = subprocess.run(["ldd", str(file)], capture_output=True, text=True, check=False).stdout
    return {Path(path) for path in re.findall(r"(?:=> |^\s*)(/\S+) \(0x", told, re.MULTILINE)}


def places(python: Path) -> tuple[list[Path], list[Path]]:
    """Folders and single libraries that an interpreter needs."""
    code = "import sys, sysconfig; print(sys.base_prefix, sys.executable); "
    code += "print(sysconfig.get_path('stdlib')); print(sysconfig.get_config_var('DESTSHARED'))"
    told = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True).stdout
    prefix, executable, stdlib, modules = map(Path, told.split())
    own = [Path(stdlib)] if prefix == Path("/usr") else [prefix]
    files = [executable.resolve(), *Path(modules).glob("*.so")]
    needed = set[Path]().union(*(loaded(file) for file in files))
    system = {lib for lib in needed if not any(lib.is_relative_to(folder) for folder in own)}
    some = next(lib for lib in system if lib.name == "libc.so.6")
    system |= {some.parent / name for name in ALLOWED if (some.parent / name).exists()}
    if prefix == Path("/usr"):
        system.add(executable.resolve())
    return own, sorted(system)


def root_command(python: Path, environment: Path, work: Path) -> list[str]:
    """What starts a root with the interpreter, the environment and a folder to work in."""
    folders, libraries = places(python)
    words = ["bwrap", "--unshare-all", "--die-with-parent", "--proc", "/proc", "--dev", "/dev"]
    words += ["--tmpfs", "/tmp", "--clearenv", "--setenv", "HOME", "/work"]
    for folder in folders:
        words += ["--ro-bind", str(folder), str(folder)]
    for library in libraries:
        words += ["--ro-bind", str(library.resolve()), str(library)]
    words += ["--ro-bind", str(environment), str(environment), "--bind", str(work), "/work"]
    return [*words, "--chdir", "/work"]


def prove(python: Path, dist: Path) -> int:
    """Install the wheels, and run WORDS in the bare root; how many commands ran."""
    with tempfile.TemporaryDirectory(prefix="photograd-bare-") as folder:
        environment, work = Path(folder, "environment"), Path(folder, "work")
        work.mkdir()
        subprocess.run([python, "-m", "venv", environment], check=True)
        own = environment / "bin" / "python"
        tag = subprocess.run([own, "-c", TAG], capture_output=True, text=True, check=True).stdout
        wheels = [
            *dist.glob("photograd_course-*.whl"),
            *dist.glob(f"photograd-*-{tag.strip()}-*.whl"),
        ]
        if len(wheels) != 2:
            raise FileNotFoundError(f"bare_root: {dist}: expected two wheels, got {wheels}")
        install = [str(own), "-m", "pip", "install", "-q", "--disable-pip-version-check"]
        install += ["--only-binary", ":all:", *map(str, wheels)]
        subprocess.run(install, check=True)
        root = root_command(python, environment, work)
        for words in WORDS:
            command = [*root, str(own), "-m", "photograd_course", *words]
            subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        absent = [*root, str(own), "-c", "import ctypes; ctypes.CDLL('libembree3.so.3')"]
        if subprocess.run(absent, check=False, capture_output=True).returncode == 0:
            raise RuntimeError(
                "bare_root: root: expected none of the system's libraries, got Embree"
            )
    return len(WORDS)


if __name__ == "__main__":
    print(f"bare root: {prove(Path(sys.argv[1]), Path(sys.argv[2]))} commands ran")
