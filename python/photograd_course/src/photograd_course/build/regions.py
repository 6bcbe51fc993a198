"""What students get of an instructor's source: stubs for solutions."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from .markers import Region, RegionError, find_regions, region_error

__all__ = [
    "Region",
    "RegionError",
    "SolutionPart",
    "find_regions",
    "solution_parts",
    "strip_solution",
]


@dataclass(frozen=True)
class SolutionPart:
    """One solution region: its task, the function it is in ("" at module level) and its lines."""

    task: str
    function: str
    text: str


def strip_solution(text: str, file: str = "source") -> str:
    """The starter: each solution gives way to its student block, or to an exception.

    A solution inside a function leaves ``raise NotImplementedError("01.2 gd_1d: see the handout,
    section 2")`` at its own indentation; one at module or class level (a helper of its own) leaves
    nothing.

    Raises:
        RegionError: see `find_regions`; or a student block holds other than comments, or does not
            stand directly below a solution.
    """
    lines = text.splitlines()
    regions = find_regions(text, file)
    owners = _owners(text, file, regions)
    result: list[str] = []
    at = 0  # lines done so far
    for number, region in enumerate(regions):
        result += lines[at : region.first - 1]
        at = region.last
        below = regions[number + 1] if number + 1 < len(regions) else None
        if region.kind == "student":
            before = regions[number - 1] if number else None
            if before is None or before.kind != "solution" or before.last + 1 != region.first:
                raise region_error(
                    file, region.first, "a student block directly below a solution", "none"
                )
            result += _uncommented(lines[region.first : region.last - 1], file, region.first + 1)
        elif below is None or below.kind != "student":
            result += _default_stub(region, owners[region])
    return _tidy([*result, *lines[at:]])


def solution_parts(text: str, file: str = "source") -> tuple[SolutionPart, ...]:
    """The solutions of a source, in order.

    Raises:
        RegionError: see `find_regions`.
    """
    lines = text.splitlines()
    regions = find_regions(text, file)
    owners = _owners(text, file, regions)
    return tuple(
        SolutionPart(
            region.task, owners[region], "\n".join(lines[region.first : region.last - 1]) + "\n"
        )
        for region in regions
        if region.kind == "solution"
    )


def _owners(text: str, file: str, regions: tuple[Region, ...]) -> dict[Region, str]:
    """The function that each solution is in: "gd_1d", "Value.exp", or "" outside of functions."""
    try:
        tree = ast.parse(text)
    except SyntaxError as error:
        raise region_error(file, error.lineno or 0, "Python", error.msg) from error
    found: dict[Region, str] = {}
    for region in regions:
        if region.kind != "solution":
            continue
        inside = [n.lineno for n in ast.walk(tree) if isinstance(n, ast.stmt)]
        first = min((n for n in inside if region.first < n < region.last), default=None)
        if first is None:
            raise region_error(file, region.first, "code between the markers of a solution", "none")
        found[region] = _owner(tree, region, first)
    return found


def _owner(tree: ast.AST, region: Region, line: int) -> str:
    """Names of definitions around ``line`` that begin before the region, if a function is last."""
    names: list[str] = []
    in_function, node = False, tree
    while True:
        for child in ast.iter_child_nodes(node):
            kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
            if not isinstance(child, ast.stmt) or child.lineno >= region.first:
                continue
            if child.lineno <= line <= (child.end_lineno or 0):
                if isinstance(child, kinds):
                    names.append(child.name)
                    in_function = not isinstance(child, ast.ClassDef)
                node = child
                break
        else:
            return ".".join(names) if in_function else ""


def _default_stub(region: Region, function: str) -> list[str]:
    if not function:
        return []
    section = region.task.partition(".")[2]
    text = f"{region.task} {function}: see the handout, section {section}"
    return [f'{" " * region.indent}raise NotImplementedError("{text}")']


def _uncommented(lines: list[str], file: str, first: int) -> list[str]:
    result = []
    for number, line in enumerate(lines):
        bare = line.lstrip()
        if bare and not bare.startswith("#"):
            raise region_error(file, first + number, "comment lines only in a student block", bare)
        code = bare[2:] if bare.startswith("# ") else bare[1:]
        result.append((line[: len(line) - len(bare)] + code).rstrip())
    return result


def _tidy(lines: list[str]) -> str:
    """Lines as a text, with at most two empty ones in a row, as formatters leave them."""
    kept: list[str] = []
    for line in lines:
        if line.strip() or (any(kept[-2:]) and kept):
            kept.append(line.rstrip() if not line.strip() else line)
    while kept and not kept[-1].strip():
        kept.pop()
    return "\n".join(kept) + "\n"
