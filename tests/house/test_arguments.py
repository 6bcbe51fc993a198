"""Arguments that no docstring describes: their number may only fall."""

from __future__ import annotations

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
try:
    import api_names
finally:
    sys.path.pop(0)

DESCRIBED = (
    "photograd.capture",
    "photograd.caustics",
    "photograd.fields",
    "photograd.fitting",
    "photograd.frame",
    "photograd.raster",
    "photograd.representation",
    "photograd.splats",
    "photograd.transport",
    "photograd.vector",
)
"""Packages whose functions describe all."""
CEILING = {"photograd": 190, "photograd_course": 480}
"""Arguments of others that no sentence names. Lower a number when it has fallen."""

ENTRY = re.compile(r"^ {4}(\*{0,2}\w+(?:, \*{0,2}\w+)*)(?: \(.*?\))?:", re.MULTILINE)
ERROR = re.compile(r"_?[A-Z]\w+(, [A-Z]\w+)*")


def entries(docstring: str, section: str) -> list[str]:
    """What stands before the colons of a section such as `Args`."""
    text = docstring.partition(f"{section}:\n")[2]
    return ENTRY.findall(re.split(r"\n(?=\S)", text)[0])


def is_described(argument: str, docstring: str) -> bool:
    """By an entry of `Args`, or, where there is no such section, by a sentence that names it."""
    if "Args:\n" not in docstring:
        return re.search(rf"\b{argument}\b", docstring) is not None
    names = (name for entry in entries(docstring, "Args") for name in entry.split(", "))
    return argument in {name.lstrip("*") for name in names}


@cache
def trees() -> dict[str, ast.Module]:
    """The modules that the reference describes."""
    found = {}
    for root, folder in api_names.SOURCES.items():
        for path in sorted(folder.rglob("*.py")):
            parts = [root, *path.relative_to(folder).with_suffix("").parts]
            name = ".".join(parts).removesuffix(".__init__")
            if api_names.is_documented(name):
                found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


@cache
def methods() -> dict[str, tuple[set[str], list[str]]]:
    """{class: its methods, its bases}, by their own names."""
    found = {}
    for tree in trees().values():
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                own = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
                found[node.name] = own, [ast.unparse(base) for base in node.bases]
    return found


def overrides(cls: str, method: str) -> bool:
    """Whether a base class has the method, and with it the description of its arguments."""
    return any(
        method in methods()[base][0] or overrides(base, method)
        for base in methods()[cls][1]
        if base in methods() and base != cls
    )


def functions(tree: ast.Module) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Public functions and methods, by qualified name."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for method in node.body:
                public = isinstance(method, ast.FunctionDef) and (
                    not method.name.startswith("_") or method.name == "__init__"
                )
                known = public and method.name != "__init__" and overrides(node.name, method.name)
                if isinstance(method, ast.FunctionDef) and public and not known:
                    yield f"{node.name}.{method.name}", method


def undescribed(tree: ast.Module) -> list[str]:
    """`function: argument` of what the docstrings of a module do not describe."""
    found = []
    for name, function in functions(tree):
        text, given = ast.get_docstring(function), function.args
        all_of_them = [*given.posonlyargs, *given.args, *given.kwonlyargs]
        all_of_them += [each for each in (given.vararg, given.kwarg) if each]
        names = [each.arg for each in all_of_them if each.arg not in ("self", "cls")]
        found += [f"{name}: {n}" for n in names if text and not is_described(n, text)]
    return found


def test_packages_that_users_meet_describe_all_arguments() -> None:
    lacking = [
        f"{module}.{line}"
        for module, tree in trees().items()
        if module.startswith(DESCRIBED)
        for line in undescribed(tree)
    ]
    assert lacking == []


def test_the_number_of_undescribed_arguments_falls() -> None:
    counts: Counter[str] = Counter()
    for module, tree in trees().items():
        counts[module.partition(".")[0]] += len(undescribed(tree))
    assert {root: counts[root] <= ceiling for root, ceiling in CEILING.items()} == dict.fromkeys(
        CEILING, True
    ), counts
    assert all(ceiling - counts[root] < 20 for root, ceiling in CEILING.items()), "lower CEILING"


def test_raises_sections_name_errors() -> None:
    found = [
        f"{module}: {line}"
        for module, tree in trees().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef | ast.FunctionDef)
        for line in entries(ast.get_docstring(node) or "", "Raises")
        if not ERROR.fullmatch(line)
    ]
    assert found == []


def test_planted_functions_are_seen() -> None:
    tree = ast.parse(
        'def f(a, *b):\n    """Of a.\n\n    Args:\n        a: x.\n    """\n'
        'def g(c, d):\n    """Of c alone."""\ndef _h(e):\n    """."""\n'
        'class K:\n    def m(self, f):\n        """."""\n'
    )
    methods()["K"] = {"m"}, []
    assert undescribed(tree) == ["f: b", "g: d", "K.m: f"]
