"""What students get compiles: the starter, the public checks, the adapters, the exploration."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_compiles(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    for path, data in build.visible.items():
        if not path.endswith(".py"):
            continue
        try:
            compile(data.decode("utf-8"), path, "exec", dont_inherit=True)
        except (SyntaxError, ValueError) as error:
            line = getattr(error, "lineno", 0)
            yield f"{path}, line {line}: the stripped file does not compile: {error}"
