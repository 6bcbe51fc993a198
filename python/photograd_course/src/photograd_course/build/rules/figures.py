"""Every picture that the handout shows is there, and none is larger than it may be."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ..assignment_build import AssignmentBuild

LARGEST = 500_000  # bytes
_LINK = re.compile(r"!\[[^\]]*\]\(([^)\s]+)")


def check_figures(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    handout = build.visible.get("kit/README.md", b"").decode("utf-8")
    for link in sorted(set(_LINK.findall(handout))):
        if f"kit/{link}" not in build.visible:
            yield f"the handout shows {link}, which is not in the kit"
    for path, data in build.visible.items():
        if path.endswith(".png") and len(data) > LARGEST:
            yield f"{path} has {len(data)} bytes, more than {LARGEST}"
