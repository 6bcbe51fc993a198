"""What comes after a submission."""

from __future__ import annotations

from ..assignment.bundle import Bundle
from ..build.kits import find_kit, list_kits


def next_steps(bundle: Bundle, archive: str) -> list[str]:
    """Lines: where the archive goes, what the grade will say, and which assignment is next.

    Args:
        bundle: of the assignment that was packed.
        archive: name of the file.
    """
    lines = [f"Next: hand in {archive} where your course collects submissions."]
    if any(question.kind == "prediction" for question in bundle.questions):
        lines.append("Your predictions are answered in the report that comes with the grade.")
    own = bundle.manifest.folder_name
    later = [name for name in list_kits() if name > own]
    if later:
        manifest = find_kit(later[0]).manifest
        command = f"photograd course start {manifest.id}"
        lines.append(f"Then: {command}   ({manifest.title}, an estimated {manifest.hours:g} hours)")
    return lines
