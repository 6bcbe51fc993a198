"""The handout as a page to read in a browser."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from ..build.kits import Kit, source_root
from ..build.page.page import handout_page, with_figures
from ..build.public import PAGE, glossary
from ..errors import IoError, message
from .folder import find_folder
from .kept import write_keeping

TOOLS = ("latex2mathml", "markdown_it", "mdit_py_plugins")


def kit_page(files: Mapping[str, bytes]) -> bytes | None:
    """The handout's page with its figures inside; None where it cannot be made here.

    Args:
        files: of a kit. One from a wheel has the page; for another, from a checkout, it is made.
    """
    if PAGE in files:
        page = files[PAGE].decode("utf-8")
    elif "README.md" in files and all(find_spec(name) for name in TOOLS):
        root = source_root()
        page = handout_page(files["README.md"].decode("utf-8"), glossary(root) if root else {})
    else:
        return None
    return with_figures(page, files).encode("utf-8")


def page_to_read(kit: Kit, given: Path | None) -> Path:
    """Where the page lies: in the student's folder, else written into this one.

    Another page of that name, perhaps with notes in it, is kept beside the new one.

    Args:
        kit: of the assignment.
        given: the student's folder; by default this one, or that of the kit below it.

    Raises:
        IoError: the page cannot be made, or not be written.
    """
    try:
        target = find_folder(kit.manifest, given).path / PAGE
    except IoError:
        if given is not None:
            raise
        target = Path.cwd() / f"{kit.manifest.folder_name}.html"
    if target.name == PAGE and target.exists():
        return target
    page = kit_page(kit.files)
    if page is None:
        remedy = "pip install 'photograd-course[handouts]', or read README.md"
        found = "none of its makers" if "README.md" in kit.files else "no handout"
        raise IoError(message("read", kit.manifest.id, "a page", found, remedy))
    write_keeping(target, page)
    return target
