"""The solution earns everything."""

from __future__ import annotations

from collections.abc import Iterator

from ..dossier import Dossier


def look(dossier: Dossier) -> Iterator[str]:
    """See the module."""
    verdict = dossier.solution_verdict
    for each in verdict.outcomes:
        if each["status"] != "passed":
            yield f"the solution does not pass {each['id']}: {each['text']}"
    for check in verdict.hung:
        yield f"the solution does not come to an end in {check}"
