"""What graded code may import later, imported while it can still be read."""

from __future__ import annotations

import contextlib
import importlib

# With the modules that these, NumPy and the interpreter import only on first use.
NUMPY = (
    "numpy.char",
    "numpy.ctypeslib",
    "numpy.fft",
    "numpy.lib.recfunctions",
    "numpy.linalg",
    "numpy.ma",
    "numpy.polynomial",
    "numpy.random",
    "numpy.rec",
    "numpy.typing",
)
STANDARD = (
    "_strptime",
    "abc",
    "array",
    "ast",
    "bisect",
    "cmath",
    "collections.abc",
    "contextlib",
    "copy",
    "dataclasses",
    "datetime",
    "decimal",
    "enum",
    "fractions",
    "functools",
    "heapq",
    "inspect",
    "io",
    "itertools",
    "json",
    "linecache",
    "math",
    "numbers",
    "operator",
    "os",
    "pathlib",
    "pprint",
    "random",
    "re",
    "statistics",
    "string",
    "struct",
    "textwrap",
    "time",
    "tokenize",
    "traceback",
    "types",
    "typing",
    "unicodedata",
    "warnings",
    "weakref",
)
CODECS = ("ascii", "latin_1", "unicode_escape", "utf_8", "utf_8_sig", "utf_16", "cp1252")


def preload(more: list[str]) -> None:
    """Import all of it, and the modules that the assignment names."""
    for name in NUMPY:
        with contextlib.suppress(ModuleNotFoundError):  # before NumPy 2, some are no modules yet
            importlib.import_module(name)
    for name in (*STANDARD, *more, *(f"encodings.{codec}" for codec in CODECS)):
        importlib.import_module(name)
