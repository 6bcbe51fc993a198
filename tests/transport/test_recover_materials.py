"""What the caption of docs/images/recover_materials.png says, on a globe."""

from __future__ import annotations

import sys

import numpy as np

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import recover_materials as materials


def test_the_first_gradient_draws_the_texture() -> None:
    g = np.random.default_rng(1)
    texels = g.choice([0.1, 0.8], (8, 8, 1)).repeat(3, axis=2).astype(np.float32)
    shape = materials.globe_mesh(12)
    cameras = materials.orbit_cameras(shape.box, 3, size=20, elevation=15.0)[:1]
    case = materials.painted(shape, "gltf", texels, cameras, metalness=1.0, roughness=0.45)
    gradient = materials.first_gradient(case, materials.targets_of(case, 64))
    seen = materials.seen_texels(case)
    assert 0.2 < seen.mean() < 0.9
    wanted = 0.4 - texels.mean(axis=2)  # positive where there is too much
    right = np.abs(gradient[seen])[np.sign(gradient[seen]) == np.sign(wanted[seen])].sum()
    assert right > 0.75 * np.abs(gradient[seen]).sum()  # 0.83; metalness is wrong, too
    # One camera does not see the other side: derivatives there are exactly zero.
    assert (gradient[~seen] == 0).any()
