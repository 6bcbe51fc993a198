"""Files of sparse grids: .vdb, as OpenVDB and Houdini write them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from photograd_course.atomic_io import atomic_write
from photograd_course.input_files import require_file

from photograd._compiled import _core
from photograd._memory import available_memory
from photograd._typed import typed_call
from photograd.errors import IoError, message
from photograd.grids.sparse import SparseGrid

Meta = bool | int | float | str


@typed_call
@dataclass(frozen=True)
class VdbFile:
    """The grids of a file in their order, and the metadata of the file itself."""

    grids: list[SparseGrid]
    metadata: dict[str, Meta] = field(default_factory=dict)

    def grid(self, name: str | None = None) -> SparseGrid:
        """The grid called `name`, or the first. Raises IoError if there is none."""
        for grid in self.grids:
            if name is None or grid.name == name:
                return grid
        wanted = "a grid" if name is None else f"a grid called '{name}'"
        names = ", ".join(f"'{grid.name}'" for grid in self.grids) or "none"
        raise IoError(message("VdbFile.grid", "name", wanted, names))


@typed_call
def read_vdb(path: Path, *, memory_limit: int | None = None) -> VdbFile:
    """Read all grids of a file.

    Args:
        path: the file.
        memory_limit: bytes that the grids may take; what is available by default. It is compared
            with what the file states (or, without that, with the most that it could need) before
            any tree is read.

    Raises:
        IoError: no file, a damaged one, one that needs more memory; a grid that is neither float
            nor vec3s, whose transform is not affine or cannot be inverted, or that is not finite.
    """
    require_file("read_vdb", path)
    limit = available_memory() if memory_limit is None else memory_limit
    try:
        found, metadata = _core.read_vdb(str(path), limit)
        grids = [SparseGrid(grid) for grid in found]
        for grid in grids:  # texts are decoded when they are looked at
            _ = grid.name, grid.metadata
    except UnicodeDecodeError as failure:
        raise IoError(
            message("read_vdb", f"{path}", "texts in UTF-8", "other bytes", "the file is damaged")
        ) from failure
    return VdbFile(grids, metadata)


@typed_call
def write_vdb(
    path: Path,
    grids: Sequence[SparseGrid],
    *,
    metadata: Mapping[str, Meta] | None = None,
    half: bool | None = None,
) -> None:
    """Write grids to a file, whole or not at all.

    Args:
        path: the file.
        grids: in the order of the file; names may repeat.
        metadata: of the file itself.
        half: store values in half precision; by default as each grid was stored when it was read.

    Raises:
        IoError: the file cannot be written.
        RangeError: values beyond 65504 in half precision.
    """

    def write(file: BinaryIO) -> None:
        # The core opens the neighbor that atomic_write has made, by its name.
        _core.write_vdb(file.name, [grid.core for grid in grids], dict(metadata or {}), half)

    atomic_write(Path(path), write)
