"""Where interpreter, standard library and NumPy lie, and what beside them a worker must not see."""

from __future__ import annotations

import os
import sys
import sysconfig
from functools import lru_cache
from pathlib import Path

from .program import interpreter, numpy_parent

PACKAGES = frozenset({"site-packages", "dist-packages"})
DEVICES = ("/dev/null", "/dev/zero", "/dev/urandom", "/dev/random")


def standard_library() -> tuple[Path, ...]:
    """Its folder, or two on systems that keep compiled parts apart."""
    paths = {Path(sysconfig.get_path(key)) for key in ("stdlib", "platstdlib")}
    # In a virtual environment "platstdlib" may name a folder that holds packages only.
    return tuple(sorted(path for path in paths if (path / "os.py").exists() or _compiled(path)))


def _compiled(path: Path) -> bool:
    return (path / "lib-dynload").is_dir()


def numpy_folders() -> tuple[Path, ...]:
    """NumPy, and the libraries that its wheel brings."""
    names = ("numpy", "numpy.libs")
    return tuple(path for name in names if (path := numpy_parent() / name).is_dir())


@lru_cache(maxsize=1)
def readable() -> tuple[str, ...]:
    """For Landlock, which can only allow: the standard library entry by entry, less packages."""
    found = [str(path) for path in numpy_folders()]
    for folder in standard_library():
        found += [str(entry) for entry in sorted(folder.iterdir()) if entry.name not in PACKAGES]
    return (*found, *DEVICES)


def mounts() -> tuple[list[Path], list[Path], list[Path]]:
    """For bubblewrap: what to show read-only, what of it to hide, and what to show once more."""
    library_homes = [Path(f"/{name}") for name in ("lib", "lib64", "lib32", "usr/lib", "usr/lib64")]
    own = Path(sys.base_prefix)
    shown = [path for path in library_homes if path.is_dir() and not path.is_symlink()]
    shown += [path for name in ("lib", "lib64") if (path := own / name).is_dir()]
    shown += [Path(interpreter()), Path("/etc/ld.so.cache"), Path("/etc/alternatives")]
    shown += standard_library()
    unique = list(dict.fromkeys(path for path in shown if path.exists()))
    return unique, _package_folders(unique), list(numpy_folders())


def _package_folders(shown: list[Path]) -> list[Path]:
    found = set()
    for folder in shown:
        for python in (folder, *folder.glob("python3*")):
            found |= {python / name for name in PACKAGES if (python / name).is_dir()}
    return sorted(found)


def links() -> list[tuple[str, str]]:
    """Links in the root folder such as /lib to usr/lib, as (target, link)."""
    names = ("/lib", "/lib64", "/lib32", "/bin")
    return [(os.readlink(name), name) for name in names if Path(name).is_symlink()]  # noqa: PTH115
