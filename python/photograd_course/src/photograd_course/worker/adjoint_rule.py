"""The rule that an adjoint is written, looked for in the syntax tree of a submission.

Three ways to get a derivative without writing it leave marks: a complex step has a small imaginary
part, a dual number is a class that overloads arithmetic, and differencing moves an argument by a
small step and divides a difference by it. Looked at are an adjoint and all that it names of the
submission, directly, by an alias, as an attribute or in a string. Small constants in other places
(a floor, a learning rate) are no marks, nor is a class that keeps what its numbers were computed
from: a tape. The worker looks before it loads the submission, when nothing can yet speak for it.
What is disguised better is seen when it runs (`adjoint_watch`).
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping

from .adjoint_values import Values, name_of, normalized

OVERLOADS = frozenset(
    f"__{name}__" for name in ("mul", "rmul", "matmul", "truediv", "array_ufunc", "array_function")
)
ARRAY_BASES = frozenset(("ndarray", "NDArrayOperatorsMixin"))
INTERNALS = frozenset(
    (
        *("__globals__", "__code__", "__closure__", "__builtins__", "__subclasses__"),
        *("_getframe", "f_back", "f_globals", "f_locals", "gi_frame", "tb_frame"),
        *("builtins", "eval", "exec"),  # of pure modules, such as dataclasses.builtins
    )
)
DYNAMIC = frozenset(
    ("eval", "exec", "compile", "globals", "locals", "vars", "__import__", "__builtins__")
)
COMPLEX = "takes a complex step"
DUAL = "uses a class that overloads arithmetic"
DIFFERENCES = "divides a difference by a small step"
HIDDEN = "runs or names code by text"

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
        always = [top for top in tops if _patches(top[1])]
        found: dict[str, dict[str, object]] = {}
        for adjoint in adjoints:
            reached = _reached(adjoint, defined)
            reached += [top for top in always if reached and top not in reached]
            plain = [(file, normalized(statement)) for file, statement in reached]
            values = Values(statement for _, statement in plain)
            for file, statement in plain:
                for line, what in _marks(statement, values):
                    found.setdefault(adjoint, {"file": file, "line": line, "what": what})
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return {}
    return found


def _definitions(tops: Iterable[Top]) -> dict[str, list[Top]]:
    """Statements at the top of the modules, by the names that they bind."""
    defined: dict[str, list[Top]] = {}
    for top in tops:
        for name in _bound(top[1]):
            defined.setdefault(name, []).append(top)
    return defined


def _bound(statement: ast.stmt) -> set[str]:
    if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
        return {statement.name}
    names = set()
    for node in ast.walk(statement):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.alias):
            names.add(node.asname or node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
    return names


def _patches(statement: ast.stmt) -> bool:
    """Whether it runs when the module is loaded and may bind names that its tree does not show."""
    if isinstance(statement, (ast.FunctionDef, ast.ClassDef)) or _is_main(statement):
        return False
    return any(_is_dynamic(node) for node in ast.walk(statement))


def _is_main(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.If) and "__name__" in ast.unparse(statement.test)


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
                if (named := _named(node)) and named not in known:
                    known.add(named)
                    names.append(named)
    return reached


def _named(node: ast.AST) -> str:
    """The name by which a node may refer to a statement at the top of a module."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    return node.name if isinstance(node, ast.alias) else name_of(node)


def _marks(statement: ast.stmt, values: Values) -> Iterator[tuple[int, str]]:
    """Line and kind of each mark."""
    nodes = list(ast.walk(statement))
    differences = {
        target.id
        for node in nodes
        if isinstance(node, ast.Assign) and _has_difference(node.value, set())
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    is_moved = any(_moves(node, values) for node in nodes)
    for node in nodes:
        line = getattr(node, "lineno", 0)
        if _is_dynamic(node):
            yield line, HIDDEN
        elif _is_dual(node, values):
            yield line, DUAL
        elif values.is_imaginary_step(node) or _sets_imaginary(node, values):
            yield line, COMPLEX
        elif isinstance(node, ast.BinOp) and values.divides(node):
            if any(name_of(part) == "imag" for part in ast.walk(node)):
                yield line, COMPLEX
            elif is_moved and _has_difference(node, differences):
                yield line, DIFFERENCES


def _is_dynamic(node: ast.AST) -> bool:
    """Whether it runs text, or names something by a text that is not written out."""
    if isinstance(node, ast.Name):
        return node.id in DYNAMIC
    if isinstance(node, ast.Attribute):
        return node.attr in INTERNALS
    if isinstance(node, ast.alias):
        return node.name.rpartition(".")[2] in INTERNALS
    if isinstance(node, ast.Call) and name_of(node.func) in ("getattr", "setattr"):
        return len(node.args) > 1 and not isinstance(node.args[1], ast.Constant)
    return False


def _is_dual(node: ast.AST, values: Values) -> bool:
    """A class that overloads arithmetic, or a way to make one without a class statement."""
    if isinstance(node, ast.ClassDef):
        functions = [each for each in node.body if isinstance(each, ast.FunctionDef)]
        names = {each.name for each in functions}
        bound = (_bound(each) for each in node.body if isinstance(each, ast.Assign))
        names.update(*bound)
        if {values.name(base) for base in node.bases} & ARRAY_BASES:
            return True
        return bool(names & OVERLOADS) and not any(map(_keeps_operands, functions))
    if isinstance(node, ast.Call):
        return values.name(node.func) == "type" and len(node.args) == 3
    if isinstance(node, ast.Attribute):
        return isinstance(node.ctx, ast.Store) and node.attr in OVERLOADS
    return isinstance(node, ast.Constant) and node.value in OVERLOADS


def _keeps_operands(function: ast.FunctionDef) -> bool:
    """Whether an operator passes itself on, as a tape does: in a tuple, a call or a function."""
    if function.name not in OVERLOADS or not function.args.args:
        return False
    own = function.args.args[0].arg
    for node in ast.walk(function):
        if isinstance(node, (ast.Tuple, ast.List)):
            held = node.elts
        elif isinstance(node, ast.Call) and name_of(node.func) != "isinstance":
            held = node.args
        elif isinstance(node, (ast.Lambda, ast.FunctionDef)) and node is not function:
            held = [each for each in ast.walk(node) if isinstance(each, ast.expr)]
        else:
            continue
        if any(isinstance(each, ast.Name) and each.id == own for each in held):
            return True
    return False


def _sets_imaginary(node: ast.AST, values: Values) -> bool:
    """z.imag = h, z.imag[i] += h, setattr(z, "imag", h)."""
    if isinstance(node, ast.Assign):
        targets, value = node.targets, node.value
    elif isinstance(node, ast.AugAssign):
        targets, value = [node.target], node.value
    elif isinstance(node, ast.Call) and name_of(node.func) == "setattr" and len(node.args) == 3:
        targets, value = [node.args[1]], node.args[2]
    else:
        return False
    roots = [each.value if isinstance(each, ast.Subscript) else each for each in targets]
    is_part = any(
        name_of(root) == "imag" or (isinstance(root, ast.Constant) and root.value == "imag")
        for root in roots
    )
    return is_part and values.is_small(value)


def _moves(node: ast.AST, values: Values) -> bool:
    """Whether something is moved by a small step: x + h, x - h, x[i] += h."""
    if isinstance(node, ast.AugAssign):
        return isinstance(node.op, (ast.Add, ast.Sub)) and values.is_small(node.value)
    if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub)):
        return values.is_small(node.left) or values.is_small(node.right)
    return False


def _has_difference(node: ast.AST, differences: set[str]) -> bool:
    return any(
        (isinstance(part, ast.BinOp) and isinstance(part.op, ast.Sub))
        or (isinstance(part, ast.Name) and part.id in differences)
        for part in ast.walk(node)
    )
