"""Compressed .ply files of words, written by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from plyfile import PlyData, PlyElement

LIMITS = [f"{end}_{axis}" for end in ("min", "max") for axis in "xyz"]
SCALES = [f"{end}_scale_{axis}" for end in ("min", "max") for axis in "xyz"]
COLORS = [f"{end}_{channel}" for end in ("min", "max") for channel in "rgb"]
WORDS = ["packed_position", "packed_rotation", "packed_scale", "packed_color"]


def write_words(
    path: Path,
    rows: list[tuple[int, ...]],
    *,
    colors: bool = False,
    rest: int = 0,
    chunks: int = 1,
    lowest: float = -2.0,
) -> None:
    """Chunks with positions of -2 to 2 (0 to 1 along y), scales of -6 to -1, colors of -1 to 3."""
    names = [*LIMITS, *SCALES, *(COLORS if colors else ())]
    values = [lowest, 0, -2, 2, 1, 2, *[-6] * 3, *[-1] * 3, *([-1] * 3 + [3] * 3 if colors else ())]
    chunk = np.array([tuple(values)] * chunks, [(name, "<f4") for name in names])
    vertex = np.array(rows, [(name, "<u4") for name in WORDS])
    elements = [PlyElement.describe(chunk, "chunk"), PlyElement.describe(vertex, "vertex")]
    if rest:
        table = np.zeros(len(rows), [(f"f_rest_{i}", "u1") for i in range(rest)])
        for i in range(rest):
            table[f"f_rest_{i}"] = (0, 255, 128, 10 * i)[i % 4]
        elements.append(PlyElement.describe(table, "sh"))
    PlyData(elements).write(str(path))


ROW = (
    2047 << 21 | 0 << 11 | 1024,  # x at its upper limit, y at its lower, z in the middle
    2 << 30 | 1023 << 20 | 511 << 10 | 511,  # the largest is y; w is sqrt(1/2)
    0 << 21 | 1023 << 11 | 2047,
    255 << 24 | 51 << 16 | 0 << 8 | 204,
)
