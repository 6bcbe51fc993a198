"""Digests of short fits of every representation, for tests that compare processes.

`python -m tests.fit.all_fits CAPTURE` prints them.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from photograd._fit_options import DENSITY_CONTROLS
from photograd.capture import Capture, load_capture
from photograd.fields import TexturedMesh, fittable
from photograd.fitting import options_for
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model

from tests.fit.mesh_scene import cube

# Few steps, but with every event: levels, pruning, clones, splits, motion of faint Gaussians.
JOBS: dict[str, dict[str, Any]] = {
    "dense_grid": {"resolution": 16, "rays": 256, "steps": 20},
    "dense_sh": {"resolution": 12, "rays": 128, "steps": 8, "degree": 1},
    "sparse_sh": {"resolution": 16, "rays": 256, "steps": 20},
    "octree_sh": {"rays": 64, "steps": 5, "degree": 1},
    # Dense enough to leave leaves; looks at its cells twice.
    "hash_grid": {"resolution": 32, "rays": 16, "steps": 18, "sigma_t": 2.0},
    "nerf": {"resolution": 16, "rays": 16, "steps": 18},
    "plenoctree": {"resolution": 16, "rays": 64, "steps": 5, "degree": 1, "prune": 0.0},
    "leaf_codes": {"rays": 32, "steps": 4},
    "leaf_mlps": {"resolution": 16, "rays": 32, "steps": 4},
    "gaussians": {"gaussians": 200, "steps": 12},
    "gaussian_codes": {"steps": 4},
    "textured_mesh": {"resolution": 16, "rays": 64, "steps": 8},
    "mesh": {"resolution": 8, "steps": 8},
    "textured_surface": {"resolution": 16, "steps": 6, "opacity": True, "laplacian": 0.1},
}


STARTS_FROM = {
    "sparse_sh": ("octree_sh", "leaf_codes"),
    "hash_grid": ("plenoctree", "leaf_mlps"),
    "gaussians": ("gaussian_codes",),
}


def digest(arrays: Mapping[str, Any]) -> str:
    total = hashlib.blake2b(digest_size=8)
    for name in sorted(arrays):
        total.update(name.encode() + np.ascontiguousarray(arrays[name]).tobytes())
    return total.hexdigest()


def fits(capture: Capture) -> Iterator[tuple[str, Callable[[], Fit]]]:
    """A name, and what begins a short fit, of each kind with each density control it has."""
    assert set(JOBS) == set(fittable())
    first = {"textured_mesh": Model.of(TexturedMesh.of_mesh(cube()))}
    for name, changes in JOBS.items():
        for control in DENSITY_CONTROLS if name == "gaussians" else ("mcmc",):
            options = options_for(
                name, seed=1, background="learned", density_control=control, **changes
            )
            begin = partial(Fit.start, capture, options, start_from=first.get(name))
            yield f"{name}, {control}", begin
            if name in STARTS_FROM:
                field = stepped(begin()).model
                model = Model(field, None, options, {}, np.zeros((0, 3)))
                first |= dict.fromkeys(STARTS_FROM[name], model)


def stepped(fit: Fit) -> Fit:
    """The fit at its end."""
    while fit.step_number < fit.steps:
        fit.step()
    return fit


def digests(folder: Path) -> dict[str, str]:
    """Of everything that a checkpoint holds after a fit of each kind, background learned."""
    x = np.linspace(0.1, 3.0, 999, dtype=np.float32)
    found = {"of the processor": digest({"exp": np.exp(x)})}
    for name, begin in fits(load_capture(folder)):
        fit = stepped(begin())
        parts = fit.model.params, fit.model.state(), fit.optimizer.state()
        arrays = {f"{k}/{key}": a for k, part in enumerate(parts) for key, a in part.items()}
        rest = {"background": fit.background, "history": np.array(fit.history)}
        found[name] = digest(arrays | rest)
    return found


if __name__ == "__main__":
    json.dump(digests(Path(sys.argv[1])), sys.stdout)
