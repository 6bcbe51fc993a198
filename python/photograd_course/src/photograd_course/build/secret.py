"""The course secret: seeds of hidden checks, salt of hints, key of seals. One for a course."""

from __future__ import annotations

import os
import secrets
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..atomic_io import atomic_write
from ..errors import IoError, SceneError, message

ENVIRONMENT = "PHOTOGRAD_COURSE_SECRET"
FILE = "secret.txt"
BYTES = 32
LEAST = 16  # characters; fewer are no secret


class CourseSecret(NamedTuple):
    """The secret of a course.

    Attributes:
        value: what seeds and seals are made from.
        place: the file it stands in; None where the environment gives it.
        is_new: whether it was made just now.
    """

    value: bytes
    place: Path | None
    is_new: bool = False

    def explained(self) -> str:
        """Where it stands, and what an instructor should know of it."""
        if self.place is None:
            return f"course secret: that of ${ENVIRONMENT}"
        if not self.is_new:
            return f"course secret: {self.place}"
        return (
            f"course secret: made in {self.place}. Seeds of hidden checks and seals of bundles "
            "come from it: keep it for as long as the course is taught, give it to every machine "
            "that builds or grades (--secret-file), and to no student. Under another secret, "
            "submissions meet other numbers, and bundles do not open."
        )


def course_secret(path: Path | None, places: Sequence[Path]) -> CourseSecret:
    """The secret, made where there is none.

    Args:
        path: a file named by the instructor, made if it is not there.
        places: files where it may stand if no file is named and the environment holds none: the
            first one that is there is read, else the last one is made.

    Raises:
        IoError: the file cannot be read or written.
        SceneError: it is too short.
    """
    if path is None and (given := os.environ.get(ENVIRONMENT, "").strip()):
        return CourseSecret(_long_enough(given.encode(), ENVIRONMENT), None)
    candidates = [path] if path is not None else list(places)
    place = next((each for each in candidates if each.exists()), candidates[-1])
    is_new = not place.exists()
    if is_new:
        make_secret(place)
    return CourseSecret(read_secret(place), place, is_new)


def secret_beside(products: Path) -> Path:
    """Where the secret of a folder of products stands by default: in a folder of its own."""
    return products.with_name(f"{products.name}.secret") / FILE


def read_secret(path: Path) -> bytes:
    """The bytes of a file without blanks around them.

    Raises:
        IoError: it cannot be read.
        SceneError: it is too short.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message("read_secret", str(path), "a file", got)) from error
    return _long_enough(data.strip(), path.name)


def make_secret(path: Path) -> None:
    """Write a new secret, readable by its owner alone; a folder made for it is ignored by git.

    Raises:
        IoError: it cannot be written.
    """
    try:
        if not path.parent.exists():
            path.parent.mkdir(parents=True)
            atomic_write(path.parent / ".gitignore", b"*\n")
        # Whole or not at all: half a secret would be refused from then on.
        fresh = path.with_name(f".{path.name}.{os.getpid()}.new")
        fresh.unlink(missing_ok=True)
        handle = os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "w", encoding="ascii") as file:
            file.write(secrets.token_hex(BYTES) + "\n")
            file.flush()
            os.fsync(file.fileno())
        fresh.rename(path)
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message("make_secret", str(path), "a new file", got)) from error


def _long_enough(secret: bytes, where: str) -> bytes:
    if len(secret) < LEAST:
        wanted = f"a secret of at least {LEAST} characters"
        raise SceneError(message("read_secret", where, wanted, f"{len(secret)}"))
    return secret
