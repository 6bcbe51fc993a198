"""Pack a submission."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

from ..atomic_io import atomic_write

EPOCH = (1980, 1, 1, 0, 0, 0)  # so that the same files give the same archive


def pack(files: Mapping[str, bytes], target: Path) -> str:
    """Write the files into a zip archive and return its SHA-256, in hex.

    Raises:
        IoError: it cannot be written.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content)
    atomic_write(target, buffer.getvalue())
    return hashlib.sha256(buffer.getvalue()).hexdigest()
