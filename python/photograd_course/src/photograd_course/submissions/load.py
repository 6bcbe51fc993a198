"""Find the bundle that submissions of an assignment are judged with."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from ..assignment.brought import brought_sources
from ..assignment.bundle import PUBLIC_SECRET, Bundle, read_folder
from ..assignment.check_files import check_files
from ..assignment.manifest import Manifest, read_manifest
from ..build.kits import find_kit, kit_files, match_folder, no_sources, source_folders
from ..build.seal import open_bundle
from ..build.secret import read_secret
from ..errors import Error, IoError, SceneError, message

# What a verdict depends on, in a folder, besides its checks; a built bundle is one file.
JUDGING = ("assignment.toml", "questions.toml", "answers.py", "adapters.py", "hints.json")


@dataclass(frozen=True)
class Loaded:
    """Where bundles come from: one for each thread, since its modules may keep state.

    Attributes:
        read: gives a fresh one.
        digest: SHA-256 of what verdicts depend on, the secret among it, since seeds come from it.
        secret: of the course.
        place: where it lies; no worker may read there.
        starter: text of the graded module as students got it; empty where it is not known.
    """

    read: Callable[[], Bundle]
    digest: str
    secret: bytes
    place: Path
    starter: str = ""


def load(number: str, where: Path | None = None, secret_file: Path | None = None) -> Loaded:
    """The bundle of an assignment.

    Args:
        number: such as "01", or the assignment's name.
        where: a built bundle or an assignment's source folder; by default that of the checkout.
        secret_file: holds the course secret; without it hidden checks have the public seeds.

    Raises:
        IoError: it is not there.
        SceneError: it is of another assignment, or a kit without solution.
    """
    path = find_source(number) if where is None else where
    secret = PUBLIC_SECRET if secret_file is None else read_secret(secret_file)
    if path.is_dir():
        digest = _folder_digest(path, secret)
        loaded = Loaded(lambda: read_folder(path, secret=secret), digest, secret, path)
    else:
        loaded = _sealed(path, secret)
    bundle = loaded.read()
    if number not in _names_of(bundle.manifest):
        raise SceneError(message("grade", path.name, f"assignment {number}", bundle.manifest.id))
    if bundle.is_public:
        remedy = "give the sealed bundle with --bundle"
        raise SceneError(message("grade", path.name, "a bundle with the solution", "a kit", remedy))
    return replace(loaded, starter=_starter(path, bundle.manifest))


def find_source(number: str) -> Path:
    """The source folder of an assignment.

    Raises:
        IoError: there is none: this is no checkout.
        RangeError: there is no such assignment.
    """
    folders = source_folders()
    if not folders:
        raise no_sources("grade", number, ", or give a built bundle with --bundle")
    return folders[match_folder(number, list(folders))]


def _names_of(manifest: Manifest) -> set[str]:
    short = manifest.id.lstrip("0") or "0"
    return {manifest.id, short, manifest.name, manifest.folder_name}


def _starter(path: Path, manifest: Manifest) -> str:
    try:
        files = kit_files(path) if path.is_dir() else find_kit(manifest.id).files
        return files[f"{manifest.module}.py"].decode("utf-8")
    except (Error, KeyError, UnicodeDecodeError):
        return ""  # only the search for similar submissions uses it


def _folder_digest(folder: Path, secret: bytes) -> str:
    total = hashlib.sha256(_of_secret(secret))
    manifest = read_manifest(folder)
    names = sorted({*JUDGING, f"{manifest.module}.py"})
    data = {name: (folder / name).read_bytes() for name in names if (folder / name).is_file()}
    data |= {path: text.encode() for path, text in check_files(folder).items()}
    for name, text in brought_sources(folder, manifest).items():
        data[f"{name}.py"] = text.encode()
    for name, content in data.items():
        total.update(f"{name}\0{len(content)}\0".encode() + content)
    return total.hexdigest()


def _sealed(path: Path, secret: bytes) -> Loaded:
    try:
        data = path.read_bytes()
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message("grade", str(path), "a bundle or a folder", got)) from error
    digest = hashlib.sha256(_of_secret(secret) + data).hexdigest()
    # One reading for all, so that a file that changes meanwhile changes nothing.
    return Loaded(lambda: open_bundle(data, secret, path.name), digest, secret, path)


def _of_secret(secret: bytes) -> bytes:
    return hashlib.sha256(b"seeds\0" + secret).digest()
