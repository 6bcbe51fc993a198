"""The files of this project, for tests that read the sources."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CPP_SUFFIXES = {".h", ".inl", ".cpp"}
_MADE = {"build", "dist", "out", "node_modules", "__pycache__"}  # and everything hidden
_PACKAGE = "photograd_course/build"  # ours, in spite of its name


def walk(folder: Path, suffixes: set[str] | None = None) -> Iterator[Path]:
    """Files below `folder` in order, without what tools make; `suffixes` None means all."""
    for path in sorted(folder.iterdir()):
        if path.is_dir():
            hidden = path.name.startswith(".") and path.name != ".ci"
            made = path.name in _MADE and not path.as_posix().endswith(_PACKAGE)
            if not hidden and not made and not path.name.endswith(".egg-info"):
                yield from walk(path, suffixes)
        elif suffixes is None or path.suffix in suffixes:
            yield path


def relative(path: Path) -> str:
    """Path from the root of the project, with forward slashes."""
    return path.relative_to(ROOT).as_posix()


def cpp_texts() -> dict[str, str]:
    """C++ sources by path from `cpp/`, for example "photograd/ops/sh.h"."""
    folder = ROOT / "cpp"
    return {
        path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
        for path in walk(folder, CPP_SUFFIXES)
    }


def python_texts() -> dict[str, str]:
    """Python sources of both distributions by path from the root."""
    return {
        relative(path): path.read_text(encoding="utf-8") for path in walk(ROOT / "python", {".py"})
    }
