"""What a syntax tree says about values: which are small steps, imaginary, or one over a step."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterable

SMALL = 1e-2  # the largest step taken for one
LARGE = 1 / SMALL
INVERSE = 1e3  # a factor of a difference from here on is taken for one over a step
PASSING_ON = frozenset(
    ("float", "float64", "sqrt", "abs", "asarray", "array", "full", "full_like", "tuple", "list")
)
MAKES_COMPLEX = frozenset(("complex", "complex128", "complex64"))
ARITHMETIC: dict[str, type[ast.operator]] = {
    "add": ast.Add,
    "subtract": ast.Sub,
    "multiply": ast.Mult,
    "divide": ast.Div,
    "true_divide": ast.Div,
    "power": ast.Pow,
    "__add__": ast.Add,
    "__radd__": ast.Add,
    "__sub__": ast.Sub,
    "__mul__": ast.Mult,
    "__rmul__": ast.Mult,
    "__truediv__": ast.Div,
}
Binding = tuple[str, ast.expr]


def name_of(node: ast.AST) -> str:
    """The last part of a dotted name; empty for anything else."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def normalized(statement: ast.stmt) -> ast.stmt:
    """A copy in which functions of arithmetic are operators, and getattr(a, "b") is a.b."""
    found = _Normalizer().visit(copy.deepcopy(statement))
    assert isinstance(found, ast.stmt)
    return ast.fix_missing_locations(found)


class _Normalizer(ast.NodeTransformer):
    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        made: ast.expr = node
        if isinstance(node.func, ast.Attribute) and node.func.attr in ARITHMETIC:
            given = list(node.args[:2])
            if len(given) == 1 and node.func.attr.startswith("__"):
                given.insert(0, node.func.value)
            if len(given) == 2:
                made = ast.BinOp(given[0], ARITHMETIC[node.func.attr](), given[1])
        elif name_of(node.func) == "getattr" and len(node.args) > 1:
            attribute = node.args[1]
            if isinstance(attribute, ast.Constant) and isinstance(attribute.value, str):
                made = ast.Attribute(node.args[0], attribute.value, ast.Load())
        return ast.copy_location(made, node)


class Values:
    """Names that hold small steps, imaginary numbers and inverses of steps, in some statements.

    Names are told apart by their text alone, attributes too: a name that holds a step in one
    function holds one in all.
    """

    def __init__(self, statements: Iterable[ast.stmt]) -> None:
        bindings = _bindings(list(statements))
        self._aliases = {
            name: name_of(value)
            for name, value in bindings
            if isinstance(value, (ast.Name, ast.Attribute)) and name != name_of(value)
        }
        self._small: set[str] = set()
        self._imaginary: set[str] = set()
        self._inverse: set[str] = set()
        for names, holds in (
            (self._small, self.is_small),
            (self._imaginary, self._is_imaginary),
            (self._inverse, self._is_inverse),
        ):
            while more := {name for name, value in bindings if holds(value)} - names:
                names.update(more)

    def name(self, node: ast.AST) -> str:
        """The last part of a dotted name, after aliases."""
        found, seen = name_of(node), set()
        while found in self._aliases and found not in seen:
            seen.add(found)
            found = self._aliases[found]
        return found

    def is_small(self, node: ast.expr) -> bool:
        """Whether an expression is a small step, or a product with one, or holds one."""
        if isinstance(node, ast.Constant):
            return isinstance(node.value, (int, float)) and 0 < abs(node.value) <= SMALL
        if isinstance(node, ast.Name):
            return node.id in self._small
        if isinstance(node, ast.UnaryOp):
            return self.is_small(node.operand)
        if isinstance(node, ast.Attribute):
            return node.attr == "eps" or node.attr in self._small
        if isinstance(node, (ast.List, ast.Tuple)):
            return any(self.is_small(each) for each in node.elts)
        if isinstance(node, ast.Dict):
            return any(self.is_small(each) for each in node.values)
        if isinstance(node, ast.Subscript):
            return self.is_small(node.value)
        if isinstance(node, ast.Call):
            name = self.name(node.func)
            passes_on = name in PASSING_ON and any(self.is_small(a) for a in node.args)
            return passes_on or f"{name}()" in self._small or _is_small_text(name, node.args)
        if isinstance(node, ast.BinOp):
            return self._is_small_product(node)
        return False

    def _is_small_product(self, node: ast.BinOp) -> bool:
        left, right = self.is_small(node.left), self.is_small(node.right)
        if isinstance(node.op, ast.Mult):
            return left or right
        if isinstance(node.op, ast.Div):
            return left or (_is_number(node.left) and _is_number(node.right, LARGE))
        if isinstance(node.op, ast.Pow):
            return left or (_is_number(node.left) and isinstance(node.right, ast.UnaryOp))
        return False

    def is_imaginary_step(self, node: ast.AST) -> bool:
        """A small imaginary number: 1e-30j, 1j * h, complex(x, h)."""
        if isinstance(node, ast.Constant):
            return isinstance(node.value, complex) and 0 < abs(node.value.imag) <= SMALL
        if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Mult, ast.Div)):
            return self._is_imaginary(node) and self.is_small(node)
        if isinstance(node, ast.Call) and self.name(node.func) in MAKES_COMPLEX:
            given = [*node.args[1:2], *(k.value for k in node.keywords if k.arg == "imag")]
            return any(self.is_small(each) for each in given)
        return False

    def divides(self, node: ast.BinOp) -> bool:
        """Whether something is divided by a small step, or multiplied by the inverse of one."""
        if isinstance(node.op, ast.Div):
            return self.is_small(node.right)
        is_product = isinstance(node.op, ast.Mult)
        return is_product and any(map(self._is_inverse, (node.left, node.right)))

    def _is_imaginary(self, node: ast.expr) -> bool:
        if isinstance(node, ast.Constant):
            return isinstance(node.value, complex)
        if isinstance(node, ast.Name):
            return node.id in self._imaginary
        if isinstance(node, ast.UnaryOp):
            return self._is_imaginary(node.operand)
        if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Mult, ast.Div)):
            return self._is_imaginary(node.left) or self._is_imaginary(node.right)
        if isinstance(node, ast.Call):
            return self.name(node.func) in MAKES_COMPLEX and all(map(_is_number, node.args))
        return False

    def _is_inverse(self, node: ast.expr) -> bool:
        if isinstance(node, ast.Name):
            return node.id in self._inverse
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
            return self.is_small(node.right)
        return _is_number(node, INVERSE)


def _is_number(node: ast.expr, least: float = 0.0) -> bool:
    is_number = isinstance(node, ast.Constant) and isinstance(node.value, (int, float))
    return is_number and abs(node.value) >= least  # type: ignore[attr-defined]


def _is_small_text(name: str, args: list[ast.expr]) -> bool:
    """float("1e-6")."""
    if name not in ("float", "float64") or not args or not isinstance(args[0], ast.Constant):
        return False
    try:
        return 0 < abs(float(args[0].value)) <= SMALL  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return False


def _bindings(statements: list[ast.stmt]) -> list[Binding]:
    """Each name with what it is bound to: assigned, given, by default, looped over, returned."""
    nodes = [node for statement in statements for node in ast.walk(statement)]
    parameters = {
        node.name: [each.arg for each in (*node.args.posonlyargs, *node.args.args)]
        for node in nodes
        if isinstance(node, ast.FunctionDef)
    }
    found: list[Binding] = []
    for node in nodes:
        if isinstance(node, ast.Assign):
            for target in node.targets:
                found += _unpacked(target, node.value)
        elif isinstance(node, (ast.AnnAssign, ast.NamedExpr)) and node.value is not None:
            found += _unpacked(node.target, node.value)
        elif isinstance(node, (ast.For, ast.comprehension)):
            found += _unpacked(node.target, node.iter)
        elif isinstance(node, (ast.FunctionDef, ast.Lambda)):
            found += _defaults(node.args)
            if isinstance(node, ast.FunctionDef):
                found += _returned(node)
        elif isinstance(node, ast.Call):
            found += zip(parameters.get(name_of(node.func), ()), node.args, strict=False)
            found += [(each.arg, each.value) for each in node.keywords if each.arg]
        elif isinstance(node, ast.ImportFrom):
            found += [
                (each.asname, ast.Name(each.name, ast.Load())) for each in node.names if each.asname
            ]
    return found


def _unpacked(target: ast.expr, value: ast.expr) -> list[Binding]:
    if isinstance(target, (ast.Tuple, ast.List)):
        parts = value.elts if isinstance(value, (ast.Tuple, ast.List)) else []
        if len(parts) != len(target.elts):
            parts = [value] * len(target.elts)
        return [pair for each in zip(target.elts, parts, strict=True) for pair in _unpacked(*each)]
    if isinstance(target, ast.Attribute):
        return [(target.attr, value)]
    return [(target.id, value)] if isinstance(target, ast.Name) else []


def _defaults(args: ast.arguments) -> list[Binding]:
    named = [each.arg for each in (*args.posonlyargs, *args.args)]
    found = list(zip(named[len(named) - len(args.defaults) :], args.defaults, strict=True))
    pairs = zip(args.kwonlyargs, args.kw_defaults, strict=True)
    return found + [(each.arg, value) for each, value in pairs if value is not None]


def _returned(function: ast.FunctionDef) -> list[Binding]:
    returns = [node for node in ast.walk(function) if isinstance(node, ast.Return)]
    return [(f"{function.name}()", node.value) for node in returns if node.value is not None]
