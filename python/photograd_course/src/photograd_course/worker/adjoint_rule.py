"""The rule that an adjoint is written, looked for in the syntax tree of a submission.

Three ways to get a derivative without writing it leave marks: a complex step has a small imaginary
part, a dual number is a class that overloads arithmetic, and differencing moves an argument by a
small step and divides a difference by it. Looked at are an adjoint and all that it names of the
submission, directly or not. Small constants in other places (a floor, a learning rate) are no
marks. The worker looks before it loads the submission, when nothing can yet speak for it. What is
disguised better is left to the check of the cost.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping

SMALL = 1e-2  # the largest step taken for one
LARGE = 1 / SMALL
OVERLOADS = frozenset(
    f"__{name}__" for name in ("mul", "rmul", "matmul", "truediv", "array_ufunc", "array_function")
)
ARRAY_BASES = frozenset(("ndarray", "NDArrayOperatorsMixin"))
DYNAMIC = frozenset(("eval", "exec", "compile", "__import__"))
PASSING_ON = frozenset(("float", "float64", "sqrt", "abs", "asarray", "array"))
COMPLEX = "takes a complex step"
DUAL = "uses a class that overloads arithmetic"
DIFFERENCES = "divides a difference by a small step"
HIDDEN = "runs code that is made from text"

Top = tuple[str, ast.stmt]  # file, statement


def breaches(sources: Mapping[str, str], adjoints: Iterable[str]) -> dict[str, dict[str, object]]:
    """The first breach of each adjoint that has one, as ``{"file", "line", "what"}``.

    Args:
        sources: module name to text, of the modules that the student wrote.
        adjoints: names of functions.

    Returns:
        by name of the adjoint; empty where a text is no Python, which loading it will tell.
    """
    try:
        tops = [
            (f"{name}.py", statement)
            for name, text in sources.items()
            for statement in ast.parse(text).body
        ]
        defined = _definitions(tops)
        found: dict[str, dict[str, object]] = {}
        for adjoint in adjoints:
            reached = _reached(adjoint, defined)
            small = _small_names(reached)
            for file, statement in reached:
                for line, what in _marks(statement, small):
                    found.setdefault(adjoint, {"file": file, "line": line, "what": what})
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return {}
    return found


def _definitions(tops: Iterable[Top]) -> dict[str, list[Top]]:
    """Statements at the top of the modules, by the names that they bind."""
    defined: dict[str, list[Top]] = {}
    for top in tops:
        statement = top[1]
        if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
            names = {statement.name}
        else:
            names = {
                node.id
                for node in ast.walk(statement)
                if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
            } | {
                n.name
                for n in ast.walk(statement)
                if isinstance(n, (ast.FunctionDef, ast.ClassDef))
            }
        for name in names:
            defined.setdefault(name, []).append(top)
    return defined


def _reached(name: str, defined: Mapping[str, list[Top]]) -> list[Top]:
    """What a name is bound to, what that names, and so on."""
    names, reached = [name], []
    known = {name}
    for each in names:  # grows on the way
        for top in defined.get(each, ()):
            if top in reached:
                continue
            reached.append(top)
            for node in ast.walk(top[1]):
                if isinstance(node, ast.Name) and node.id not in known:
                    known.add(node.id)
                    names.append(node.id)
    return reached


def _small_names(reached: Iterable[Top]) -> set[str]:
    """Variables and parameters that hold a small step."""
    bound: list[tuple[str, ast.expr]] = []
    functions, calls = {}, []
    for _, statement in reached:
        for node in ast.walk(statement):
            if isinstance(node, ast.Assign):
                bound += [(t.id, node.value) for t in node.targets if isinstance(t, ast.Name)]
            elif isinstance(node, (ast.AnnAssign, ast.NamedExpr)) and node.value is not None:
                if isinstance(node.target, ast.Name):
                    bound.append((node.target.id, node.value))
            elif isinstance(node, ast.FunctionDef):
                functions[node.name] = [each.arg for each in node.args.args]
                named = [each.arg for each in node.args.args]
                given = node.args.defaults
                bound += list(zip(named[len(named) - len(given) :], given, strict=True))
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                calls.append((node.func.id, node.args))
    for function, args in calls:
        bound += list(zip(functions.get(function, ()), args, strict=False))
    small: set[str] = set()
    while more := {name for name, value in bound if _is_small(value, small)} - small:
        small |= more
    return small


def _is_small(node: ast.expr, small: set[str]) -> bool:
    """Whether an expression is a small step, or a product with one."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, (int, float)) and 0 < abs(node.value) <= SMALL
    if isinstance(node, ast.Name):
        return node.id in small
    if isinstance(node, ast.UnaryOp):
        return _is_small(node.operand, small)
    if isinstance(node, ast.Attribute):
        return node.attr == "eps"
    if isinstance(node, ast.Call):
        return _name_of(node.func) in PASSING_ON and any(_is_small(a, small) for a in node.args)
    if isinstance(node, ast.BinOp):
        left, right = _is_small(node.left, small), _is_small(node.right, small)
        if isinstance(node.op, ast.Mult):
            return left or right
        if isinstance(node.op, ast.Div):
            return left or (_is_constant(node.left) and _is_large(node.right))
        if isinstance(node.op, ast.Pow):
            return left or (_is_constant(node.left) and isinstance(node.right, ast.UnaryOp))
    return False


def _is_constant(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, (int, float))


def _is_large(node: ast.expr) -> bool:
    is_number = isinstance(node, ast.Constant) and isinstance(node.value, (int, float))
    return is_number and abs(node.value) >= LARGE  # type: ignore[attr-defined]


def _marks(statement: ast.stmt, small: set[str]) -> Iterator[tuple[int, str]]:
    """Line and kind of each mark."""
    nodes = list(ast.walk(statement))
    differences = {
        target.id
        for node in nodes
        if isinstance(node, ast.Assign) and _has_difference(node.value, set())
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    is_moved = any(_moves(node, small) for node in nodes)
    for node in nodes:
        if isinstance(node, ast.ClassDef) and _overloads(node):
            yield node.lineno, DUAL
        elif isinstance(node, ast.Call) and _name_of(node.func) in DYNAMIC:
            yield node.lineno, HIDDEN
        elif isinstance(node, (ast.Constant, ast.BinOp, ast.Call)) and _is_imaginary(node, small):
            yield node.lineno, COMPLEX
        elif isinstance(node, ast.BinOp) and _divides(node, small):
            parts = list(ast.walk(node))
            if any(_name_of(part) == "imag" for part in parts):
                yield node.lineno, COMPLEX
            elif is_moved and _has_difference(node, differences):
                yield node.lineno, DIFFERENCES


def _overloads(node: ast.ClassDef) -> bool:
    methods = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
    assigned = {
        target.id
        for each in node.body
        if isinstance(each, ast.Assign)
        for target in each.targets
        if isinstance(target, ast.Name)
    }
    bases = {_name_of(base) for base in node.bases}
    return bool((methods | assigned) & OVERLOADS or bases & ARRAY_BASES)


def _is_imaginary(node: ast.expr, small: set[str]) -> bool:
    """A small imaginary number: 1e-30j, 1j * h, complex(x, h)."""
    if isinstance(node, ast.Constant):
        return isinstance(node.value, complex) and 0 < abs(node.value.imag) <= SMALL
    if isinstance(node, ast.BinOp):
        sides = (node.left, node.right)
        unit = any(isinstance(s, ast.Constant) and isinstance(s.value, complex) for s in sides)
        return isinstance(node.op, ast.Mult) and unit and _is_small(node, small)
    if isinstance(node, ast.Call):
        is_made = _name_of(node.func) in ("complex", "complex128") and len(node.args) == 2
        return is_made and _is_small(node.args[1], small)
    return False


def _moves(node: ast.AST, small: set[str]) -> bool:
    """Whether something is moved by a small step: x + h, x - h, x[i] += h."""
    if isinstance(node, ast.AugAssign):
        return isinstance(node.op, (ast.Add, ast.Sub)) and _is_small(node.value, small)
    if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub)):
        return _is_small(node.left, small) or _is_small(node.right, small)
    return False


def _divides(node: ast.BinOp, small: set[str]) -> bool:
    """Whether something is divided by a small step, or multiplied by the inverse of one."""
    if isinstance(node.op, ast.Div):
        return _is_small(node.right, small)
    if isinstance(node.op, ast.Mult):
        sides = (node.left, node.right)
        return any(
            isinstance(s, ast.BinOp) and isinstance(s.op, ast.Div) and _is_small(s.right, small)
            for s in sides
        )
    return False


def _has_difference(node: ast.AST, differences: set[str]) -> bool:
    return any(
        (isinstance(part, ast.BinOp) and isinstance(part.op, ast.Sub))
        or (isinstance(part, ast.Name) and part.id in differences)
        for part in ast.walk(node)
    )


def _name_of(node: ast.AST) -> str:
    """The last part of a dotted name; empty for anything else."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""
