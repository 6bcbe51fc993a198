"""What a check says it kills, it kills; and every mutant it names exists."""

from __future__ import annotations

from collections.abc import Iterator

from ..dossier import Dossier


def look(dossier: Dossier) -> Iterator[str]:
    """See the module."""
    for check in dossier.checks:
        for name in check.kills:
            if name not in dossier.mutant_verdicts:
                yield f"{check.id} should kill {name}, and there is no such mutant"
            elif check.id not in dossier.mutant_verdicts[name].lost:
                yield f"{check.id} should kill {name}, which survives it"
