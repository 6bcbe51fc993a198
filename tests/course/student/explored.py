"""Explorations in folders of their own, with the solution where a student has a module."""

from __future__ import annotations

import ast
import shutil
import subprocess
import sys
from pathlib import Path

from photograd_course.assignment.manifest import read_manifest
from photograd_course.build.public import kit_files

from support.tree import ROOT

FOLDERS = {path.parent.name[:2]: path.parent for path in ROOT.glob("assignments/*/explore.py")}
NUMBERS = sorted(FOLDERS)
# Options with which an exploration takes seconds.
TINY: dict[str, dict[str, int]] = {
    "01": {"figure": 0},
    "02": {"figure": 0, "steps": 5},
    "03": {"figure": 0, "size": 12, "samples": 4, "steps": 3},
    "04": {"figure": 0, "pixels": 12, "steps": 3},
    "05": {"figure": 0, "triangles": 32, "size": 12, "rays": 20},
    "06": {"width": 32, "side": 1, "small": 32, "size": 64, "steps": 2, "samples": 4},
    "07": {"figure": 0, "size": 8, "samples": 1, "steps": 2},
    "08": {"figure": 0, "steps": 8, "size": 8},
    "09": {"figure": 0, "views": 4, "pixels": 8, "voxels": 6, "steps": 3},
    "10": {"figure": 0, "voxels": 8, "rounds": 2, "steps": 2, "views": 6, "size": 8},
    "11": {"figure": 0, "views": 4, "pixels": 4, "steps": 3, "coarse": 3, "levels": 2},
    "12": {"views": 3, "pixels": 6, "steps": 2, "shown": 12},
    "13": {"steps": 5, "size": 32, "log2": 8, "finest": 32, "cells": 16},
    "14": {"figure": 0, "cells": 24, "steps": 4, "samples": 40, "fit": 2},
    "15": {"pixels": 24, "steps": 10, "start": 60, "every": 5, "frames": 4, "max_count": 100},
}


def finished_kit(number: str, target: Path, *, with_core: bool = False) -> Path:
    """The student's folder, all of it written; by default the core cannot be loaded there."""
    folder = FOLDERS[number]
    for name, data in kit_files(folder).items():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_bytes(data)
    manifest = read_manifest(folder)
    shutil.copy(folder / f"{manifest.module}.py", target)
    for name in manifest.brought:
        (solved,) = ROOT.glob(f"assignments/*/{name}.py")
        shutil.copy(solved, target)
    if not with_core:
        (target / "photograd.py").write_text("raise ImportError\n", encoding="utf-8")
    return target


def explore(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """``python explore.py`` with some words, as a student runs it."""
    order = [sys.executable, "explore.py", *words]
    return subprocess.run(order, cwd=folder, capture_output=True, text=True, check=False)


def stated_options(script: str) -> dict[str, ast.expr]:
    """The options that an exploration states, by name."""
    (call,) = (node for node in ast.walk(ast.parse(script)) if is_options_call(node))
    return {str(each.arg): each.value for each in call.keywords}


def is_options_call(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and ast.unparse(node.func) == "explore.options"


def with_options(cell: str, changed: dict[str, int]) -> str:
    """A cell of a notebook with other numbers of options, as a student types them."""
    tree = ast.parse(cell)
    for call in (node for node in ast.walk(tree) if is_options_call(node)):
        for keyword in call.keywords:
            if keyword.arg in changed:
                number = ast.Constant(changed[keyword.arg])
                if isinstance(keyword.value, ast.Call):  # with bounds: the first is the default
                    keyword.value.args[0] = number
                else:
                    keyword.value = number
    return ast.unparse(tree)
