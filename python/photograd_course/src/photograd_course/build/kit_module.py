"""Modules of a kit's `data/`, for figures that show what the kit makes."""

from __future__ import annotations

from types import ModuleType

from ..assignment.load import load_module
from .kits import source_folders


def kit_module(folder: str, name: str) -> ModuleType:
    """A module that students get in `data/`.

    Args:
        folder: of the assignment, such as "12_nerf".
        name: of the module, without ".py".
    """
    file = source_folders()[folder] / "data" / f"{name}.py"
    return load_module(name, file.read_text("utf-8"))
