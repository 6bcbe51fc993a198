"""Zips with the same bytes for the same files: sorted, without times, owners or compression.

Compression would make the bytes depend on the version of zlib; what is large here (pictures,
wheels) is compressed already.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Collection, Mapping

EPOCH = (1980, 1, 1, 0, 0, 0)  # the first moment that a zip can name


def zip_bytes(files: Mapping[str, bytes], executable: Collection[str] = ()) -> bytes:
    """A zip of files.

    Args:
        files: path to content.
        executable: paths that may be run.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path in sorted(files):
            info = zipfile.ZipInfo(path, EPOCH)
            info.create_system = 3  # Unix, on every system
            info.external_attr = (0o100755 if path in executable else 0o100644) << 16
            archive.writestr(info, files[path])
    return buffer.getvalue()
