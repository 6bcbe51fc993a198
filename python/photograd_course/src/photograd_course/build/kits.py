"""Find an assignment's kit: in an installed wheel ready-made, in a checkout stripped on the fly."""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ..assignment.bundle import Bundle, read_folder
from ..assignment.manifest import Manifest, read_manifest
from ..assignment.toml import read_toml
from ..errors import IoError, RangeError, SceneError, message
from ..suggest import choose_from
from .public import kit_files, public_files

__all__ = ["Kit", "find_kit", "kit_files", "list_kits", "public_files", "source_folders"]

PACKAGE = Path(__file__).resolve().parents[1]
PLAN = "course.toml"  # which assignments there are and will be
ENVIRONMENT = "PHOTOGRAD_ASSIGNMENTS"  # a folder of assignments other than the built-in one


@dataclass(frozen=True)
class Kit:
    """What a student gets.

    Attributes:
        manifest: of the assignment.
        files: of the student's folder, path to content.
        bundle: the public checks and questions.
        digest: of the files that these come from.
    """

    manifest: Manifest
    files: Mapping[str, bytes]
    bundle: Bundle
    digest: str


def list_kits(root: Path | None = None) -> list[str]:
    """Folder names such as "01_gradient_descent", in order.

    Args:
        root: as for `list_manifests`.
    """
    return sorted(_places(root))


def list_manifests(root: Path | None = None) -> list[Manifest]:
    """The manifests of all assignments that can be started here, in order.

    One that cannot be read is left out: it says so where it is asked for itself.

    Args:
        root: a folder of assignments, or None for those that are here.
    """
    found = []
    for folder in manifest_folders(root).values():
        with contextlib.suppress(IoError, SceneError):
            found.append(read_manifest(folder))
    return found


def manifest_folders(root: Path | None = None) -> dict[str, Path]:
    """Where the manifest of each assignment lies, by folder name: in its source, or in a wheel.

    Args:
        root: as for `list_manifests`.
    """
    return {
        name: place / "public" if (place / "kit").is_dir() else place
        for name, place in sorted(_places(root).items())
    }


def find_kit(id_or_name: str, root: Path | None = None) -> Kit:
    """The kit of an assignment.

    Args:
        id_or_name: "01", "1", "gradient_descent" or "01_gradient_descent".
        root: a folder of assignments; by default that of the checkout, or the installed kits.

    Raises:
        RangeError: there is no such assignment.
        IoError, SceneError: its files are wrong.
    """
    places = _places(root)
    require_ready(id_or_name, list(places), root)
    name = match_folder(id_or_name, list(places))
    place = places[name]
    if (place / "kit").is_dir():  # a wheel's
        files, public = _read_tree(place / "kit"), _read_tree(place / "public")
    else:
        files, public = kit_files(place), public_files(place)
    bundle = bundle_of(public, name)
    digests = [f"{path} {hashlib.sha256(data).hexdigest()}" for path, data in public.items()]
    digest = hashlib.sha256("\n".join(digests).encode()).hexdigest()
    return Kit(bundle.manifest, files, bundle, digest)


def require_ready(id_or_name: str, folders: list[str], root: Path | None = None) -> None:
    """Refuse an assignment that the course plans and does not have yet.

    Args:
        id_or_name: as for `find_kit`.
        folders: names of those that are ready.
        root: a folder of assignments, or None.

    Raises:
        RangeError: it is planned.
    """
    for entry in _plan(root):
        number, title = str(entry.get("id", "")), str(entry.get("title", ""))
        is_ready = any(folder.startswith(f"{number}_") for folder in folders)
        if not is_ready and id_or_name in {number, number.lstrip("0")}:
            ready = ", ".join(folder.partition("_")[0] for folder in folders)
            raise RangeError(
                message(
                    "photograd course",
                    "assignment",
                    "one that is ready",
                    f"{number}, {title}, which is planned",
                    f"choose one of {ready}",
                )
            )


def _plan(root: Path | None) -> list[Mapping[str, object]]:
    """The assignments that the course plans, as its file names them; none where it has no file."""
    top = plan_folder(root)
    entries = read_toml(top / PLAN).get("assignment", []) if top else []
    return [entry for entry in entries if isinstance(entry, dict)]


def plan_folder(root: Path | None = None) -> Path | None:
    """Where the plan of the course lies: among its sources, or with the kits of a wheel.

    Args:
        root: as for `list_manifests`.
    """
    tops = (root or source_root(), PACKAGE / "kits")
    return next((top for top in tops if top is not None and (top / PLAN).is_file()), None)


def match_folder(id_or_name: str, folders: list[str]) -> str:
    """Which of the folders "NN_name" is meant.

    Raises:
        RangeError: none.
    """
    for folder in folders:
        number, _, name = folder.partition("_")
        if id_or_name in {folder, name, number, str(int(number))}:
            return folder
    remedy = choose_from(id_or_name, folders) if folders else "none is there"
    expected = "one that exists"
    raise RangeError(message("photograd course", "assignment", expected, repr(id_or_name), remedy))


def source_folders(root: Path | None = None) -> dict[str, Path]:
    """Assignments in source, by folder name; empty in an installed wheel.

    Args:
        root: as for `list_manifests`.
    """
    top = root or source_root()
    if top is None or not top.is_dir():
        return {}
    found = [path for path in top.iterdir() if (path / "assignment.toml").exists()]
    return {path.name: path for path in sorted(found) if path.name[:2].isdigit()}


def source_root() -> Path | None:
    """The folder of assignments named by the environment, or that of the checkout, if any."""
    if given := os.environ.get(ENVIRONMENT):
        return Path(given)
    if len(PACKAGE.parents) > 3 and (PACKAGE.parents[1] / "pyproject.toml").exists():
        checkout = PACKAGE.parents[3] / "assignments"
        return checkout if checkout.is_dir() else None
    return None


def no_sources(function: str, argument: str, more: str = "") -> IoError:
    """The error for a command that needs assignments in source and finds none.

    Args:
        function, argument: as for `message`.
        more: what else can be done.
    """
    expected = "assignments in source"
    remedy = f"install from a checkout with 'pip install -e', or set {ENVIRONMENT} to their folder"
    return IoError(message(function, argument, expected, "none", remedy + more))


def bundle_of(files: Mapping[str, bytes], name: str, *, secret: bytes | None = None) -> Bundle:
    """A bundle from files in memory, which touch the disk for a moment in a private folder.

    Args:
        files: path to content.
        name: what the manifest gives as its folder.
        secret: the course's, for a sealed bundle; None for a public one.
    """
    with tempfile.TemporaryDirectory(prefix="photograd-") as scratch:
        folder = Path(scratch)
        for path, content in files.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(content)
        bundle = read_folder(folder) if secret is None else read_folder(folder, secret=secret)
    return replace(bundle, manifest=replace(bundle.manifest, folder=Path(name)))


def _places(root: Path | None) -> dict[str, Path]:
    if found := source_folders(root):
        return found
    installed = root or PACKAGE / "kits"
    if not installed.is_dir():
        return {}
    return {path.name: path for path in sorted(installed.iterdir()) if (path / "kit").is_dir()}


def _read_tree(top: Path) -> dict[str, bytes]:
    # What pip compiles while it installs a wheel is no part of a kit.
    files = (path for path in top.rglob("*") if path.is_file())
    paths = sorted(path for path in files if path.parent.name != "__pycache__")
    return {path.relative_to(top).as_posix(): path.read_bytes() for path in paths}
