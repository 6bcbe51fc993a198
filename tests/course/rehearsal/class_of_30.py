"""Thirty fabricated students, and what each hands in for an assignment."""

from __future__ import annotations

import ast
import json
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

from photograd_course.assignment.checks import load_checks
from photograd_course.assignment.manifest import Manifest, read_manifest
from photograd_course.build.named import NamedMutant, read_alternatives, read_mutants
from photograd_course.build.regions import find_regions, strip_solution

# Invented; accents, a space, an apostrophe and two of one name are what registers hold.
NAMES = (
    "Ada Abel",
    "Björn Åkesson",
    "Chloé Dubois",
    "Dmitri Orlov",
    "Emre Yılmaz",
    "Fatima Zahra",
    "Gustavo Peña",
    "Hana Sato",
    "Ivo Novák",
    "Jun Li",
    "Jun Li",
    "Kofi Mensah",
    "Lena Groß",
    "Maeve O'Brien",
    "Nikos Pappas",
    "Olga Sidorova",
    "Priya Rao",
    "Quentin Roy",
    "Rosa Marín",
    "Søren Dahl",
    "Tomáš Dvořák",
    "Uma Iyer",
    "Vera Lindqvist",
    "Wei Zhang",
    "Xenia Vlachou",
    "Yusuf Demir",
    "Zoë de Vries",
    "Amara Okafor",
    "Bao Nguyen",
    "Carla Bruno",
)
MUTANTS = 5


@dataclass(frozen=True)
class HandIn:
    """What one student hands in, and what the grade must be.

    Attributes:
        student, number: name and id.
        kind: such as "perfect".
        files: name to content.
        score: of the code; None where the entry is no submission that can be graded.
        at_most: where the score is not known exactly, the highest that it can be; at least it is
            more than nothing and less than this.
        late: whether it came after the due date.
        earlier: files of an attempt before this one.
    """

    student: str
    number: int
    kind: str
    files: dict[str, bytes]
    score: Fraction | None = None
    at_most: Fraction | None = None
    late: bool = False
    earlier: dict[str, bytes] = field(default_factory=dict)


class Texts:
    """Texts of one assignment's module, from right to broken."""

    def __init__(self, folder: Path) -> None:
        self.manifest: Manifest = read_manifest(folder)
        self.file = f"{self.manifest.module}.py"
        self.solution = (folder / self.file).read_text(encoding="utf-8")
        self.starter = strip_solution(self.solution, self.file)
        self.alternatives = list(read_alternatives(folder).values())
        mutants = read_mutants(folder)
        self.mutants = mutants[:: max(1, len(mutants) // MUTANTS)][:MUTANTS]
        self.full = Fraction(self.manifest.points["code"])
        self.points = {c.id: Fraction(str(c.points)) for c in load_checks(self.manifest)}
        self.brought = {
            path.name: path.read_bytes()
            for path in folder.parent.glob("*/*.py")
            if path.stem in self.manifest.brought
        }

    def half(self) -> str:
        """The first half of the solution is written, the rest still stubs."""
        regions = find_regions(self.solution, self.file)
        lines: dict[int, str] = dict(enumerate(self.solution.splitlines(), start=1))
        for region in regions[: (len(regions) + 1) // 2]:
            gone = range(region.first, region.last + 1)
            for k in gone if region.kind == "student" else (region.first, region.last):
                del lines[k]
        return strip_solution("\n".join(lines.values()) + "\n", self.file)

    def score_of(self, mutant: NamedMutant) -> Fraction:
        """Everything but the checks that it loses."""
        return self.full - sum((self.points[each] for each in mutant.loses), Fraction(0))

    def disguised(self) -> str:
        """The solution under other names of its own variables."""
        tree = ast.parse(self.solution)
        for function in ast.walk(tree):
            if isinstance(function, ast.FunctionDef):
                _rename(function)
        return ast.unparse(tree) + "\n"


def _rename(function: ast.FunctionDef) -> None:
    inner = {
        name
        for node in ast.walk(function)
        if node is not function and isinstance(node, (ast.FunctionDef, ast.Lambda))
        for name in _arguments(node.args)
    }
    stored = {
        node.id
        for node in ast.walk(function)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    }
    declared = {
        name
        for node in ast.walk(function)
        if isinstance(node, (ast.Nonlocal, ast.Global))
        for name in node.names
    }
    own = stored - inner - declared - set(_arguments(function.args))
    for node in ast.walk(function):
        if isinstance(node, ast.Name) and node.id in own:
            node.id = f"my_{node.id}"


def _arguments(given: ast.arguments) -> list[str]:
    return [each.arg for each in (*given.posonlyargs, *given.args, *given.kwonlyargs)]


def class_of_30(folder: Path) -> list[HandIn]:
    """What the class hands in for the assignment in a source folder, by register number."""
    texts = Texts(folder)
    full, none = texts.full, Fraction(0)
    made: list[tuple[str, dict[str, bytes], dict[str, object]]] = []

    def add(kind: str, text: str, **known: object) -> None:
        made.append((kind, {texts.file: text.encode(), **texts.brought}, known))

    def wrong(kind: str, k: int, **known: object) -> None:
        mutant = texts.mutants[k % len(texts.mutants)]
        add(kind, mutant.apply(texts.solution), score=texts.score_of(mutant), **known)

    for text in (texts.solution, *texts.alternatives):
        add("perfect", text, score=full)
    half = texts.half()
    for _ in range(3):
        add(
            "partial",
            half,
            **({"at_most": full} if "NotImplementedError" in half else {"score": full}),
        )
    for k in range(MUTANTS):
        wrong("wrong", k)
    add("late", texts.solution, score=full, late=True)
    wrong("late and wrong", 1, late=True)
    add("copied", texts.disguised(), score=full)
    add("two attempts", texts.solution, score=full, earlier={texts.file: texts.starter.encode()})
    add("other bytes", f"\ufeff{texts.solution}".replace("\n", "\r\n"), score=full)
    final = {f"final_{texts.file}": texts.solution.encode(), **texts.brought}
    made.append(("renamed", final, {}))
    made.append(("notebook", {"work.ipynb": notebook(texts.solution)}, {}))
    made.append(("nothing", {}, {}))
    broken = (("untouched", ""), ("crashes", "\n1 / 0\n"), ("leaves", "\nraise SystemExit(0)\n"))
    while len(made) < len(NAMES):
        for kind, more in (*broken, ("no Python", "\ndef (:\n")):
            add(kind, texts.starter + more, score=none)
    return [
        HandIn(NAMES[k], 41000 + k, kind, files, **known)  # type: ignore[arg-type]
        for k, (kind, files, known) in enumerate(made[: len(NAMES)])
    ]


def notebook(text: str) -> bytes:
    """A notebook with the module in one cell: not what is graded."""
    cell = {"cell_type": "code", "source": text, "metadata": {}, "outputs": []}
    whole = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole).encode()
