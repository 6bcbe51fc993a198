"""A percent script as a notebook, the same bytes on every machine.

The format is nbformat 4.5 without outputs: cells begin at ``# %%``, cells of text at
``# %% [markdown]``, whose lines are comments. What jupytext makes of such a script, for the subset
that assignments use, but without needing it and without its version in the file. A notebook for
students begins with two cells more: what is graded, and how to install the course on Colab.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from typing import Any

GRADED = """\
**Graded is `{files}`, not this notebook.** Edit {it} in an editor beside the notebook, and save:
the next cell that you run reads {it} again. Options are the numbers in the cell that calls
`explore.options`; change them there, then run that cell and those after it.

On your own machine, start Jupyter or VS Code in the environment in which you installed the course,
and open the notebook in this folder. On Colab, upload this folder and the file
`photograd_course-....whl` of your course to Google Drive, mount the drive (the folder symbol at
the left), and change into the folder with `%cd /content/drive/MyDrive/...`. The next cell then
installs the course; elsewhere it does nothing."""
INSTALL = """\
import importlib.util

if importlib.util.find_spec("photograd_course") is None:
    %pip install --quiet photograd_course-*.whl"""


def notebook_of(script: str, graded: Sequence[str] = ()) -> str:
    """The notebook (JSON text) of a percent script.

    Args:
        script: its text.
        graded: the files that a student submits, such as "nerf.py", for the first two cells; where
            there are none, the notebook is the script alone.
    """
    parts = _split(script)
    if graded:
        files = "` and `".join(graded)
        said = GRADED.format(files=files, it="them" if len(graded) > 1 else "it")
        first = "markdown", [f"# {line}".rstrip() for line in said.split("\n")]
        parts = [parts[0], first, ("code", INSTALL.split("\n")), *parts[1:]]
    cells = [_cell(kind, lines, number) for number, (kind, lines) in enumerate(parts)]
    book = {
        "cells": cells,
        "metadata": {
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"name": "python"},
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(book, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def _split(script: str) -> list[tuple[str, list[str]]]:
    cells: list[tuple[str, list[str]]] = [("code", [])]
    for line in script.splitlines():
        if line.startswith("# %%"):
            cells.append(("markdown" if "[markdown]" in line else "code", []))
        else:
            cells[-1][1].append(line)
    trimmed = [(kind, _trim(lines)) for kind, lines in cells]
    return [(kind, lines) for kind, lines in trimmed if lines]


def _cell(kind: str, lines: list[str], number: int) -> dict[str, Any]:
    if kind == "markdown":
        lines = [line[2:] if line.startswith("# ") else line.lstrip("#") for line in lines]
    source = [line + "\n" for line in lines]
    source[-1] = source[-1].rstrip("\n")
    name = hashlib.sha256(f"{number}|{''.join(source)}".encode()).hexdigest()[:12]
    cell: dict[str, Any] = {"cell_type": kind, "id": name, "metadata": {}, "source": source}
    return cell if kind == "markdown" else {**cell, "execution_count": None, "outputs": []}


def _trim(lines: list[str]) -> list[str]:
    start, stop = 0, len(lines)
    while start < stop and not lines[start].strip():
        start += 1
    while stop > start and not lines[stop - 1].strip():
        stop -= 1
    return lines[start:stop]
