"""Of the automatic mutants at least 95 % are noticed, and the others listed as equivalent."""

from __future__ import annotations

from collections.abc import Iterator

from ..automatic import AutoMutant
from ..dossier import Dossier

SHARE = 0.95


def look(dossier: Dossier) -> Iterator[str]:
    """See the module."""
    total, alive = len(dossier.automatic), survivors(dossier)
    if total and (total - len(alive)) / total < SHARE:
        killed = total - len(alive)
        yield f"checks notice {killed} of {total} automatic mutants, less than {SHARE:.0%}"
    for mutant in alive:
        if not any(each.fits(mutant) for each in dossier.equivalents):
            yield (
                f"no check notices, in line {mutant.number} ({mutant.function}), "
                f"'{mutant.line}', the change '{mutant.mutation}'"
            )
    for each in dossier.equivalents:
        if not any(each.fits(mutant) for mutant in alive):
            yield (
                f"equivalent.toml lists '{each.mutation}' in '{each.line}' ({each.function}), "
                "which is no surviving mutant"
            )
    for mutant, verdict in zip(dossier.automatic, dossier.automatic_verdicts, strict=True):
        for outcome in verdict.ours:
            yield (
                f"{outcome['id']} falters, line {mutant.number}, on '{mutant.mutation}': "
                f"{outcome['text']}"
            )


def survivors(dossier: Dossier) -> list[AutoMutant]:
    """Automatic mutants that pass every check."""
    pairs = zip(dossier.automatic, dossier.automatic_verdicts, strict=True)
    return [mutant for mutant, verdict in pairs if not verdict.lost]
