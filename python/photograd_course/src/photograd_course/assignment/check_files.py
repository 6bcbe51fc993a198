"""The package `checks/` of an assignment: a file for each task, hidden checks in a folder apart.

    checks/__init__.py
    checks/task_1.py           public checks of task NN.1; may import from files beside it
    checks/common.py           optional: what the checks of several tasks share
    checks/hidden/__init__.py
    checks/hidden/task_1.py    hidden and secret checks; may import from `..common`, `..task_1`

Students get `checks/` without the folder `hidden`.
"""

from __future__ import annotations

from pathlib import Path

FOLDER = "checks"
HIDDEN = f"{FOLDER}/hidden/"


def check_files(folder: Path) -> dict[str, str]:
    """The texts of an assignment's checks by path, such as "checks/hidden/task_1.py", in order."""
    paths = (folder / FOLDER).rglob("*.py")
    texts = {path.relative_to(folder).as_posix(): path.read_text("utf-8") for path in paths}
    return dict(sorted(texts.items()))


def public_check_files(folder: Path) -> dict[str, str]:
    """`check_files` without those in `checks/hidden/`."""
    texts = check_files(folder)
    return {path: text for path, text in texts.items() if not path.startswith(HIDDEN)}
