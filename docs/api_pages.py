"""Write the pages of the API reference into docs/api/, one for each package; Sphinx fills them.

Pages hold directives alone: docstrings and signatures come from the imported code.
"""

from __future__ import annotations

import ast
import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS))

import api_names  # noqa: E402
import docstrings  # noqa: E402

FOLDER = DOCS / "api"
LONGEST_VALUE = 80
FILES = re.compile(
    r"(?<![\w/])(?:(?:cpp|docs|tests|tools|python)/[\w/.]+|\w+\.(?:h|inl|cpp))(?![\w>`])"
)
"""What a docstring must not name, once files of the core and pages are links."""

DOOR = {
    "Photographs": "load_capture Capture View Camera estimate_bounds read_image",
    "Fitting": "fit evaluate render load_model Model Fit FitOptions",
    "Path tracing": "read_scene builtin_scene read_model PathTracer PathOptions Scene Material",
    "Inverse rendering": "recover Target Parameter RecoveryOptions",
    "Representations": "representations check_gradients Representation DenseGrid SparseSh OctreeSh "
    "GaussianScene Gaussians",
    "Meshes, errors": "Mesh Bvh Error",
}
"""The names at the door of `photograd` by what they are for, in the order of the page."""


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
        if name == "photograd":
            lines += _door(described)
        else:
            for kind, home in sorted(described, key=lambda pair: pair[0] == api_names.DATA):
                lines += _directive(kind, home)
    return "\n".join(lines)


def _door(described: list[tuple[str, str]]) -> list[str]:
    """The names at the door by `DOOR`, which a test keeps complete."""
    kinds = {home.rpartition(".")[2]: (kind, home) for kind, home in described}
    lines: list[str] = []
    for title, names in DOOR.items():
        lines += [title, "-" * len(title), ""]
        for name in names.split():
            lines += _directive(*kinds[name]) if name in kinds else []
    return lines


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


def named_sources() -> list[str]:
    """Files of the core, below cpp/photograd/, that a docstring of the reference names."""
    return sorted({name for text in all_docstrings() for name in docstrings.sources_in(text)})


def unknown_files() -> list[str]:
    """Other sources that a docstring names, which a reader of the pages does not have."""
    texts = (docstrings.link_sources(text) for text in all_docstrings())
    return sorted({found[0] for text in texts for found in FILES.finditer(text)})


def all_docstrings() -> Iterator[str]:
    """Of all modules, classes, functions and constants that are not commands."""
    for module in api_names.modules().values():
        if api_names.is_documented(module.name):
            yield from (docstring for *_, docstring in module.constants.values())
    for name, folder in api_names.SOURCES.items():
        for path in folder.rglob("*.py"):
            parts = [name, *path.relative_to(folder).with_suffix("").parts]
            if not api_names.is_documented(".".join(parts).removesuffix(".__init__")):
                continue
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                    yield ast.get_docstring(node) or ""


def source_page(source: str) -> str:
    """A page that shows a file of the core."""
    title = f"cpp/photograd/{source}"
    path = f"/../{title}"
    heading = [":orphan:", "", title, "=" * len(title), ""]
    return "\n".join([*heading, f".. literalinclude:: {path}", "   :language: cpp", ""])


def write(folder: Path = FOLDER) -> None:
    """Replace the folder's pages; a page whose text is the same keeps its date."""
    texts = pages()
    texts["index"] = index(list(texts))
    _replace(folder, texts)
    sources = {docstrings.page_name(source): source_page(source) for source in named_sources()}
    _replace(DOCS / docstrings.SOURCES, sources)


def _replace(folder: Path, texts: dict[str, str]) -> None:
    folder.mkdir(exist_ok=True)
    wanted = {f"{name}.rst" for name in texts} | {Path(docstrings.SOURCES).name}
    for old in folder.iterdir():
        if old.name not in wanted:
            shutil.rmtree(old) if old.is_dir() else old.unlink()
    for name, text in texts.items():
        path = folder / f"{name}.rst"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write()
