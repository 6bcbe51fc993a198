"""`equivalent.toml`: automatic mutants that no check can notice, each with the reason why.

[[equivalent]]
function = "descend"
line = "trail = [np.array(x0)]"
mutation = "a -> b"
reason = "the value is never read"
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..assignment.toml import read_toml
from ..errors import SceneError, message
from .automatic import AutoMutant

KEYS = {"function", "line", "mutation", "reason"}


@dataclass(frozen=True)
class Equivalent:
    """One entry."""

    function: str
    line: str
    mutation: str
    reason: str

    def fits(self, mutant: AutoMutant) -> bool:
        """Whether it speaks of this mutant."""
        there = (mutant.function, mutant.line, mutant.mutation)
        return (self.function, self.line, self.mutation) == there


def read_equivalents(folder: Path) -> tuple[Equivalent, ...]:
    """The entries, none if there is no such file.

    Raises:
        SceneError: an entry lacks a key, or has another, or an empty reason.
    """
    path = folder / "equivalent.toml"
    if not path.exists():
        return ()
    found = []
    for entry in read_toml(path).get("equivalent", []):
        if set(entry) != KEYS or not str(entry["reason"]).strip():
            wanted = f"{sorted(KEYS)}, none empty"
            raise SceneError(message("read_equivalents", path.name, wanted, repr(entry)))
        found.append(Equivalent(**{key: " ".join(str(entry[key]).split()) for key in KEYS}))
    return tuple(found)
