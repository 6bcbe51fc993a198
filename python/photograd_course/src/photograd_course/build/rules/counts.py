"""Five named mutants for each adjoint that is graded, and three alternatives.

Graded adjoints are the functions of the manifest whose name says so: "backward", "adjoint" or
"and_grad" is part of it. A mutant counts for a function when it lies in the function's task.
"""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild

MUTANTS = 5
ALTERNATIVES = 3
ADJOINT = ("backward", "adjoint", "and_grad")


def check_counts(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    for task in build.manifest.tasks:
        adjoints = [name for name in task.functions if is_adjoint(name)]
        count = sum(task.id in mutant.tasks for mutant in build.mutants)
        if adjoints and count < MUTANTS:
            yield (
                f"task {task.id} has the adjoint {adjoints[0]} and {count} named mutants; "
                f"it needs {MUTANTS}"
            )
    if (count := len(build.alternatives)) < ALTERNATIVES:
        yield f"there are {count} alternatives; it needs {ALTERNATIVES}"
    known = {task.id for task in build.manifest.tasks}
    for mutant in build.mutants:
        for task_id in sorted(set(mutant.tasks) - known):
            yield f"mutant {mutant.name} lies in {task_id}, which is no task"


def is_adjoint(function: str) -> bool:
    """Whether a function is an adjoint, by its name."""
    return any(word in function.rpartition(".")[2] for word in ADJOINT)
