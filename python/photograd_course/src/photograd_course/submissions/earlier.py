"""Functions of earlier assignments that a check uses, as the solutions have them.

A wrong one must not cost its points twice. Which they are is read from the solution's text alone,
so that a submission has no say in what is replaced.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from threading import Lock
from typing import Any

from ..assignment.bundle import Bundle
from ..assignment.load import load_beside
from ..build.regions import solution_parts
from ..grading.check import Check
from ..grading.runner import Setting
from ..student.brought_checks import uses_of

_LOADING = Lock()  # it changes how this process imports; submissions may be judged side by side


def setting_with_earlier(bundle: Bundle, files: Mapping[str, bytes]) -> Callable[[Check], Setting]:
    """`Bundle.setting`, with the earlier functions that each check uses.

    Args:
        bundle: with the solution.
        files: of the submission; where it brings the solution's own modules, nothing is replaced.
    """
    own = {name: files.get(f"{name}.py") for name in bundle.brought}
    if not bundle.brought or own == {name: t.encode() for name, t in bundle.brought.items()}:
        return bundle.setting
    module = bundle.manifest.module
    uses = uses_of(bundle, bundle.solution_files(bundle.solution))
    right, stands_for = _right_functions(bundle), uses.names()

    def setting(check: Check) -> Setting:
        if any(stands_for.get((module, name)) in right for name in check.calls):
            return bundle.setting(check)  # it is about an earlier function itself
        reached = uses.reached_by(check)
        # Under each name by which a module of the submission has it.
        known = {
            ".".join(name): right[origin]
            for name, origin in stands_for.items()
            if origin in right and origin in reached
        }
        return replace(bundle.setting(check), earlier=known)

    return setting


def _right_functions(bundle: Bundle) -> dict[tuple[str, str], Callable[..., Any]]:
    """By module and name: those that an earlier assignment asked for."""
    found = {}
    for module, text in bundle.brought.items():
        with _LOADING:
            loaded = load_beside(module, text, bundle.brought)
        for part in solution_parts(text, f"{module}.py"):
            if part.function and "." not in part.function:  # methods cannot be replaced from here
                found[module, part.function] = getattr(loaded, part.function)
    return found
