"""Checkpoints of recoveries with one thing wrong: refused, and the recovery stays as it was."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, IoError
from photograd.transport import PathTracer
from photograd.transport.builtin import cornell_box
from photograd.transport.inverse import InverseRendering, RecoveryOptions

NAMES = ["materials.red.albedo", "emission.lamp"]
OPTIONS = RecoveryOptions(steps=6, spp=1)
SCENE = cornell_box(6)
PICTURE = PathTracer(SCENE).render(spp=4, seed=1).mean


def recovery() -> InverseRendering:
    return InverseRendering(SCENE, PICTURE, NAMES, OPTIONS)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("recovery")
    job = recovery()
    job.run(folder, should_stop=lambda: job.step_number == 2)
    with np.load(folder / "recovery.npz") as archive:
        arrays: dict[str, Any] = {name: archive[name] for name in archive.files}
    return arrays


def others(old: Any) -> list[Any]:
    found = [np.zeros(0), old[..., None], old.astype(np.float32), old.astype(complex), -old - 1]
    if old.ndim:
        found += [old[:-1], np.concatenate([old, old[:1]])]
    return [*found, np.full(old.shape, np.nan), np.full(old.shape, np.inf)]


@pytest.mark.filterwarnings("ignore")  # NumPy warns of overflows that a later check reports
def test_whatever_is_changed_it_is_refused_or_goes_on(
    saved: dict[str, Any], tmp_path: Path
) -> None:
    meta = json.loads(str(saved["meta"]))
    changed = [
        saved | {"meta": np.array(json.dumps(meta | {name: value}))}
        for name in meta
        for value in (None, "x", [], {}, -1, 1.5, True, 7, 2**70)
    ]
    arrays = [name for name in saved if name != "meta"]
    changed += [saved | {name: other} for name in arrays for other in others(saved[name])]
    changed += [{n: a for n, a in saved.items() if n != name} for name in saved]
    refused = 0
    for each in changed:
        np.savez(tmp_path / "recovery.npz", **each)
        job = recovery()
        try:
            job.load(tmp_path)
            job.step()
        except Error:
            refused += 1
    assert len(changed) > 150
    assert 0.8 * len(changed) < refused < len(changed)


def test_a_refusal_names_the_array_and_changes_nothing(
    saved: dict[str, Any], tmp_path: Path
) -> None:
    job = recovery()
    before = {name: x.copy() for name, x in job.x.items()}
    name = "params.materials.red.albedo"
    np.savez(tmp_path / "recovery.npz", **saved | {name: np.array([0.5, np.nan, 0.5])})
    words = (
        r"recover: .*a checkpoint of a recovery, got .*red\.albedo: expected finite values, got 1"
    )
    with pytest.raises(IoError, match=words):
        job.load(tmp_path)
    assert job.step_number == 0
    assert all(np.array_equal(job.x[n], x) for n, x in before.items())
