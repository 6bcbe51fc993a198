"""What stands in a student's module: which functions are still stubs, and which differ in two."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterator, Sequence

# What a stub raises; see `build.regions`.
SAID_OF_STUB = re.compile(r"(\d\d)\.\d+ ([\w.]+): see the handout, section \d+")
_STUB_LINE = re.compile(
    rf"^ *raise NotImplementedError\(\"{SAID_OF_STUB.pattern}\"\)", re.MULTILINE
)
OUTSIDE = "code outside of functions"

Function = ast.FunctionDef | ast.AsyncFunctionDef


def parsed(source: str) -> ast.Module | None:
    """The syntax tree; None where the text is no Python.

    Args:
        source: of a module.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a student's escapes and comparisons, said elsewhere
        try:
            return ast.parse(source)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return None


def functions(tree: ast.Module) -> Iterator[tuple[str, Function]]:
    """The functions of a module and the methods of its classes, such as "Value.exp".

    Args:
        tree: of the module.
    """
    for node in tree.body:
        if isinstance(node, Function):
            yield node.name, node
        elif isinstance(node, ast.ClassDef):
            for inner in node.body:
                if isinstance(inner, Function):
                    yield f"{node.name}.{inner.name}", inner


def unwritten(source: str, expected: Sequence[str] = ()) -> list[str]:
    """The functions of a student's module that are still to be written, in their order.

    Args:
        source: of the module.
        expected: functions that it should have; one that is missing, or empty, is not written.
    """
    tree = parsed(source)
    if tree is None:
        return [name for _, name in _STUB_LINE.findall(source)]
    there = list(functions(tree))
    found = [
        name
        for name, node in there
        if _reaches_stub(node.body) or (name in expected and _is_empty(node.body))
    ]
    names = {name for name, _ in there} | _bound(tree)
    return [*found, *(name for name in expected if name not in names)]


def changed_code(one: str, other: str) -> list[str]:
    """What differs in two texts of a module: functions, methods, `OUTSIDE` for the rest.

    Comments, docstrings and the layout do not count. Where one is no Python, all that is known is
    whether their lines differ.

    Args:
        one: a text of the module.
        other: another.
    """
    first, second = _code_parts(one), _code_parts(other)
    if first is None or second is None:
        return [] if one.splitlines() == other.splitlines() else [OUTSIDE]
    names = dict.fromkeys([*first, *second])
    found = [name for name in names if first.get(name) != second.get(name)]
    return sorted(found, key=lambda name: name == OUTSIDE)  # functions come first


def _reaches_stub(body: Sequence[ast.stmt]) -> bool:
    """Whether a stub is left in a block, and not behind a `return` of the same block."""
    for statement in body:
        if isinstance(statement, ast.Raise) and _is_stub(statement):
            return True
        if isinstance(statement, (ast.Return, ast.Raise)):
            return False
        blocks = [getattr(statement, name, []) for name in ("body", "orelse", "finalbody")]
        if not isinstance(statement, (Function, ast.ClassDef)) and any(map(_reaches_stub, blocks)):
            return True
    return False


def _is_stub(statement: ast.Raise) -> bool:
    made = statement.exc
    if not (isinstance(made, ast.Call) and isinstance(made.func, ast.Name)):
        return False
    said = made.args[0].value if made.args and isinstance(made.args[0], ast.Constant) else None
    named = made.func.id == "NotImplementedError" and isinstance(said, str)
    return named and SAID_OF_STUB.fullmatch(str(said)) is not None


def _is_empty(body: Sequence[ast.stmt]) -> bool:
    """Whether nothing stands there but a docstring, `pass`, `...` or NotImplementedError."""
    return all(
        isinstance(each, ast.Pass)
        or (isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant))
        or (isinstance(each, ast.Raise) and "NotImplementedError" in ast.dump(each))
        for each in body
    )


def _bound(tree: ast.Module) -> set[str]:
    """Names that a module gets otherwise than by a definition: f = g, or an import."""
    stored = {
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    }
    imported = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, (ast.ImportFrom, ast.Import))
        for alias in node.names
    }
    assigned = {
        f"{cls.name}.{target.id}"
        for cls in tree.body
        if isinstance(cls, ast.ClassDef)
        for node in cls.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    return stored | imported | assigned


def _code_parts(source: str) -> dict[str, str] | None:
    """The code of each function and of the rest, without docstrings, in a form to compare."""
    tree = parsed(source)
    if tree is None:
        return None
    for node in ast.walk(tree):
        if isinstance(node, (Function, ast.ClassDef, ast.Module)) and _begins_with_text(node.body):
            node.body = node.body[1:]
    parts: dict[str, str] = {}
    for name, node in functions(tree):
        parts[name] = parts.get(name, "") + ast.dump(node)
    rest = [node for node in tree.body if not isinstance(node, Function)]
    for node in rest:
        if isinstance(node, ast.ClassDef):
            node.body = [inner for inner in node.body if not isinstance(inner, Function)]
    parts[OUTSIDE] = "\n".join(map(ast.dump, rest))
    return parts


def _begins_with_text(body: Sequence[ast.stmt]) -> bool:
    first = body[0] if body else None
    is_text = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    return is_text and isinstance(first.value.value, str)  # type: ignore[union-attr]
