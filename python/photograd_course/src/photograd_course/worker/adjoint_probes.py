"""Code in which each value that may hold numbers passes through a probe, and is else the same.

`instrumented` wraps expressions in calls of a function that returns its argument. What an
expression is the target of is left alone: it is looked at where it is read next.
"""

from __future__ import annotations

import ast
import os
from types import CodeType

PROBE = f"__probe_{os.urandom(8).hex()}__"  # a submission cannot know it beforehand
WRAPPED = (
    ast.Name,
    ast.Attribute,
    ast.Subscript,
    ast.BinOp,
    ast.UnaryOp,
    ast.Call,
    ast.IfExp,
    ast.NamedExpr,
)
Place = tuple[str, int, bool]  # file, line, whether an operator made the value


def instrumented(tree: ast.Module, file: str, places: list[Place]) -> CodeType:
    """The compiled module, in which probes have the numbers that `places` grows by.

    Args:
        tree: of the module; it is changed.
        file: its name, for tracebacks.
        places: where each probe stands; the number of a probe is its index.

    Raises:
        SyntaxError, ValueError, RecursionError: it is no Python, or nested too deeply.
    """
    _Wrapper(file, places).generic_visit(tree)
    return compile(ast.fix_missing_locations(tree), file, "exec", dont_inherit=True)


class _Wrapper(ast.NodeTransformer):
    def __init__(self, file: str, places: list[Place]) -> None:
        self._file, self._places = file, places

    def visit(self, node: ast.AST) -> ast.AST:
        """Wrap what is read in ``node``; leave targets, annotations and decorators."""
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            return self._function(node)
        if isinstance(node, ast.ClassDef):
            node.body = [self._statement(each) for each in node.body]
            return node
        if isinstance(node, ast.AnnAssign):
            if node.value is not None:
                node.value = self._expression(node.value)
            return node
        if isinstance(node, ast.Call):
            return self._call(node)
        if isinstance(node, (ast.Subscript, ast.Attribute)):
            return self._part(node)
        if isinstance(node, (ast.JoinedStr, ast.Import, ast.ImportFrom)) or _is_pattern(node):
            return node
        if isinstance(node, WRAPPED) and _is_read(node):
            return self._wrapped(self.generic_visit(node))
        return self.generic_visit(node)

    def _statement(self, node: ast.stmt) -> ast.stmt:
        found = self.visit(node)
        assert isinstance(found, ast.stmt)
        return found

    def _expression(self, node: ast.expr) -> ast.expr:
        found = self.visit(node)
        assert isinstance(found, ast.expr)
        return found

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> ast.AST:
        args = node.args
        args.defaults = [self._expression(each) for each in args.defaults]
        args.kw_defaults = [each and self._expression(each) for each in args.kw_defaults]
        if isinstance(node, ast.Lambda):
            node.body = self._expression(node.body)
        else:
            node.body = [self._statement(each) for each in node.body]
        return node

    def _call(self, node: ast.Call) -> ast.expr:
        """The function that is called is no number, what a method belongs to may be one."""
        if isinstance(node.func, ast.Attribute):
            node.func.value = self._expression(node.func.value)
        elif not isinstance(node.func, ast.Name):
            node.func = self._expression(node.func)
        node.args = [self._expression(each) for each in node.args]
        for keyword in node.keywords:
            keyword.value = self._expression(keyword.value)
        return self._wrapped(node)

    def _part(self, node: ast.Subscript | ast.Attribute) -> ast.expr:
        """Of x[i].T the whole is looked at, and what i is."""
        if isinstance(node, ast.Subscript):
            node.slice = self._expression(node.slice)
        if isinstance(node.value, (ast.Subscript, ast.Attribute)):
            inner = node.value
            node.value = self._part(inner)
            if isinstance(node.value, ast.Call):  # wrapped
                node.value = node.value.args[1]
        elif not isinstance(node.value, ast.Name):
            node.value = self._expression(node.value)
        return self._wrapped(node) if _is_read(node) else node

    def _wrapped(self, node: ast.AST) -> ast.expr:
        assert isinstance(node, ast.expr)
        number = ast.Constant(len(self._places))
        is_made = isinstance(node, (ast.BinOp, ast.UnaryOp))
        self._places.append((self._file, getattr(node, "lineno", 0), is_made))
        probe = ast.Name(PROBE, ast.Load())
        return ast.copy_location(ast.Call(probe, [number, node], []), node)


def _is_read(node: ast.AST) -> bool:
    return isinstance(getattr(node, "ctx", ast.Load()), ast.Load)


def _is_pattern(node: ast.AST) -> bool:
    return isinstance(node, getattr(ast, "pattern", ()))
