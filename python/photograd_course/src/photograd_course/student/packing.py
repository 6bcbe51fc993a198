"""Pack a submission."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

from ..errors import IoError, message
from .kept import write_keeping

EPOCH = (1980, 1, 1, 0, 0, 0)  # so that the same files give the same archive


def pack(files: Mapping[str, bytes], target: Path) -> tuple[str, Path | None]:
    """Write the files into a zip archive; an earlier one of other content is kept beside it.

    Args:
        files: name to content.
        target: the archive.

    Returns:
        Its SHA-256, in hex, and where the earlier archive lies now; None if there was none.

    Raises:
        IoError: it cannot be written, or the target is a file that is no archive.
    """
    require_archive_or_free("submit", target)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content)
    kept = write_keeping(target, buffer.getvalue())
    return hashlib.sha256(buffer.getvalue()).hexdigest(), kept


def require_archive_or_free(function: str, target: Path) -> None:
    """Refuse to write an archive where something else lies: somebody's code, by a slip of --out.

    Args:
        function: for the message.
        target: what would be written.

    Raises:
        IoError: the target is there, and no zip archive.
    """
    if target.exists() and not (target.is_file() and zipfile.is_zipfile(target)):
        found = "a folder" if target.is_dir() else "a file of another kind"
        remedy = "nothing was written; give another name with --out"
        expected = "a new file, or a zip archive to replace"
        raise IoError(message(function, str(target), expected, found, remedy))
