"""The course secret: seeds of hidden checks, salt of hints, key of seals. One for a course."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from ..atomic_io import atomic_write
from ..errors import IoError, SceneError, message

ENVIRONMENT = "PHOTOGRAD_COURSE_SECRET"
BYTES = 32
LEAST = 16  # characters; fewer are no secret


def course_secret(path: Path | None, out: Path) -> tuple[bytes, Path | None]:
    """The secret, made where there is none, and the file it stands in (None: the environment).

    Args:
        path: a file given by the instructor; it must exist.
        out: the folder of products; by default the secret lies beside it, in a folder of its own
            that git ignores.

    Raises:
        IoError: the file cannot be read or written.
        SceneError: it is too short.
    """
    if path is not None:
        return read_secret(path), path
    if given := os.environ.get(ENVIRONMENT, "").strip():
        return _long_enough(given.encode(), ENVIRONMENT), None
    place = out.with_name(f"{out.name}.secret") / "secret.txt"
    if not place.exists():
        make_secret(place)
    return read_secret(place), place


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
    """Write a new secret, readable by its owner alone, in a folder that git ignores.

    Raises:
        IoError: it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
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
