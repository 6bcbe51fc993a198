"""A file holds one idea: 400 lines at most, 300 for a test, and functions of less than 60.

Lines of C++ end at column 100, comments too; ruff sees to those of Python.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

from support.cpp_functions import functions
from support.tree import CPP_SUFFIXES, ROOT, relative, walk

CAPS = {
    "cpp": 400,
    "python": 400,
    "tools": 400,
    "bench": 400,
    "assignments": 400,
    "docs": 400,
    "tests": 300,
    "cpp/tests": 300,
}
SUFFIXES = CPP_SUFFIXES | {".py", ".sh", ".toml"}
# Rows of data, one for each wrong solution or system.
DATA = {"mutants.toml", "systems.toml"}
# What is given stands beside the tasks, and their solutions, in the one file that students hand in.
LONGER = {
    "assignments/06_real_time_frame/real_time_frame.py": 630,
    "assignments/07_path_tracing/path_tracing.py": 600,
    "assignments/14_edges_and_light/edges_and_light.py": 650,
    "assignments/15_gaussian_splatting/splatting.py": 410,
}
FUNCTION_CAP = 60
COLUMNS = 100


def cap_of(path: str) -> int:
    """The cap of the deepest folder that names one."""
    if path in LONGER:
        return LONGER[path]
    return CAPS[max((folder for folder in CAPS if path.startswith(folder + "/")), key=len)]


def sources() -> list[Path]:
    folders = [ROOT / name for name in CAPS if "/" not in name and (ROOT / name).is_dir()]
    found = [path for folder in folders for path in walk(folder, SUFFIXES)]
    return [path for path in found if path.name not in DATA]


def long_functions(path: str, text: str) -> list[str]:
    """Functions of 60 lines or more, docstring not counted: that is reference, not code."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            lines = (node.end_lineno or 0) - node.lineno + 1
            first = node.body[0]
            if ast.get_docstring(node) is not None:
                lines -= (first.end_lineno or 0) - first.lineno + 1
            if lines >= FUNCTION_CAP:
                found.append(f"{path}:{node.lineno} {node.name}: {lines} lines")
    return found


def wide_lines(path: str, text: str) -> list[str]:
    """Lines that end beyond column 100."""
    return [
        f"{path}:{number}: {len(line)} columns"
        for number, line in enumerate(text.splitlines(), start=1)
        if len(line) > COLUMNS
    ]


def test_files_stay_below_their_cap() -> None:
    lengths = {relative(path): len(path.read_text("utf-8").splitlines()) for path in sources()}
    assert len(lengths) > 50
    assert [f"{path}: {n} lines" for path, n in lengths.items() if n > cap_of(path)] == []


def test_the_formatter_decides() -> None:
    """At most twenty statements of the whole repository are kept from it."""
    sources = {relative(path): path.read_text("utf-8") for path in walk(ROOT, {".py"})}
    assert len(sources) > 1000
    kept = [name for name, text in sources.items() if re.search(r"# fmt: (skip|off)", text)]
    assert kept == []


def test_python_functions_stay_below_sixty_lines() -> None:
    found = [
        line
        for path in sources()
        if path.suffix == ".py" and not relative(path).startswith(("assignments/", "docs/"))
        for line in long_functions(relative(path), path.read_text(encoding="utf-8"))
    ]
    assert found == []


def test_cpp_functions_stay_below_sixty_lines() -> None:
    texts = {
        relative(path): path.read_text("utf-8") for path in sources() if path.suffix in CPP_SUFFIXES
    }
    lengths = [(path, function) for path, text in texts.items() for function in functions(text)]
    assert len(lengths) > 1500, "the functions are not found any more"
    found = {f"{path} {f.name}": f for path, f in lengths if f.lines >= FUNCTION_CAP}
    assert found == {}


def test_cpp_lines_end_at_column_100() -> None:
    paths = [*walk(ROOT / "cpp", CPP_SUFFIXES | {".py"}), ROOT / "cpp" / "CMakeLists.txt"]
    texts = {relative(path): path.read_text(encoding="utf-8") for path in paths}
    assert len(texts) > 300, "the sources are not found any more"
    assert [line for path, text in texts.items() for line in wide_lines(path, text)] == []


def test_a_wide_line_is_seen_in_columns_not_in_bytes() -> None:
    assert wide_lines("a.h", "\u00e9" * 100 + "\n// " + "x" * 98) == ["a.h:2: 101 columns"]


def test_a_long_cpp_function_is_seen() -> None:
    body = "    if (x) { y(); }  // }\n" * 58
    text = (
        "namespace a {\nstruct S {\n    int x{1};\n};\n"
        "template <class T>\n    requires (sizeof(T) > 1)\n"
        f'T f(const char* c = "{{") {{\n{body}}}\nint g() {{ return 1; }}\n}}\n'
    )
    assert [tuple(f)[1:] for f in functions(text)] == [(5, 62), (67, 1)]
    assert functions("int a[] = {1, 2};\nenum class B { c };\n") == []


def test_a_long_function_is_seen_and_its_docstring_forgiven() -> None:
    body = "    x = 1\n" * 59
    assert long_functions("a.py", f"def f():\n{body}") == ["a.py:1 f: 60 lines"]
    assert long_functions("a.py", f'def f():\n    """Sum.\n\n    More.\n    """\n{body[10:]}') == []
