"""What the starter and right solutions import, a graded module may import."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ...worker.screen import forbidden_imports
from ..assignment_build import AssignmentBuild


def check_imports(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    manifest = build.manifest
    own = [Path(file).stem for file in manifest.submission]
    texts = {"the starter": build.starter, "the solution": build.source}
    texts |= {f"the alternative {name}": text for name, text in build.alternatives.items()}
    for name, text in texts.items():
        for each in forbidden_imports(manifest.module, text, manifest.imports, own):
            yield f"{name} imports {each['module']}, which assignment.toml does not list"
