"""Whose an entry of an export is, read from its name as learning systems write them.

Canvas       doejane_LATE_103297_900_toy.py          (user, attachment; or a group)
             doejane_103297_text.html                (typed online; ..._link.html: an address)
             anon_x7Kq2_900_toy.py                   (anonymous grading)
Moodle       Jane Doe_5_assignsubmission_file_toy.py (or a folder without the file's name)
             Jane Doe_5_assignsubmission_onlinetext  (typed online)
Blackboard   HW 1_jdoe_attempt_2026-10-01-12-30-45_toy.py   (and .txt, the receipt)
Brightspace  12345-67890 - Jane Doe - Oct 1, 2026 1230 PM - toy.py   (or a folder)
Classroom    Jane Doe - toy.py                       (or toy.py.docx, converted)
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from ..assignment.manifest import Manifest
from .intake import as_wanted
from .listing import key_of
from .moments import looks_like_a_date, moment_of
from .submission import wanted_names

WORK, TEXT, RECEIPT, COMPANION = "work", "text", "receipt", "companion"


@dataclass(frozen=True)
class Label:
    """What a name says.

    Attributes:
        system: whose layout it is.
        role: "work", or "text" that was typed online, or a "receipt" or another "companion" file
            of the learning system.
        name, id: of the student or group; id "" where the layout has none.
        key: equal for everything of one student or group.
        is_late: the name says so.
        attempt: equal for everything of one attempt; "" where the layout keeps only one.
        when: orders attempts; "" where that cannot be told.
        file: as its student named it; "" for a folder that is the submission.
    """

    system: str
    role: str
    name: str
    id: str = ""
    key: str = ""
    is_late: bool = False
    attempt: str = ""
    when: str = ""
    file: str = ""


LONGEST_NAME = 255  # what file systems take; a longer one would only cost time
_TYPED = r"(?P<text>(?:text|link|media)(?:-\d+)?\.html?)"
_REST = rf"(?:(?P<order>\d+)_(?P<file>.+)|{_TYPED})"
_CANVAS = re.compile(rf"(?P<name>.+?)_(?P<late>LATE_)?(?P<id>\d+)_{_REST}")
_CANVAS_ANONYMOUS = re.compile(rf"(?P<name>anon)_(?P<id>[A-Za-z0-9]{{5}})_(?P<late>LATE_)?{_REST}")
_CANVAS_QUIZ = re.compile(r"(?P<name>.+?)_?(?P<id>\d+)_question")
_MOODLE = re.compile(
    r"(?P<name>.+?)_(?P<id>\d+)_assign(?P<kind>submission|feedback)_(?P<plugin>[a-z]+)"
    r"(?:_(?P<file>.*)|(?P<suffix>\.\w+))?"
)
_BLACKBOARD = re.compile(
    r"(?P<task>.+?)_(?P<user>[^_]+)_attempt_(?P<when>\d{4}(?:-\d\d){5})(?:_(?P<file>.+)|\.txt)"
)
_BRIGHTSPACE = re.compile(r"(?P<user>\d+)-(?P<folder>\d+) - (?P<rest>.+)")
_CLASSROOM = re.compile(r"(?P<name>.+?) - (?P<file>[^/]+)")
_CONVERTED = re.compile(r"\.(?:docx?|gdoc|odt|rtf|pdf|txt|html?)$", re.IGNORECASE)


Told = tuple[int, Label]  # where the name has said whose the entry is, and what it says


def read_name(manifest: Manifest, name: str) -> Label | None:
    """What the name of an entry says; None where it has no layout of a learning system.

    Students choose the end of a name, and could write there what another system puts in front. So
    the layout counts that says first whose the entry is.

    Args:
        manifest: of the assignment; Classroom's names are known by its files alone.
        name: of the entry, without folders.
    """
    name = unicodedata.normalize("NFC", name)
    if len(name) > LONGEST_NAME:
        return None
    found = [told for read in (_moodle, _blackboard, _brightspace, _canvas) if (told := read(name))]
    if found:
        return min(found, key=lambda told: told[0])[1]
    return _classroom(manifest, name)


def _moodle(name: str) -> Told | None:
    if not (found := _MOODLE.fullmatch(name)):
        return None
    is_work = (found["kind"], found["plugin"]) == ("submission", "file")
    is_text = (found["kind"], found["plugin"]) == ("submission", "onlinetext")
    role = WORK if is_work else TEXT if is_text else COMPANION
    file = found["file"] or (f"{found['plugin']}{found['suffix']}" if found["suffix"] else "")
    key = f"{found['id']} {found['name']}"
    return found.end("id"), Label("Moodle", role, found["name"], found["id"], key, file=file)


def _blackboard(name: str) -> Told | None:
    if not (found := _BLACKBOARD.fullmatch(name)):
        return None
    label = Label(
        "Blackboard",
        WORK if found["file"] else RECEIPT,
        found["user"],
        found["user"],
        f"{found['task']}_{found['user']}",
        attempt=found["when"],
        when=found["when"],
        file=found["file"] or name,
    )
    return found.end("user"), label


def _brightspace(name: str) -> Told | None:
    if name.lower() == "index.html":
        return 0, Label("Brightspace", COMPANION, "")
    if not (found := _BRIGHTSPACE.fullmatch(name)):
        return None
    parts = found["rest"].split(" - ")
    at = next((k for k, part in enumerate(parts) if looks_like_a_date(part)), None)
    who = parts[: 1 if at is None else at]
    file = " - ".join(parts[1:] if at is None else parts[at + 1 :])
    number = next((part for part in who[:-1] if re.search(r"\d", part)), found["user"])
    moment = "" if at is None else parts[at]
    student = who[-1] if who else found["user"]
    label = Label(
        "Brightspace",
        WORK,
        student,
        number,
        f"{found['user']} {student}",
        attempt=moment,
        when=moment_of(moment),
        file=file,
    )
    return found.end("folder"), label


def _canvas(name: str) -> Told | None:
    found = _CANVAS_ANONYMOUS.fullmatch(name) or _CANVAS.fullmatch(name)
    if found is None:
        return None
    order = found["order"]
    who = _CANVAS_QUIZ.fullmatch(found["name"]) if order else None
    student, number = (who or found)["name"], (who or found)["id"]
    label = Label(
        "Canvas",
        WORK if order else TEXT,
        student,
        number,
        f"{number} {student}",
        is_late=bool(found["late"]),
        when=(order or "").zfill(LONGEST_NAME),
        file=found["file"] or found["text"],
    )
    return found.end("id"), label


def _classroom(manifest: Manifest, name: str) -> Label | None:
    """Only files of the assignment: any other name with a dash is the student's own."""
    if not (found := _CLASSROOM.fullmatch(name)):
        return None
    plain = _CONVERTED.sub("", found["file"])
    wanted = {key_of(each) for each in wanted_names(manifest)}
    if not {key_of(as_wanted(manifest, each)) for each in (found["file"], plain)} & wanted:
        return None
    return Label("Classroom", WORK, found["name"], key=found["name"], file=found["file"])
