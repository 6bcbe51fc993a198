"""Zip archives for attackers: any name, any kind of entry, always the same bytes."""

from __future__ import annotations

import io
import stat
import zipfile
from collections.abc import Iterable, Mapping

LINK = stat.S_IFLNK | 0o777
DEVICE = stat.S_IFCHR | 0o666
EPOCH = (2024, 1, 1, 0, 0, 0)


def zip_of(
    files: Mapping[str, str | bytes] | Iterable[tuple[str, str | bytes]],
    kinds: Mapping[str, int] | None = None,
) -> bytes:
    """A deflated archive of these entries, in order.

    Args:
        files: contents by name, or pairs, where a name may come twice.
        kinds: Unix modes of entries that are no plain files; the content of a link is its target.
    """
    pairs = files.items() if isinstance(files, Mapping) else files
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in pairs:
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = (kinds or {}).get(name, stat.S_IFREG | 0o644) << 16
            archive.writestr(entry, content)
    return memory.getvalue()
