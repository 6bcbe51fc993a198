"""Load an assignment's checks: our own code, run in this process."""

from __future__ import annotations

from types import ModuleType

from ..errors import IoError, SceneError, message
from ..grading.check import Check
from .check_files import FOLDER, HIDDEN, check_files
from .load import load_package
from .manifest import Manifest


def load_check_modules(manifest: Manifest) -> dict[str, ModuleType]:
    """The modules of an assignment's checks by path, public ones first.

    Raises:
        IoError: there is no folder `checks` with an `__init__.py`.
    """
    texts = check_files(manifest.folder)
    if f"{FOLDER}/__init__.py" not in texts:
        got = f"the files {list(texts)}" if texts else "none"
        place = str(manifest.folder)
        raise IoError(message("load_checks", place, "a package checks/ with an __init__.py", got))
    paths = sorted(texts, key=lambda path: (path.startswith(HIDDEN), path))
    inside = {path.removeprefix(f"{FOLDER}/"): texts[path] for path in paths}
    modules = load_package(f"checks_{manifest.id}", inside)
    return {f"{FOLDER}/{path}": module for path, module in modules.items()}


def load_checks(manifest: Manifest) -> list[Check]:
    """All checks of an assignment, sorted by task; of a task the public ones first.

    Raises:
        IoError: there is no package `checks`.
        SceneError: an id occurs twice, a task is unknown, a check stands in another file than that
            of its task, hidden ones in `checks/hidden/`, or there is no check.
    """
    checks: dict[str, Check] = {}
    known: set[int] = set()
    for path, module in load_check_modules(manifest).items():
        for each in vars(module).values():
            if not isinstance(each, Check) or id(each) in known:  # imported from another file
                continue
            if each.id in checks:
                got = "it occurs twice"
                raise SceneError(message("load_checks", each.id, "an id of its own", got))
            _require_place(each, path, manifest)
            checks[each.id] = each
            known.add(id(each))
    if not checks:
        raise SceneError(message("load_checks", FOLDER, "at least one check", "none"))
    order = {task.id: number for number, task in enumerate(manifest.tasks)}
    return sorted(checks.values(), key=lambda each: order[each.task])


def _require_place(check: Check, path: str, manifest: Manifest) -> None:
    """A hidden check outside of the folder `hidden` would be in every student's kit."""
    tasks = [task.id for task in manifest.tasks]
    if check.task not in tasks:
        raise SceneError(message("load_checks", check.id, f"a task of {tasks}", check.task))
    folder = f"{FOLDER}/" if check.visibility == "public" else HIDDEN
    place = f"{folder}task_{check.task.partition('.')[2]}.py"
    if path != place:
        expected = f"a {check.visibility} check of task {check.task} in {place}"
        raise SceneError(message("load_checks", check.id, expected, path))
