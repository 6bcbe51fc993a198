"""Alternatives are written otherwise: no function of a task is the solution's, renamed or not.

Compared are syntax trees without docstrings and annotations, in which arguments and local names
are numbered in the order in which they occur. Nor may an alternative as a whole resemble the
solution, as `photograd course grade` would find of two submissions.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import chain

from ...submissions.similarity import similar_pairs
from ..assignment_build import AssignmentBuild

MOST = 0.6  # share of the shorter text's fingerprints


def check_likeness(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    names = [name for task in build.manifest.tasks for name in task.functions]
    own = normal_forms(build.source)
    for alternative, text in build.alternatives.items():
        other = normal_forms(text)
        for name in names:
            if name in own and own[name] == other.get(name):
                yield f"{name} of the alternative {alternative} is the solution's"
        texts = {"solution": build.source, alternative: text}
        for *_, share in similar_pairs(texts, build.starter):
            if share > MOST:
                yield f"the alternative {alternative} shares {share:.0%} with the solution"


def normal_forms(text: str) -> dict[str, str]:
    """The functions of a module by dotted name, local names numbered."""
    found = {}
    for node in ast.parse(text).body:
        members = node.body if isinstance(node, ast.ClassDef) else [node]
        prefix = f"{node.name}." if isinstance(node, ast.ClassDef) else ""
        for each in members:
            if isinstance(each, ast.FunctionDef):
                found[prefix + each.name] = _normal_form(each)
    return found


def _normal_form(function: ast.FunctionDef) -> str:
    local = _local_names(function)
    numbers: dict[str, str] = {}
    for node in _in_order(function):
        if isinstance(node, (ast.FunctionDef, ast.Lambda)):
            _bare(node)
        for field in ("id", "arg", "name"):
            name = getattr(node, field, None)
            if name in local and not isinstance(node, ast.keyword):
                setattr(node, field, numbers.setdefault(name, f"_{len(numbers)}"))
    return ast.dump(function)


def _local_names(function: ast.FunctionDef) -> set[str]:
    """Names of arguments, of what is assigned and of functions within."""
    nodes = [node for node in ast.walk(function) if node is not function]
    stored = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    inner = {node.name for node in nodes if isinstance(node, ast.FunctionDef)}
    return stored | inner | {node.arg for node in nodes if isinstance(node, ast.arg)}


def _in_order(node: ast.AST) -> Iterator[ast.AST]:
    yield node
    yield from chain.from_iterable(map(_in_order, ast.iter_child_nodes(node)))


def _bare(node: ast.FunctionDef | ast.Lambda) -> None:
    """Without docstring and annotations."""
    for each in ast.walk(node.args):
        if isinstance(each, ast.arg):
            each.annotation = None
    if isinstance(node, ast.FunctionDef):
        node.returns = None
        if ast.get_docstring(node) is not None:
            node.body = node.body[1:] or [ast.Pass()]
