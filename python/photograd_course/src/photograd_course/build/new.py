"""`photograd course new`: a folder that keeps every build rule, to be filled with an assignment."""

from __future__ import annotations

import keyword
import shutil
from pathlib import Path

from ..errors import IoError, RangeError, message
from .course_files import build_of
from .hint_table import public_hints, write_hints
from .kits import source_folders
from .template import template


def new_assignment(number: str, name: str, root: Path) -> Path:
    """Write the folder `root/NN_name` and return it.

    Args:
        number: two digits that no other assignment has.
        name: of the folder and of the graded module.
        root: the folder of assignments.

    Raises:
        RangeError: number or name cannot be used.
        IoError: the folder exists, or cannot be written.
    """
    if not (len(number) == 2 and number.isascii() and number.isdigit()):
        raise RangeError(message("new", "NN", "two digits", repr(number)))
    if not name.isidentifier() or keyword.iskeyword(name) or name != name.lower():
        expected = "a name for a Python module in lower case"
        raise RangeError(message("new", "NAME", expected, repr(name)))
    for taken in source_folders(root):
        if taken.startswith(f"{number}_"):
            raise RangeError(message("new", "NN", "a free number", f"{number}: {taken} has it"))
    folder = root / f"{number}_{name}"
    if folder.exists():
        raise IoError(message("new", str(folder), "a new folder", "one that is there"))
    # Under a name that is no assignment's, until it is whole: a run that was cut off leaves none.
    fresh = root / f".{folder.name}.new"
    try:
        shutil.rmtree(fresh, ignore_errors=True)
        for path, text in template(number, name).items():
            (fresh / path).parent.mkdir(parents=True, exist_ok=True)
            (fresh / path).write_text(text, encoding="utf-8")
        write_hints(fresh, public_hints(build_of(fresh, root=root)))
        fresh.rename(folder)
    except OSError as error:
        shutil.rmtree(fresh, ignore_errors=True)
        if isinstance(error, IoError):
            raise
        got = error.strerror or str(error)
        raise IoError(message("new", str(folder), "a new folder", got)) from error
    return folder
