"""The folder in which a student works on one assignment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..assignment.manifest import Manifest
from ..assignment.questions import flat_answers
from ..assignment.toml import read_toml
from ..build.kits import list_manifests
from ..errors import IoError, message
from .origins import belongs_to_later

LOCK_NAME = "predictions.lock.json"
LARGEST_FILE = 200 << 10  # bytes; more is no program written by hand


@dataclass(frozen=True)
class WorkFolder:
    """Where the files of one assignment lie, and what is in them."""

    path: Path
    manifest: Manifest

    @property
    def module_path(self) -> Path:
        """The graded module."""
        return self.path / f"{self.manifest.module}.py"

    def source(self) -> str:
        """Text of the graded module.

        Raises:
            IoError: it is missing, too long, or not UTF-8.
        """
        return self._read(self.module_path).decode("utf-8")

    def files(self) -> dict[str, bytes]:
        """All files of the submission that are there, and the lock on predictions.

        Raises:
            IoError: the graded module is missing, or a file is too long or not UTF-8.
        """
        self.source()
        wanted = [*self.manifest.submission, LOCK_NAME]
        return {
            name: self._read(self.path / name) for name in wanted if (self.path / name).exists()
        }

    def answers(self) -> tuple[str, Mapping[str, Any]]:
        """The student's name and the answers, by id; empty where there is no `answers.toml`.

        Raises:
            IoError: the file is no TOML.
        """
        path = self.path / "answers.toml"
        if not path.exists():
            return "", {}
        table = read_toml(path)
        answers = table.get("answers", {})
        flat = flat_answers(answers) if isinstance(answers, dict) else {}
        return str(table.get("student", "")), flat

    def _read(self, path: Path) -> bytes:
        try:
            data = path.read_bytes()
        except OSError as error:
            remedy = f"run in the folder that 'photograd course start {self.manifest.id}' made"
            found = error.strerror or str(error)
            raise IoError(message("submission", path.name, "a file", found, remedy)) from error
        if len(data) > LARGEST_FILE:
            limit = f"at most {LARGEST_FILE >> 10} KB"
            raise IoError(message("submission", path.name, limit, f"{len(data) >> 10} KB"))
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as error:
            where = f"byte {error.start} is not"
            remedy = "save it as UTF-8 in your editor"
            raise IoError(message("submission", path.name, "UTF-8", where, remedy)) from error
        return data


def find_folder(manifest: Manifest, given: Path | None = None) -> WorkFolder:
    """The folder given, else this one if the graded module lies in it, else the kit's below it.

    Args:
        manifest: of the assignment.
        given: by --dir, or None.

    Raises:
        IoError: no such folder, or only that of a later assignment, which holds a copy.
    """
    here = Path.cwd()
    candidates = [here, here / manifest.folder_name] if given is None else [given]
    for candidate in candidates:
        if not (candidate / f"{manifest.module}.py").is_file():
            continue
        later = belongs_to_later(candidate.resolve(), manifest, list_manifests())
        if later is None:
            return WorkFolder(candidate, manifest)
        expected = f"the folder of assignment {manifest.id}"
        found = f"that of {later.id}, whose {manifest.module}.py is a copy"
        remedy = f"go to the folder of {manifest.id}, or give it with --dir"
        raise IoError(message("photograd course", str(candidate), expected, found, remedy))
    remedy = f"run 'photograd course start {manifest.id}' first, or give the folder with --dir"
    expected = f"a folder with {manifest.module}.py"
    raise IoError(message("photograd course", str(candidates[0]), expected, "none", remedy))
