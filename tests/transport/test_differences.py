"""docs/results_differences.md: whole, in agreement, and measured again in part."""

from __future__ import annotations

import json
import random
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.bsdf import phase
from photograd.lights import registry as lights
from photograd.transport import PathOptions, PathTracer
from photograd.transport.incomplete import TURNING
from photograd.transport.material import MODELS

from support.tree import ROOT
from tests.transport import difference_page as page
from tests.transport.difference_rows import LAYERED, PATHS, VEILED, Case, Row, cases, check
from tests.transport.differences import LEAST, Bench, Estimate

KNOWN: dict[str, dict[str, Any]] = json.loads((ROOT / "docs/differences.json").read_text("utf-8"))
OPEN = 0  # rows that more paths would decide
BLUR = 0.1  # of the derivative: what an open row may still be uncertain by
AGAIN = 5  # rows
QUICK = 16  # batches: rows of which less is enough
SPP = 256
Z = 8.0  # of as many batches: Student's t with seven degrees of freedom, a false alarm in 1e4


def numbers(thing: str, parameters: Any) -> set[str]:
    """Names of a row for every number."""
    return {
        f"{thing}.{p.name}" + (f"[{c}]" if p.size > 1 else "")
        for p in parameters
        for c in range(p.size)
    }


def registered(models: Any, lights: Any, phases: Any) -> set[str]:
    """What the registries say has a derivative, whole or not."""
    names = {
        name
        for model in models
        for name in numbers(
            model, [p for p in models[model].parameters if p.name in LAYERED.get(model, (p.name,))]
        )
    }
    turned = {model: TURNING[model][0] for model in TURNING}
    names -= {f"{model}.{name}" for model in turned for name in turned[model]}
    names |= {f"{model} ball.{name}" for model in turned for name in turned[model]}
    names |= {f"{model}.alpha" for model in VEILED}
    names |= {name for light in lights for name in numbers(light, lights[light].parameters())}
    for name, function in phases.items():
        names |= {f"{name}.{key}[{c}]" for key in ("sigma_t", "albedo") for c in range(3)}
        names |= numbers(name, function.parameters)
    return names


def test_every_parameter_of_every_registry_has_a_row() -> None:
    rows = [row.name for case in cases() for row in case.rows]
    assert len(rows) == len(set(rows))
    assert registered(MODELS, lights(), phase.registry()) <= set(rows)
    for other in ("environment map.texels", "grid.density", "veil.texels"):
        assert any(name.startswith(other) for name in rows)
    assert list(KNOWN) == rows  # else: python docs/results_differences.py
    for case in cases():
        check(case, PathTracer(case.scene(), dtype=np.float64))


def test_a_model_without_rows_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(MODELS, "chalk", MODELS["lambert"])
    new = {f"chalk.albedo[{c}]" for c in range(3)}
    assert registered(MODELS, lights(), phase.registry()) - set(KNOWN) == new
    assert {row.name for case in cases() for row in case.rows} - set(KNOWN) == new


def test_every_row_holds_and_the_page_says_so() -> None:
    judged = {row.name for case in cases() if not case.refused for row in case.rows}
    assert [name for name in judged if page.fails(KNOWN[name])] == []
    assert [name for name in judged if page.error(KNOWN[name]) > BLUR] == []
    assert sum(not page.holds(KNOWN[name]) for name in judged) <= OPEN
    # What is refused is not the whole derivative: the comparison sees it.
    refused = set(KNOWN) - judged
    assert len(refused) == 5
    assert all(page.fails(KNOWN[name]) for name in refused)
    text = (ROOT / "docs/results_differences.md").read_text("utf-8")
    between = text.partition(page.BEGIN)[2].partition(page.END)[0]
    assert between.strip().splitlines() == page.tables(KNOWN)


def test_a_wrong_row_fails() -> None:
    for row in KNOWN.values():
        if page.holds(row):
            for factor in (0.0, -1.0, 0.5, 0.97, 1.03, 2.0):
                wrong = {**row, "adjoint": [factor * row["adjoint"][0], *row["adjoint"][1:]]}
                assert page.fails(wrong)


def again(case: Case, row: Row, paths: PathOptions = PATHS) -> tuple[Estimate, Estimate]:
    """Both estimates, by fewer paths."""
    bench = Bench(case, row, spp=SPP, paths=paths)
    adjoint, whole = bench.adjoint(), bench.differences()
    cut = bench.cut(Estimate(0.0, 0.0, 0), 0.01, LEAST, abs(whole.mean))
    error = float(np.hypot(whole.error, cut.error))
    return adjoint, Estimate(whole.mean + cut.mean, error, whole.batches)


def far_apart(a: Estimate, b: Estimate) -> bool:
    """Whether chance does not explain the difference, or is so large that it explains anything."""
    chance = np.hypot(a.error, b.error)
    return bool(abs(a.mean - b.mean) > Z * chance or Z * chance > 0.5 * abs(b.mean))


def test_some_rows_again() -> None:
    # Which ones, the compiled core decides: others whenever it has changed.
    seed = zlib.crc32(Path(_core.__file__).read_bytes())
    quick = {name for name, row in KNOWN.items() if row["differences"][2] <= QUICK}
    known = [(case, row) for case in cases() if not case.refused for row in case.rows]
    chosen = random.Random(seed).sample([pair for pair in known if pair[1].name in quick], AGAIN)
    for case, row in chosen:
        kept = KNOWN[row.name]
        adjoint, other = again(case, row)
        assert not far_apart(adjoint, other), row.name
        assert not far_apart(adjoint, Estimate(*kept["adjoint"])), row.name
        error = float(np.hypot(kept["differences"][1], kept["cut"][1]))
        both = Estimate(page.difference(kept), error, kept["differences"][2])
        assert not far_apart(other, both), row.name


def test_wrong_gradients_are_rejected() -> None:
    (case,) = (c for c in cases() if c.kind == "model" and c.thing == "ggx_metal")
    row = case.rows[0]
    right, other = again(case, row)
    assert not far_apart(right, other)
    for factor in (0.0, -1.0, 0.5, 2.0, 1 / np.pi):
        wrong = Estimate(factor * right.mean, abs(factor) * right.error, right.batches)
        assert far_apart(wrong, other), factor
    # Only the first bounce is differentiated; or another channel.
    first, _ = again(case, row, replace(PATHS, max_depth=2))
    channel, _ = again(case, replace(row, place=(1,)))
    assert far_apart(first, other)
    assert far_apart(channel, other)
