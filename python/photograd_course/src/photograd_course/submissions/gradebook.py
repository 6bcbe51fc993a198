"""Fill a gradebook that a learning system exported, so that it can be imported there again.

Canvas       Student, ID, SIS User ID, SIS Login ID, Section, and a column for each assignment
Moodle       the grading worksheet (Identifier, Full name, ..., Grade), or the gradebook's export
Blackboard   Last Name, First Name, Username, Student ID, and columns
Brightspace  OrgDefinedId, Username, and columns

Rows are found by number, then by address, then by name, and never by a name that several bear.
Cells other than those of the one column stay as they are.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..assignment.manifest import Manifest
from ..errors import IoError, SceneError, message
from ..input_files import read_file
from .source import Person

LARGEST_GRADEBOOK = 32 << 20  # bytes
_IDS = (
    *("id", "sis user id", "sis login id", "integration id", "identifier", "id number"),
    *("idnumber", "username", "student id", "orgdefinedid"),
)
_EMAILS = ("email address", "email", "sis login id", "e-mail")
_NAMES = ("student", "full name", "name")
_FIRST, _LAST = ("first name", "firstname"), ("last name", "surname", "lastname")
_OTHER = ("section", "status", "institution", "department", "availability", "child course id")
_CLOSED = ("maximum grade", "grade can be changed", "last modified", "last downloaded", "feedback")
_IDENTITY = {*_IDS, *_EMAILS, *_NAMES, *_FIRST, *_LAST, *_OTHER}


@dataclass(frozen=True)
class Score:
    """What a submission is worth to its students; None where nobody knows yet."""

    student: str
    people: tuple[Person, ...]
    points: float | None


@dataclass(frozen=True)
class Filled:
    """A gradebook with scores.

    Attributes:
        data: the file to import.
        count: rows that got one.
        unmatched: student and reason, for everyone whose score stands nowhere in it.
    """

    data: bytes
    count: int
    unmatched: tuple[tuple[str, str], ...]


class Gradebook:
    """An exported table, and the column that gets the scores."""

    def __init__(
        self, header: Sequence[str], rows: Sequence[list[str]], column: int, delimiter: str = ","
    ) -> None:
        self.header, self.rows = list(header), [list(row) for row in rows]
        self.column, self.delimiter = column, delimiter

    @property
    def max_score(self) -> float | None:
        """What it says that the assignment is worth; None where it does not say."""
        told = [self._cell(row, "maximum grade") for row in self.rows]
        told += [row[self.column] for row in self.rows if _is_points_possible(row)]
        known = {float(text.replace(",", ".")) for text in told if _is_number(text)}
        return known.pop() if len(known) == 1 else None

    def late(self, people: Iterable[Person]) -> set[Person]:
        """Those of the `people` whose row says so: Moodle's worksheet does, in its status."""
        people = list(people)
        finder = _Finder(self, people)
        found = {person: finder.row_of(person)[0] for person in people}
        return {
            person
            for person, row in found.items()
            if row is not None and "late" in self._cell(self.rows[row], "status").lower().split()
        }

    def fill(self, scores: Iterable[Score]) -> Filled:
        """The gradebook with scores.

        Args:
            scores: of all submissions; each goes into the row of everyone whose it is.
        """
        scores = list(scores)
        finder = _Finder(self, [person for score in scores for person in score.people])
        found: dict[int, list[tuple[str, float]]] = {}
        unmatched: list[tuple[str, str]] = []
        for score in scores:
            for person in score.people:
                row, why = finder.row_of(person)
                if row is None:
                    unmatched.append((score.student, why))
                elif score.points is None:
                    unmatched.append((score.student, "has no score, since the grader failed"))
                else:
                    found.setdefault(row, []).append((score.student, score.points))
        count = 0
        for at, several in found.items():
            if len(several) > 1:
                names = ", ".join(student for student, _ in several)
                why = f"one row of the gradebook for several submissions ({names})"
                unmatched += [(student, why) for student, _ in several]
            else:
                self.rows[at][self.column] = self._written(several[0][1])
                count += 1
        return Filled(self._bytes(), count, tuple(unmatched))

    def cells(self, row: Sequence[str], names: Sequence[str]) -> list[str]:
        """The cells of a row in columns of these names, without what surrounds them."""
        told = [self._cell(row, name) for name in names]
        return [text for text in told if text]

    def _cell(self, row: Sequence[str], name: str) -> str:
        at = next((k for k, each in enumerate(self.header) if _plain(each) == name), None)
        return "" if at is None else row[at].strip()

    def _written(self, points: float) -> str:
        has_comma = any("," in self._cell(row, "maximum grade") for row in self.rows)
        text = f"{points:.6f}".rstrip("0").rstrip(".")
        return text.replace(".", ",") if has_comma else text

    def _bytes(self) -> bytes:
        kept = list(range(len(self.header)))
        if {"student", "section"} <= {_plain(name) for name in self.header}:
            # Canvas: other columns would write back the grades of the day of the export.
            kept = [k for k in kept if k == self.column or _plain(self.header[k]) in _IDENTITY]
        text = io.StringIO()
        writer = csv.writer(text, delimiter=self.delimiter, lineterminator="\n")
        writer.writerows([row[k] for k in kept] for row in [self.header, *self.rows])
        return text.getvalue().encode()


class _Finder:
    """Rows by number, address and name."""

    def __init__(self, book: Gradebook, people: Sequence[Person]) -> None:
        self._ids: dict[str, set[int]] = {}
        self._emails: dict[str, set[int]] = {}
        self._names: dict[str, set[int]] = {}
        for at, row in enumerate(book.rows):
            if _is_points_possible(row):
                continue
            for text in book.cells(row, _IDS):
                self._ids.setdefault(_id_key(text), set()).add(at)
            for text in book.cells(row, _EMAILS):
                self._emails.setdefault(text.casefold(), set()).add(at)
            for name in _names_of(book, row):
                self._names.setdefault(name, set()).add(at)
        # Whether numbers here are those that submissions have: then one that is absent is no
        # reason to go by name.
        self._same_ids = any(_id_key(each.id) in self._ids for each in people if each.id)

    def row_of(self, person: Person) -> tuple[int | None, str]:
        """Its row; or None and why."""
        if person.id and (rows := self._ids.get(_id_key(person.id))):
            return _only(rows, f"the number {person.id}")
        if person.email and (rows := self._emails.get(person.email.casefold())):
            return _only(rows, f"the address {person.email}")
        if person.id and self._same_ids:
            return None, f"the number {person.id} is not in the gradebook"
        if rows := self._names.get(_squashed(person.name)):
            return _only(rows, f"the name {person.name}")
        return None, f"{person.name} is not in the gradebook"


def read_gradebook(path: Path, manifest: Manifest, column: str | None = None) -> Gradebook:
    """A gradebook, ready for scores.

    Args:
        path: of the CSV file that the learning system exported.
        manifest: of the assignment; by its title or name the column is found.
        column: its heading, or a part of it that no other has.

    Raises:
        IoError: the file cannot be read.
        SceneError: it names no students, or the column is not there or not the only one.
    """
    data = read_file("grade", path, LARGEST_GRADEBOOK + 1)
    if len(data) > LARGEST_GRADEBOOK:
        raise IoError(message("grade", path.name, f"at most {LARGEST_GRADEBOOK >> 20} MB", "more"))
    try:
        text = data.decode("utf-8-sig")
        first = text.partition("\n")[0]
        delimiter = max(",;\t", key=first.count)
        table = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))
    except (UnicodeDecodeError, csv.Error) as error:
        raise IoError(message("grade", str(path), "a CSV table", str(error))) from error
    header, rows = (table[0], table[1:]) if table else ([], [])
    if not {_plain(name) for name in header} & {*_IDS, *_EMAILS, *_NAMES}:
        remedy = "export it from Canvas, Moodle, Blackboard or Brightspace"
        expected = "a gradebook with a column such as ID, Identifier, Student or Email address"
        raise SceneError(message("grade", path.name, expected, ", ".join(header[:6]), remedy))
    filled = [[*row, *[""] * (len(header) - len(row))] for row in rows if any(row)]
    return Gradebook(header, filled, _column(path, header, manifest, column), delimiter)


def _column(path: Path, header: Sequence[str], manifest: Manifest, wanted: str | None) -> int:
    open_ones = [k for k, name in enumerate(header) if _may_hold_scores(name)]
    if wanted is not None:
        exact = [k for k in open_ones if _plain(header[k]) == _plain(wanted)]
        found = exact or [k for k in open_ones if _squashed(wanted) in _squashed(header[k])]
    else:
        found = [k for k in open_ones if _plain(header[k]) == "grade"]
        titles = {_squashed(manifest.title), _squashed(manifest.folder_name)}
        found = found or [k for k in open_ones if any(t in _squashed(header[k]) for t in titles)]
    if len(found) == 1:
        return found[0]
    names = ", ".join(header[k] for k in (found or open_ones)[:6]) or "none"
    expected = f"one column for {wanted or manifest.title}"
    remedy = "name it with --gradebook-column"
    raise SceneError(message("grade", path.name, expected, names, remedy))


def _may_hold_scores(name: str) -> bool:
    plain = _plain(name)
    closed = (
        "maximum grade",
        "grade can be changed",
        "last modified",
        "last downloaded",
        "feedback",
    )
    is_closed = plain.startswith(closed) or plain in ("online text", "end-of-line indicator")
    is_total = plain.endswith((" score", " points", " grade")) and plain.startswith(
        ("current ", "final ", "unposted ", "override ")
    )
    return bool(plain) and plain not in _IDENTITY and not is_closed and not is_total


def _names_of(book: Gradebook, row: Sequence[str]) -> set[str]:
    """A row's names as they may be written: either way around, without what is no letter."""
    told = book.cells(row, _NAMES)
    first, last = book.cells(row, _FIRST)[:1], book.cells(row, _LAST)[:1]
    if first and last:
        told.append(f"{last[0]}, {first[0]}")
    found = {_squashed(name) for name in told}
    for name in told:
        before, comma, after = name.partition(",")
        found |= {_squashed(after + before)} if comma else set()
        words = name.split()
        found |= {_squashed(words[-1] + "".join(words[:-1]))} if not comma else set()
    return {name for name in found if name}


def _only(rows: set[int], what: str) -> tuple[int | None, str]:
    if len(rows) == 1:
        return next(iter(rows)), ""
    return None, f"{what} is in {len(rows)} rows of the gradebook"


def _is_points_possible(row: Sequence[str]) -> bool:
    return bool(row) and row[0].strip().casefold() == "points possible"


def _is_number(text: str) -> bool:
    return bool(re.fullmatch(r"\s*\d+(?:[.,]\d+)?\s*", text))


def _id_key(text: str) -> str:
    """A number or login: "Participant 5" of Moodle and "#5" of Brightspace are "5"."""
    return text.strip().casefold().removeprefix("participant ").removeprefix("#")


def _plain(name: str) -> str:
    return " ".join(name.split()).casefold()


def _squashed(text: str) -> str:
    plain = unicodedata.normalize("NFKD", text).casefold()
    return "".join(char for char in plain if char.isalnum())
