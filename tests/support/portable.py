"""What the sources of a fit may not compute with, since its last bits depend on the processor."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping

COURSE, CORE = "python/photograd_course/src/photograd_course/", "python/photograd/"
PROMISED = (
    *(COURSE + name for name in ("color.py", "losses.py", "optim/", "priors.py", "random.py")),
    *(COURSE + name for name in ("resample.py", "row_map.py", "schedules.py")),
    *(CORE + name for name in ("fields/", "representation/", "textures/", "transport/inverse/")),
    *(CORE + "fitting/" + name for name in ("data.py", "loop.py", "loss.py", "model.py")),
    *(CORE + "fitting/" + name for name in ("steps.py", "surface_points.py")),
    *(
        CORE + "splats/" + name
        for name in ("clone_split_prune.py", "density.py", "markov_chain.py")
    ),
    *(CORE + "splats/" + name for name in ("model.py", "start.py")),
    *(CORE + "capture/" + name for name in ("assemble.py", "bounds.py", "camera.py")),
    *(CORE + "capture/" + name for name in ("convention.py", "frames.py", "view.py")),
)
"""Beginnings of the paths of what a fit, or a recovery of a scene, runs through."""

_NAMES = """
exp exp2 expm1 log log2 log10 log1p logaddexp logaddexp2 pow power float_power cbrt hypot
sin cos tan arcsin arccos arctan arctan2 asin acos atan atan2 sinc
sinh cosh tanh arcsinh arccosh arctanh asinh acosh atanh
dot vdot inner matmul tensordot convolve correlate cov corrcoef argpartition
"""
CHOSEN_BY_PROCESSOR = frozenset(_NAMES.split())
_FUNCTION = re.compile(r"(np|numpy|math)\.\w+")
_ALGEBRA = re.compile(r"(np|numpy)\.linalg\.\w+")


def is_promised(path: str) -> bool:
    """Whether equal bits are promised for what this file computes."""
    return path.startswith(PROMISED)


def portable_breaches(texts: Mapping[str, str]) -> list[str]:
    """One line for each use, in these files, of what depends on the processor."""
    return [
        f"{path}:{line}: {what}; see photograd_course/portable_math.py"
        for path, text in texts.items()
        for line, what in sorted(_found(ast.parse(text)))
    ]


def _found(tree: ast.Module) -> Iterator[tuple[int, str]]:
    safe_norms = {
        id(call.func)
        for call in ast.walk(tree)
        if isinstance(call, ast.Call) and ast.unparse(call.func) == "np.linalg.norm"
        if any(word.arg == "axis" for word in call.keywords)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp | ast.AugAssign):
            yield from _operator(node)
        elif isinstance(node, ast.Attribute):
            name = ast.unparse(node)
            chosen = bool(_FUNCTION.fullmatch(name)) and node.attr in CHOSEN_BY_PROCESSOR
            algebra = bool(_ALGEBRA.fullmatch(name)) and id(node) not in safe_norms
            if chosen or algebra or node.attr == "dot":
                yield node.lineno, name
        elif isinstance(node, ast.Call):
            yield from _sorting(node)
        elif isinstance(node, ast.ImportFrom) and node.module in ("math", "numpy"):
            yield from ((node.lineno, a.name) for a in node.names if a.name in CHOSEN_BY_PROCESSOR)


def _operator(node: ast.BinOp | ast.AugAssign) -> Iterator[tuple[int, str]]:
    if isinstance(node.op, ast.MatMult):
        yield node.lineno, "@"
    if isinstance(node.op, ast.Pow):
        try:
            ast.literal_eval(node.left), ast.literal_eval(node.right)
        except (AttributeError, ValueError):  # an assignment has no sides; a name has no value
            yield node.lineno, "**"


def _sorting(node: ast.Call) -> Iterator[tuple[int, str]]:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else ""
    words = {word.arg: word.value for word in node.keywords}
    if name == "argsort" and ast.unparse(words.get("kind", ast.Constant(None))) != "'stable'":
        yield node.lineno, "argsort without kind='stable'"
    if name == "einsum" and "optimize" in words:
        yield node.lineno, "einsum with optimize"
