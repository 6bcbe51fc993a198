"""What is changed in a syntax tree to make an automatic mutant: pairs of old and new text."""

from __future__ import annotations

import ast
import copy
from collections.abc import Callable, Collection, Iterator
from functools import partial
from typing import Any

Change = tuple[str, str]

OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.MatMult: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}


def expressions_of(node: ast.AST, own: Collection[str] = ()) -> Iterator[Change]:
    """Changes of an expression.

    Args:
        node: of the syntax tree.
        own: names of the module's functions, whose call sites are changed too.
    """
    if isinstance(node, ast.BinOp):
        yield from _binary(node)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not)):
        yield ast.unparse(node), ast.unparse(node.operand)
    elif isinstance(node, ast.BoolOp):
        other = ast.And() if isinstance(node.op, ast.Or) else ast.Or()
        yield _changed(node, lambda n: setattr(n, "op", other))
    elif isinstance(node, ast.Compare):
        for place, op in enumerate(node.ops):
            for kind in COMPARISONS.get(type(op), ()):
                yield _changed(node, partial(_set_comparison, place, kind()))
    elif isinstance(node, ast.Constant):
        for value in _constants(node.value):
            yield ast.unparse(node), repr(value)
    elif isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Load):
        yield from _indices(node)
    elif isinstance(node, ast.Call):
        yield from _swapped_arguments(node)
        yield from _call_site(node, own)


def statements_of(node: ast.stmt) -> Iterator[Change]:
    """Changes of a statement."""
    if isinstance(node, ast.AugAssign):
        old, target, value = ast.unparse(node), ast.unparse(node.target), ast.unparse(node.value)
        yield old, f"{target} = {value}"
        if (kind := OPERATORS.get(type(node.op))) is not None:
            yield _changed(node, lambda n: setattr(n, "op", kind()))
        yield old, "pass"
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield ast.unparse(node), "pass"
    elif isinstance(node, ast.Return) and node.value is not None:
        yield from _signs(node)
    elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript):
        yield ast.unparse(node), "pass"
        for old, new in _indices(node.targets[0]):
            yield old, f"{new} = {ast.unparse(node.value)}"


def _binary(node: ast.BinOp) -> Iterator[Change]:
    old, left, right = ast.unparse(node), ast.unparse(node.left), ast.unparse(node.right)
    if (kind := OPERATORS.get(type(node.op))) is not None:
        yield _changed(node, lambda n: setattr(n, "op", kind()))
    if isinstance(node.op, (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)):
        yield old, left
    if isinstance(node.op, (ast.Add, ast.Mult)):
        yield old, right
    if isinstance(node.op, ast.Sub):
        yield old, f"-({right})"


def _constants(value: Any) -> list[Any]:
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1] if value else [1]
    if isinstance(value, float):
        return [value * 2, -value] if value else [1.0]
    return []


def _indices(node: ast.Subscript) -> Iterator[Change]:
    """Each index of a subscript, and each limit of a slice, one more and one less."""
    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    for number, part in enumerate(parts):
        names = ("lower", "upper") if isinstance(part, ast.Slice) else ("",)
        for name in names:
            index = getattr(part, name) if name else part
            # Constants are changed as such; None and Ellipsis are no numbers.
            if index is None or isinstance(index, (ast.Constant, ast.Starred)):
                continue
            for step in (ast.Add(), ast.Sub()):
                yield _changed(node, partial(_move_index, number, name, step))


def _move_index(number: int, name: str, step: ast.operator, node: Any) -> None:
    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    index = getattr(parts[number], name) if name else parts[number]
    moved = ast.BinOp(index, step, ast.Constant(1))
    if name:
        setattr(parts[number], name, moved)
    elif isinstance(node.slice, ast.Tuple):
        node.slice.elts[number] = moved
    else:
        node.slice = moved


def _set_comparison(place: int, op: ast.cmpop, node: Any) -> None:
    node.ops[place] = op


def _swapped_arguments(node: ast.Call) -> Iterator[Change]:
    for first in range(len(node.args) - 1):
        pair = node.args[first : first + 2]
        if not any(isinstance(each, ast.Starred) for each in pair):

            def swap(n: Any, at: int = first) -> None:
                n.args[at], n.args[at + 1] = n.args[at + 1], n.args[at]

            yield _changed(node, swap)


def _call_site(node: ast.Call, own: Collection[str]) -> Iterator[Change]:
    """Each keyword left out; a call of the module's own function left out: its first argument.

    Not ``out``: what memory holds before it is written to differs between runs. Nor what NumPy is
    told to warn of, which no check looks at.
    """
    warns = isinstance(node.func, ast.Attribute) and node.func.attr == "errstate"
    for number, keyword in enumerate(() if warns else node.keywords):
        if keyword.arg not in (None, "out"):
            yield _changed(node, partial(_drop_keyword, number))
    if isinstance(node.func, ast.Name) and node.func.id in own and node.args:
        yield ast.unparse(node), ast.unparse(node.args[0])


def _drop_keyword(number: int, node: Any) -> None:
    del node.keywords[number]


def _signs(node: ast.Return) -> Iterator[Change]:
    assert node.value is not None
    old = ast.unparse(node)
    if isinstance(node.value, (ast.Tuple, ast.List)):
        for number, item in enumerate(node.value.elts):
            parts = [ast.unparse(each) for each in node.value.elts]
            parts[number] = f"-({ast.unparse(item)})"
            yield old, f"return {', '.join(parts)}"
    elif not isinstance(node.value, ast.Constant):
        yield old, f"return -({ast.unparse(node.value)})"


def _changed(node: ast.AST, change: Callable[[Any], object]) -> Change:
    other = copy.deepcopy(node)
    change(other)
    return ast.unparse(node), ast.unparse(other)
