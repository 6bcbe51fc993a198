"""Of the automatic mutants at least 95 % are noticed, and the others listed as equivalent."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild
from ..automatic import AutoMutant

SHARE = 0.95


def check_automatic(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    total, alive = len(build.automatic), survivors(build)
    if total and (total - len(alive)) / total < SHARE:
        killed = total - len(alive)
        yield f"checks notice {killed} of {total} automatic mutants, less than {SHARE:.0%}"
    for mutant in alive:
        if not any(each.fits(mutant) for each in build.equivalents):
            yield (
                f"no check notices, in line {mutant.number} ({mutant.function}), "
                f"'{mutant.line}', the change '{mutant.mutation}'"
            )
    for each in build.equivalents:
        if not any(each.fits(mutant) for mutant in alive):
            yield (
                f"equivalent.toml lists '{each.mutation}' in '{each.line}' ({each.function}), "
                "which is no surviving mutant"
            )
    for mutant, verdict in zip(build.automatic, build.automatic_verdicts, strict=True):
        for outcome in verdict.ours:
            yield (
                f"{outcome['id']} falters, line {mutant.number}, on '{mutant.mutation}': "
                f"{outcome['text']}"
            )


def survivors(build: AssignmentBuild) -> list[AutoMutant]:
    """Automatic mutants that pass every check."""
    pairs = zip(build.automatic, build.automatic_verdicts, strict=True)
    return [mutant for mutant, verdict in pairs if not verdict.lost]
