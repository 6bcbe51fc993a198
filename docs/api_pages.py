"""Write the pages of the API reference into docs/api/, one for each package; Sphinx fills them.

Pages hold directives alone: docstrings and signatures come from the imported code.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS))

import api_names  # noqa: E402
import docstrings  # noqa: E402

FOLDER = DOCS / "api"
LONGEST_VALUE = 80


def pages() -> dict[str, str]:
    """Text of each page by the name of its package, or of its module where that has no package.

    A module directly below `photograd` or `photograd_course` has its own page.
    """
    found: dict[str, list[str]] = {}
    for module in api_names.modules().values():
        if api_names.is_documented(module.name):
            top_level = module.name.count(".") <= 1
            page = module.name if top_level else module.package
            found.setdefault(page, []).append(module.name)
    return {page: page_of(page, sorted(names)) for page, names in sorted(found.items())}


def page_of(page: str, names: list[str]) -> str:
    """The page of a package: its own section, then one for each module that has public names."""
    lines = [page, "=" * len(page), ""]
    for name in names:
        described = api_names.described_at(name)
        if name != page:
            if not described:
                continue
            lines += [name, "-" * len(name), ""]
        lines += [f".. automodule:: {name}", "   :no-members:"]
        # A function may have the name of its module, as photograd.capture.undistort.
        lines += ["   :no-index:", ""] if name in api_names.homes().values() else [""]
        if elsewhere := api_names.doors(name):
            roles = ", ".join(f":py:obj:`{home}`" for home in elsewhere)
            lines += [f"Also from here: {roles}.", ""]
        for kind, home in sorted(described, key=lambda pair: pair[0] == api_names.DATA):
            lines += _directive(kind, home)
    return "\n".join(lines)


def _directive(kind: str, home: str) -> list[str]:
    """What describes one name."""
    if kind == api_names.FUNCTION:
        return [f".. autofunction:: {home}", ""]
    if kind == api_names.CLASS:
        return [f".. autoclass:: {home}", "   :members:", "   :show-inheritance:", ""]
    module, _, name = home.rpartition(".")
    annotation, value, docstring = api_names.modules()[module].constants[name]
    lines = [f".. py:data:: {home}"]
    if 0 < len(value) <= LONGEST_VALUE:
        lines.append(f"   :value: {value}")
    text = docstrings.to_rst(docstring.split("\n")) if docstring else []
    if annotation:
        text += ["", f"Type: ``{annotation}``"]
    return [*lines, "", *(f"   {line}".rstrip() for line in text), ""]


def index(names: list[str]) -> str:
    """The first page: what each package is for, and the list for the sidebar."""
    lines = ["API reference", "=============", ""]
    for distribution in api_names.SOURCES:
        lines += [f".. rubric:: {distribution}", ""]
        for name in names:
            if name.split(".")[0] == distribution:
                summary = api_names.modules()[name].docstring.split("\n\n")[0]
                lines += [f":doc:`{name}`", f"   {' '.join(summary.split())}", ""]
    lines += [".. toctree::", "   :hidden:", "", *(f"   {name}" for name in names), ""]
    return "\n".join(lines)


def write(folder: Path = FOLDER) -> None:
    """Replace the folder's pages; a page whose text is the same keeps its date."""
    texts = pages()
    texts["index"] = index(list(texts))
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        if old.stem not in texts:
            shutil.rmtree(old) if old.is_dir() else old.unlink()
    for name, text in texts.items():
        path = folder / f"{name}.rst"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write()
