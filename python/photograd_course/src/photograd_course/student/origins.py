"""Where a student's own modules of earlier assignments lie, and which copy is the one to take.

Of a module that several folders hold, the copy with the fewest functions still to write is taken;
among equals that in the folder of the assignment that owns it: the one whose graded module it is.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..assignment.manifest import Manifest
from .kept import read_file
from .source_code import parsed, unwritten


@dataclass(frozen=True)
class Found:
    """One copy of a module.

    Attributes:
        path: of the file.
        content: its bytes.
        is_origin: whether the folder is that of the assignment that owns the module.
        unwritten: functions that are still stubs there.
        is_python: whether it can be read as Python at all.
    """

    path: Path
    content: bytes
    is_origin: bool
    unwritten: tuple[str, ...]
    is_python: bool

    @property
    def source(self) -> str:
        """Its text; bytes that are no UTF-8 are replaced."""
        return text_of(self.content)


def text_of(content: bytes) -> str:
    """The text of a student's file, whatever bytes it holds.

    Args:
        content: of the file.
    """
    return content.decode("utf-8", errors="replace")


def owner_of(module: str, manifests: Iterable[Manifest]) -> Manifest | None:
    """The assignment whose graded module it is.

    Args:
        module: its name, without ".py".
        manifests: of all assignments.
    """
    return next((each for each in manifests if each.module == module), None)


def functions_of(manifest: Manifest | None) -> list[str]:
    """The functions that an assignment asks for.

    Args:
        manifest: of the assignment, or None for none.
    """
    return [] if manifest is None else [name for task in manifest.tasks for name in task.functions]


def belongs_to_later(
    folder: Path, owner: Manifest, manifests: Iterable[Manifest]
) -> Manifest | None:
    """The assignment in whose folder the module of ``owner`` is only a copy; None: its own folder.

    Args:
        folder: holds the module.
        owner: the assignment whose module it is.
        manifests: of all assignments.
    """
    if folder.name == owner.folder_name:
        return None
    bring = (each for each in manifests if owner.module in each.brought)
    return next((each for each in bring if (folder / f"{each.module}.py").is_file()), None)


def copies(module: str, target: Path, manifests: Sequence[Manifest]) -> list[Found]:
    """All copies of a module in folders around one, the copy to take first.

    Args:
        module: its name, without ".py".
        target: the folder that needs it; what lies in it is left out.
        manifests: of all assignments.

    Raises:
        IoError: one cannot be read.
    """
    owner = owner_of(module, manifests)
    found = []
    for folder in _folders_around(target, manifests):
        path = folder / f"{module}.py"
        if _is_file(path) and not _is_file(folder / "assignment.toml"):  # an instructor's source
            found.append(_found(path, owner, manifests))
    name = owner.folder_name if owner else ""
    return sorted(
        found,
        key=lambda each: (
            len(each.unwritten),
            not each.is_python,
            not each.is_origin,
            each.path.parent.name != name,
            str(each.path),
        ),
    )


def _found(path: Path, owner: Manifest | None, manifests: Iterable[Manifest]) -> Found:
    content = read_file(path)
    source = text_of(content)
    is_origin = owner is not None and belongs_to_later(path.parent, owner, manifests) is None
    missing = tuple(unwritten(source, functions_of(owner)))
    return Found(path, content, is_origin, missing, parsed(source) is not None)


def _folders_around(target: Path, manifests: Iterable[Manifest]) -> Iterator[Path]:
    """Beside the target, beside the working directory, and one level up from inside of a kit."""
    target = target.resolve()
    near = [target.parent, Path.cwd()]
    modules = {f"{each.module}.py" for each in manifests}
    inside = [top.parent for top in near if any(_is_file(top / name) for name in modules)]
    seen = {target}
    for top in (*near, *inside):
        for folder in (*_subfolders(top), top):
            if folder not in seen:
                seen.add(folder)
                yield folder


def _is_file(path: Path) -> bool:
    with contextlib.suppress(OSError):  # a folder that may not be looked into
        return path.is_file()
    return False


def _subfolders(top: Path) -> list[Path]:
    with contextlib.suppress(OSError):
        return sorted(each.resolve() for each in top.iterdir() if each.is_dir())
    return []
