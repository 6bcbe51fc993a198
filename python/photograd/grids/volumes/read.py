"""One door to the readers, by the end of a file's name."""

from __future__ import annotations

from pathlib import Path

from photograd_course.input_files import require_file

from photograd.grids.volumes.mitsuba import read_mitsuba
from photograd.grids.volumes.nifti import read_nifti
from photograd.grids.volumes.volume import Volume, refuse
from photograd.grids.volumes.vtk import read_vtk

READERS = {".vtk": read_vtk, ".nii": read_nifti, ".nii.gz": read_nifti, ".vol": read_mitsuba}
SUFFIXES = tuple(READERS)


def read_volume(path: Path, *, memory_limit: int | None = None) -> Volume:
    """Read a regular volume.

    Args:
        path: .vtk (legacy, structured points), .nii or .nii.gz (NIfTI-1), .vol (Mitsuba).
        memory_limit: bytes that reading may take; what is available by default. It is compared
            with what the header states before values are read.

    Raises:
        IoError: no file, an unknown kind of file, a damaged one, one that needs more memory, values
            that are not finite.
    """
    name = path.name.lower()
    readers = [reader for suffix, reader in READERS.items() if name.endswith(suffix)]
    if not readers:
        raise refuse(path, f"a name that ends in one of {', '.join(SUFFIXES)}", path.suffix)
    require_file("read_volume", path)
    return readers[0](path, memory_limit=memory_limit)
