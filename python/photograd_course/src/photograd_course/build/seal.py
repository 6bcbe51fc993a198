"""The sealed bundle: all that grading takes, in a zip that refuses to be opened when altered.

`seal.json` names every file with its SHA-256 and every check and question with its points, and
carries an HMAC-SHA-256 of all this under the course secret. Who does not know the secret cannot
make a bundle that a grader would accept; what a check is worth comes from here alone.
"""

from __future__ import annotations

import hashlib
import hmac
import io
import json
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..assignment.brought import brought_sources
from ..assignment.bundle import Bundle
from ..assignment.check_files import check_files
from ..assignment.manifest import read_manifest
from ..errors import IoError, SceneError, message
from .archive import zip_bytes
from .kits import bundle_of

FORMAT = 1
LARGEST = 64 << 20  # bytes of all files together
FILES = ("assignment.toml", "questions.toml", "answers.py", "adapters.py")
# Of files in a bundle: the paths that `bundle_files` makes, and no way out of a folder.
_PLAIN = re.compile(r"(?:checks/(?:hidden/)?)?\w+\.\w+", re.ASCII)


class SealError(SceneError):
    """The bundle is damaged, altered, or sealed with another secret."""


def bundle_files(folder: Path, hints: Mapping[str, str]) -> dict[str, bytes]:
    """The files of a sealed bundle.

    Args:
        folder: the assignment's source.
        hints: the table of known mistakes for all checks.
    """
    names = [*FILES, f"{read_manifest(folder).module}.py"]
    files = {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}
    files |= {path: text.encode() for path, text in check_files(folder).items()}
    for name, text in brought_sources(folder, read_manifest(folder)).items():
        files[f"{name}.py"] = text.encode()
    return {**files, "hints.json": json.dumps(dict(hints), indent=1, sort_keys=True).encode()}


def seal_bundle(files: Mapping[str, bytes], secret: bytes) -> bytes:
    """The sealed zip.

    Args:
        files: from `bundle_files`.
        secret: of the course.
    """
    bundle = bundle_of(files, "bundle", secret=secret)
    body = {
        "format": FORMAT,
        **_totals(bundle),
        "files": {name: hashlib.sha256(data).hexdigest() for name, data in sorted(files.items())},
    }
    seal = json.dumps({**body, "hmac": _mac(body, secret)}, indent=1, sort_keys=True)
    return zip_bytes({**files, "seal.json": seal.encode()})


def read_bundle(path: Path, secret: bytes) -> Bundle:
    """The bundle of a sealed zip.

    Raises:
        IoError: the file cannot be read.
        SealError: it was altered, is incomplete, or belongs to another secret.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message("read_bundle", str(path), "a sealed bundle", got)) from error
    return open_bundle(data, secret, path.name)


def open_bundle(data: bytes, secret: bytes, name: str = "bundle") -> Bundle:
    """`read_bundle` for bytes in memory."""
    files = _unzip(data, name)
    if zip_bytes(files) != data:  # also what no reader of zips looks at
        raise _bad(name, "the very bytes that were sealed", "others")
    try:
        seal = json.loads(files.pop("seal.json"))
        mac, body = seal.pop("hmac"), seal
        listed = dict(body["files"])
    except (KeyError, ValueError, TypeError, AttributeError) as error:
        raise _bad(name, "seal.json as it was written", type(error).__name__) from error
    if not hmac.compare_digest(str(mac).encode(), _mac(body, secret).encode()):
        raise _bad(name, "the seal of this course's secret", "another one")
    if set(files) != set(listed):
        raise _bad(name, "exactly the sealed files", f"{sorted(set(files) ^ set(listed))} differ")
    for file, content in files.items():
        if hashlib.sha256(content).hexdigest() != listed[file]:
            raise _bad(name, f"{file} as it was sealed", "other bytes")
    bundle = bundle_of(files, name, secret=secret)
    if body.get("format") != FORMAT or any(body.get(k) != v for k, v in _totals(bundle).items()):
        raise _bad(name, "the checks and points of the seal", "others")
    return bundle


def _totals(bundle: Bundle) -> dict[str, Any]:
    """What is graded and for how much."""
    return {
        "assignment": bundle.manifest.id,
        "checks": [
            {"id": c.id, "task": c.task, "points": c.points, "visibility": c.visibility}
            for c in bundle.checks
        ],
        "questions": [{"id": q.id, "kind": q.kind, "points": q.points} for q in bundle.questions],
    }


def _unzip(data: bytes, name: str) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            infos = archive.infolist()
            names = [info.filename for info in infos]
            if len(set(names)) != len(names) or not all(map(_PLAIN.fullmatch, names)):
                raise _bad(name, "names as they were sealed, each once", f"{names[:20]}")
            if sum(info.file_size for info in infos) > LARGEST:
                raise _bad(name, f"at most {LARGEST >> 20} MB", "more")
            return {info.filename: archive.read(info) for info in infos}
    except SealError:
        raise
    except Exception as error:  # a damaged zip makes zipfile raise all kinds of things
        raise _bad(name, "a zip", f"{type(error).__name__}: {error}") from error


def _mac(body: Mapping[str, Any], secret: bytes) -> str:
    text = json.dumps(body, sort_keys=True, separators=(",", ":"))
    return hmac.new(b"seal|" + secret, text.encode(), hashlib.sha256).hexdigest()


def _bad(name: str, expected: str, got: str) -> SealError:
    return SealError(message("read_bundle", name, expected, got, "build it again"))
