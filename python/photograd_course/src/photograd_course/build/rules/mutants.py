"""Each named mutant loses exactly the checks that it says."""

from __future__ import annotations

from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_mutants(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    known = {check.id for check in build.checks}
    for mutant in build.mutants:
        lost, says = set(build.mutant_verdicts[mutant.name].lost), set(mutant.loses)
        for unknown in sorted(says - known):
            yield f"{mutant.name} should lose {unknown}, which is no check"
        for check in sorted((says & known) - lost):
            yield f"{mutant.name} survives {check}, which it should lose"
        for check in sorted(lost - says):
            yield f"{mutant.name} loses {check}, which its row does not list"
        if not says:
            yield f"{mutant.name} loses nothing"
        for each in build.mutant_verdicts[mutant.name].ours:
            yield f"{each['id']} falters on {mutant.name}: {each['text']}"
