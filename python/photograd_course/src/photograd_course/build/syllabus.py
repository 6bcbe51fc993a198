"""Print a track: week by week what is read, how long it takes, and what must come before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..cli.output import emit
from ..errors import SceneError, message
from .course_file import course_findings, read_course
from .kits import no_sources, plan_folder


def syllabus(track: str, root: Path) -> dict[str, Any]:
    """The track as plain values.

    Raises:
        RangeError: there is no such track.
        SceneError: a prerequisite is missing.
    """
    course = read_course(root)
    chosen = course.track(track)
    if problems := course_findings(course):
        expected = "every prerequisite before what needs it"
        raise SceneError(message("syllabus", "course.toml", expected, "; ".join(problems)))
    rows = []
    for number, week in enumerate(chosen.weeks, start=1):
        for each in week:
            entry = course.entries[each]
            rows.append(
                {
                    "week": number,
                    "assignment": entry.id,
                    "title": entry.title,
                    "estimated_hours": entry.hours,
                    "needs": ", ".join(entry.prerequisites) or "nothing",
                    "state": "ready" if entry.ready else "planned",
                }
            )
    return {
        "track": chosen.name,
        "title": chosen.title,
        "weeks": rows,
        "estimated_hours": sum(row["estimated_hours"] for row in rows),
        "ready": sum(row["state"] == "ready" for row in rows),
        "planned": sum(row["state"] == "planned" for row in rows),
    }


def print_syllabus(track: str, *, as_json: bool) -> None:
    """`photograd course syllabus`.

    Raises:
        IoError: there is no plan of a course here.
    """
    root = plan_folder()
    if root is None:
        raise no_sources("syllabus", "course.toml")
    emit(syllabus(track, root), as_json=as_json)
