"""A submission as the grader keeps it: a few short files in memory, and what was left out."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from ..assignment.manifest import Manifest
from ..printable import printable
from ..student.folder import LOCK_NAME

SOURCE_BYTES = 200 << 10  # no program of a course written by hand is longer
OTHER_BYTES = 64 << 10
LISTED = 40  # ignored files named in a report


class Refused(Exception):
    """A submission that cannot be judged; the text tells its author what to do."""


@dataclass(frozen=True)
class Submission:
    """What was taken in.

    Attributes:
        files: by name; only names on the assignment's list, all of them UTF-8 text.
        problem: why the graded module cannot be judged; empty where it can.
        warnings: what else its author should know.
        ignored: files that were not taken, with reasons.
    """

    files: Mapping[str, bytes]
    problem: str = ""
    warnings: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()

    @property
    def digest(self) -> str:
        """SHA-256 of names and contents of what was taken."""
        total = hashlib.sha256()
        for name in sorted(self.files):
            total.update(f"{name}\0{len(self.files[name])}\0".encode() + self.files[name])
        return total.hexdigest()


def wanted_names(manifest: Manifest) -> tuple[str, ...]:
    """The names of an assignment's files, the lock on predictions among them."""
    return tuple(dict.fromkeys((f"{manifest.module}.py", *manifest.submission, LOCK_NAME)))


def size_limit(name: str) -> int:
    """Bytes that a file of this name may have."""
    return SOURCE_BYTES if name.endswith(".py") else OTHER_BYTES


def finish(manifest: Manifest, raw: Mapping[str, bytes], ignored: Collection[str]) -> Submission:
    """Look at the contents of what was taken.

    Args:
        manifest: of the assignment.
        raw: contents by name, within their limits.
        ignored: what was left out, with reasons.
    """
    module = f"{manifest.module}.py"
    files: dict[str, bytes] = {}
    warnings: list[str] = []
    problem = ""
    for name in wanted_names(manifest):
        if name not in raw:
            if name == module:
                problem = missing_module(manifest)
            elif name in manifest.submission and _matters(manifest, name):
                warnings.append(f"{name} is missing")
            continue
        fault = _fault(name, raw[name])
        if not fault:
            files[name] = raw[name].removeprefix(b"\xef\xbb\xbf")  # what Notepad adds
        elif name == module:
            problem = fault
        else:
            warnings.append(f"{fault}; it was left out")
    return Submission(files, problem, tuple(warnings), _shortened(ignored))


def missing_module(manifest: Manifest) -> str:
    """What is said about a submission without the graded module, where nothing better is known.

    Args:
        manifest: of the assignment.
    """
    return f"there is no {manifest.module}.py in the submission: hand in a file of this name"


def refused(text: str, ignored: Collection[str] = ()) -> Submission:
    """A submission of which nothing was taken."""
    return Submission({}, printable(text), (), _shortened(ignored))


def _matters(manifest: Manifest, name: str) -> bool:
    return name != "answers.toml" or manifest.points.get("questions", 0) > 0


def _fault(name: str, data: bytes) -> str:
    if b"\0" in data:
        at = data[: data.index(b"\0")].count(b"\n") + 1
        return f"{name}, line {at}: holds a NUL byte, so it is no text: save it as UTF-8"
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        at = data[: error.start].count(b"\n") + 1
        return f"{name}, line {at}: is not UTF-8: save it as UTF-8 in your editor"
    return ""


def _shortened(ignored: Collection[str]) -> tuple[str, ...]:
    listed = [printable(entry, 160) for entry in ignored]
    more = len(listed) - LISTED
    return tuple(listed if more <= 0 else [*listed[:LISTED], f"and {more} more"])
