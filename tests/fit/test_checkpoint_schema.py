"""Checkpoints with one thing wrong: refused by a typed error, or good enough to go on from."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, IoError, RangeError
from photograd.fields import TexturedMesh
from photograd.fitting import FitOptions
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model

from tests.fit import scene
from tests.fit.mesh_scene import cube

Arrays = dict[str, Any]
TINY: Arrays = {"resolution": 8, "steps": 12, "rays": 16, "degree": 1, "gaussians": 20}
KINDS = ("dense_grid", "sparse_sh", "dense_sh", "octree_sh", "gaussians", "textured_mesh")
CAPTURE = replace(scene.capture(), train=scene.capture().train[:3])


@pytest.fixture(scope="module", params=KINDS)
def saved(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Arrays:
    """All arrays of a checkpoint after two steps; `meta` as an object."""
    folder = tmp_path_factory.mktemp(request.param)
    first = None
    if request.param == "octree_sh":
        grid = Fit.start(CAPTURE, scene.options(**TINY))
        grid.model.params["values"][2:6, 2:6, 2:6, 3] = 10.0
        grid.save(folder)
        first = load_model(folder)
    if request.param == "textured_mesh":
        first = Model.of(TexturedMesh.of_mesh(cube()))
    options = scene.options(**TINY, representation=request.param, background="learned")
    if request.param == "gaussians":
        options = replace(options, background="auto")
    fit = Fit.start(CAPTURE, options, start_from=first)
    fit.run(folder, should_stop=lambda: fit.step_number == 2)
    with np.load(folder / "model.npz") as archive:
        arrays: Arrays = {name: archive[name] for name in archive.files}
    return arrays | {"meta": json.loads(str(arrays["meta"]))}


def write(folder: Path, arrays: Arrays) -> None:
    np.savez(folder / "model.npz", **(arrays | {"meta": np.array(json.dumps(arrays["meta"]))}))


def other_values(old: Any) -> list[Any]:
    """What a field of the meta data may hold instead."""
    values: list[Any] = [None, "", "x", [], {}, [0.5], True, -1, 0, 0.5, float("nan"), 2**70]
    if isinstance(old, list):
        values += [old[:-1], [*old, old[-1]], old[::-1], [str(x) for x in old], [None] * len(old)]
        values += [[float("inf")] * len(old), [-1] * len(old)]
    return values


def other_arrays(old: Any) -> list[Any]:
    """What may be in the place of an array."""
    found = [
        np.zeros(0),
        np.array("x"),
        old[..., None],
        old.astype(complex),
        old.astype("U8"),
        old.astype(old.dtype.newbyteorder()),
        old.astype(np.float16),
        old.astype(bool),
        old.astype(np.int64),
        old.astype(np.float64),
        np.zeros_like(old),
        -np.abs(old) - 1,
        np.full_like(old, 10**9 if old.dtype.kind != "u" else 255),
    ]
    if old.ndim:
        found += [old[:-1], np.concatenate([old, old[:1]]), old[::-1], old.T.copy(), old.ravel()]
        found += [old[..., :-1], old[0]]
    if old.dtype.kind == "f":
        for value in (np.nan, np.inf, 1e30):
            changed = old.copy()
            changed.flat[changed.size // 2 if changed.size else slice(0)] = value
            found.append(changed)
    return found


def mutations(arrays: Arrays) -> list[tuple[str, Arrays]]:
    """One change each: of a field of the meta data, an entry of its objects, or an array."""
    found: list[tuple[str, Arrays]] = []
    meta = arrays["meta"]
    for name, old in meta.items():
        places: list[tuple[tuple[str, ...], Any]] = [((name,), old)]
        if isinstance(old, dict):
            places += [((name, key), value) for key, value in old.items()]
        for place, value in places:
            for k, other in enumerate(other_values(value)):
                changed = json.loads(json.dumps(meta))
                inner = changed if len(place) == 1 else changed[name]
                inner[place[-1]] = other
                found.append((f"meta.{'.'.join(place)} {k}: {other!r}", arrays | {"meta": changed}))
            changed = json.loads(json.dumps(meta))
            del (changed if len(place) == 1 else changed[name])[place[-1]]
            found.append((f"meta.{'.'.join(place)} missing", arrays | {"meta": changed}))
    for name, old in arrays.items():
        if name == "meta":
            continue
        found += [
            (f"{name} {k}: {other.dtype} {other.shape}", arrays | {name: other})
            for k, other in enumerate(other_arrays(old))
        ]
        found.append((f"{name} missing", {n: a for n, a in arrays.items() if n != name}))
    for name in ("params.more", "state.more", "optimizer.mean/more", "more", "params."):
        found.append((f"{name} added", arrays | {name: np.zeros(3, np.float32)}))
    found.append(("meta.options.more", with_option(arrays, more=1)))
    return found


def with_option(arrays: Arrays, **entries: Any) -> Arrays:
    meta = json.loads(json.dumps(arrays["meta"]))
    meta["options"].update(entries)
    return arrays | {"meta": meta}


@pytest.mark.filterwarnings("ignore")  # NumPy warns of overflows that a later check reports
def test_whatever_is_changed_it_is_refused_or_goes_on(saved: Arrays, tmp_path: Path) -> None:
    changes = mutations(saved)
    kind = KINDS.index(saved["meta"]["options"]["representation"])
    # Options are alike in all representations, so each takes a fifth; of arrays, a third.
    chosen = [x for x in changes if x[0].startswith("meta.")][kind::5]
    chosen += [x for x in changes if not x[0].startswith("meta.")][kind % 3 :: 3]
    assert len(chosen) > 150
    refused, untyped = 0, []
    for label, arrays in chosen:
        write(tmp_path, arrays)
        try:
            fit = Fit.resume(CAPTURE, tmp_path)
            fit.step()
        except Error:
            refused += 1
        except Exception as failure:
            untyped.append(f"{label}: {type(failure).__name__}: {failure}")
    assert not untyped, "\n".join(untyped)
    assert 0.5 * len(chosen) < refused < len(chosen)


WRONG: dict[str, tuple[Callable[[Arrays], Any], str]] = {
    "one fraction": (
        lambda a: a["meta"]["options"].update(refine_at=[0.2]),
        r"refine_at: expected 2 values, got \[0\.2\]",
    ),
    "no steps": (lambda a: a["meta"]["options"].update(steps=0), "steps: expected a whole number"),
    "part of a degree": (
        lambda a: a["meta"]["options"].update(degree=1.5),
        "degree: expected a whole number, got 1.5",
    ),
    "NaN": (lambda a: a["params.density"].fill(np.nan), "params.density: expected finite values"),
    "infinite harmonics": (lambda a: a["params.sh"].fill(np.inf), "params.sh: expected finite"),
    "moments of others": (
        lambda a: a.update({"optimizer.mean/sh": a["optimizer.mean/sh"][1:]}),
        "optimizer.mean/sh: expected shape",
    ),
    "negative squares": (
        lambda a: a["optimizer.mean_square/sh"].fill(-1),
        "optimizer.mean_square/sh: expected 0 or more, got -1.0",
    ),
    "other degree": (
        lambda a: a.update({"params.sh": a["params.sh"][:, :1]}),
        r"params.sh: expected shape \(N = 336, 4, 3\)",
    ),
    "a mask of others": (
        lambda a: a["state.shape"].fill(2**20),
        "state.shape: expected voxels of which 42 bytes are the mask",
    ),
    "steps to come": (lambda a: a["history"][-1].fill(7), "history: expected rising steps below 2"),
    "a step of a microsecond": (
        lambda a: a["meta"]["policy"].update(dt=1e-300),
        "MarchPolicy: dt: expected",
    ),
}


@pytest.mark.parametrize("saved", ["dense_sh"], indirect=True)
@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named(saved: Arrays, tmp_path: Path, name: str) -> None:
    change, words = WRONG[name]
    arrays = copy.deepcopy(saved)
    change(arrays)
    write(tmp_path, arrays)
    with pytest.raises(IoError, match=rf"load_model: .*a checkpoint of a fit, got .*{words}"):
        load_model(tmp_path)


@pytest.mark.parametrize("saved", ["octree_sh"], indirect=True)
def test_a_tree_with_a_hole_is_refused_before_it_is_built(saved: Arrays, tmp_path: Path) -> None:
    # A root of 2^20 cells a side: to look for what fills it would take for ever.
    leaves = {"lower": np.full((1, 3), 2**20 - 1), "side": np.ones(1), "row": np.zeros(1)}
    changed = {f"state.{name}": value.astype(np.int32) for name, value in leaves.items()}
    rows = {name: x[:1] for name, x in saved.items() if name.startswith(("params.d", "params.s"))}
    rest = {name: x for name, x in saved.items() if not name.startswith("optimizer.")}
    write(tmp_path, rest | rows | changed)
    with pytest.raises(IoError, match="side: expected 1 cubes that fill one of 1048576"):
        load_model(tmp_path)


def test_options_say_what_they_are() -> None:
    wrong: Any = {"resolution": 8.5}
    with pytest.raises(DtypeError, match="FitOptions: resolution: expected a whole number, got 8"):
        FitOptions(**wrong)
    for options in ({"stop": 1.0}, {"seed": -1}, {"rays": 2**31}, {"sigma_t": float("inf")}):
        with pytest.raises(RangeError, match=f"FitOptions: {next(iter(options))}: expected"):
            FitOptions(**options)
