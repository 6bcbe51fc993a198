"""The include order, as functions from source texts to breaches, so that they can be tested."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from pathlib import PurePosixPath

# A module may include what stands to its left, and itself; neighbors in one group stay apart.
ORDER: tuple[tuple[str, ...], ...] = (
    ("core",),
    ("ops",),
    ("geometry", "grid", "texture", "camera", "sampling"),
    ("bsdf", "medium", "network"),
    ("light", "field", "splat", "optim", "raster", "vector"),
    ("scene",),
    ("render",),
    ("frame",),
    ("bindings",),
)
RANK = {module: rank for rank, group in enumerate(ORDER) for module in group}
# Kernels are the vectorized twins of loops in these modules; only they may call them.
KERNEL_USERS = {
    *("kernels", "texture", "network", "raster", "render", "frame"),
    *("bindings", "tests", "bench"),
}
# What a kernel file may see: plain values and lanes, the layout of a grid, the tiles of splats.
KERNEL_SOURCES = {"kernels", "core", "ops", "grid", "splat"}

# Each third-party library has one door.
DOORS: dict[str, tuple[str, ...]] = {
    r"glm/": ("photograd/core/vec.h",),
    r"(tbb|oneapi)/": ("photograd/core/parallel.h", "photograd/core/parallel.cpp"),
    r"embree[34]/": ("photograd/geometry/bvh.cpp",),
    r"(openvdb|nanovdb)/": (
        "photograd/grid/openvdb_grid.h",
        "photograd/grid/sparse_grid.cpp",
        "photograd/grid/vdb_file.cpp",
    ),
    r"pybind11/|Python\.h": ("bindings/",),
}

_INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def module_of(path: str) -> str:
    """Module of a path from `cpp/`: "photograd/ops/sh.h" gives "ops", "bindings/x.h" "bindings"."""
    parts = PurePosixPath(path).parts
    return parts[1] if parts[0] == "photograd" else parts[0]


def cpp_breaches(texts: Mapping[str, str]) -> list[str]:
    """One line for each include that breaks the order or passes a library beside its door."""
    found = []
    for path, text in texts.items():
        for mark, target in _INCLUDE.findall(text):
            reason = _library_breach(path, target) if mark == "<" else _own_breach(path, target)
            if reason:
                found.append(f"cpp/{path} includes {target}: {reason}")
    return found


def _library_breach(path: str, target: str) -> str | None:
    for pattern, doors in DOORS.items():
        if re.match(pattern, target) and not path.startswith(doors):
            return f"the only door is {' and '.join(doors)}"
    return None


def _own_breach(path: str, target: str) -> str | None:
    source = module_of(path)
    if "/" not in target:  # a neighbor in the same folder
        return None if source in {"bindings", "tests", "bench"} else "write the path from cpp/"
    goal = module_of(target)
    if source in {"tests", "bench"} or source == goal:
        return None
    if source == "kernels":
        return None if goal in KERNEL_SOURCES else f"a kernel does not see {goal}"
    if goal == "kernels":
        return None if source in KERNEL_USERS else "only renderers and bindings use kernels"
    if source not in RANK or goal not in RANK:
        return f"{source if source not in RANK else goal} has no place in the include order"
    if RANK[goal] > RANK[source]:
        return f"{goal} stands above {source}"
    return f"{source} and {goal} are neighbors" if RANK[goal] == RANK[source] else None


def imported(text: str) -> set[str]:
    """Top-level packages that a Python source imports; relative imports are left out."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.split(".")[0])
    return names


def python_breaches(texts: Mapping[str, str], allowed: Mapping[str, set[str]]) -> list[str]:
    """One line for each import of what `allowed` does not list for the folder of its file."""
    return [
        f"{path} imports {name}"
        for path, text in texts.items()
        for folder, names in allowed.items()
        if path.startswith(folder)
        for name in sorted(imported(text) - names)
    ]
