"""Load an assignment's `checks.py`: our own code, run in this process."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

from ..errors import SceneError, message
from ..grading.check import Check
from ..worker.modules import SourceFinder
from .manifest import Manifest


def load_module(name: str, text: str, extra: Mapping[str, object] | None = None) -> ModuleType:
    """Run source text as a module of its own, without entering it into `sys.modules`."""
    module = ModuleType(name)
    module.__dict__.update(extra or {})
    exec(compile(text, f"{name}.py", "exec", dont_inherit=True), module.__dict__)
    return module


def load_beside(name: str, text: str, brought: Mapping[str, str]) -> ModuleType:
    """`load_module` for a text that may import the brought modules while it is loaded."""
    finder = SourceFinder(brought)
    for each in brought:
        sys.modules.pop(each, None)
    sys.meta_path.insert(0, finder)
    try:
        return load_module(name, text)
    finally:
        finder.remove()


def load_checks(manifest: Manifest, path: Path | None = None) -> list[Check]:
    """All checks of an assignment, sorted by task and then as they stand in the file.

    Args:
        manifest: of the assignment.
        path: by default `checks.py` in its folder.

    Raises:
        SceneError: an id occurs twice, a task is unknown, or there is no check.
    """
    source = path or manifest.folder / "checks.py"
    module = load_module(f"checks_{manifest.id}", source.read_text(encoding="utf-8"))
    checks = [value for value in vars(module).values() if isinstance(value, Check)]
    order = {task.id: number for number, task in enumerate(manifest.tasks)}
    seen: set[str] = set()
    for each in checks:
        if each.id in seen:
            raise SceneError(message("load_checks", each.id, "an id of its own", "it occurs twice"))
        if each.task not in order:
            raise SceneError(message("load_checks", each.id, f"a task of {list(order)}", each.task))
        seen.add(each.id)
    if not checks:
        raise SceneError(message("load_checks", str(source.name), "at least one check", "none"))
    return sorted(checks, key=lambda each: order[each.task])
