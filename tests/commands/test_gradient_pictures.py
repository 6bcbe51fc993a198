"""`photograd gradients` draws every representation with voxels or leaves that a fit can make."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.fitting.model import load_snapshots
from photograd.images.read import read_image

from tests.commands.conftest import Photograd

FIT = ("--steps", 40, "--rays", 256, "--degree", 1, "--seed", 1)
SIZE = ("--resolution", 16)
PICTURES = {"gradient_slices", "gradient_projections", "gradient_steps", "curves"}
MISSING = (207, 211, 215)


def share_of(picture: Path, name: str) -> float:
    """Share of the picture's pixels that are clearly blue, clearly red, or the gray of nothing."""
    red, _, blue = (pixels := 255 * read_image(picture)[..., :3]).transpose(2, 0, 1)
    found = {
        "blue": blue > red + 40,
        "red": red > blue + 40,
        "gray": (np.abs(pixels - MISSING) < 1).all(axis=2),
    }
    return float(found[name].mean())


@pytest.mark.parametrize("name", ["dense_sh", "sparse_sh", "octree_sh"])
def test_the_gradient_of_each_fit_is_drawn(
    photograd: Photograd, capture_folder: Path, tmp_path: Path, name: str
) -> None:
    words = ("--representation", name, *FIT)
    if name == "octree_sh":
        first = ("--representation", "sparse_sh", *FIT, *SIZE)
        assert photograd("fit", capture_folder, "--out", tmp_path / "first", *first).code == 0
        words += ("--start-from", tmp_path / "first")
    else:
        words += SIZE
    model, out = tmp_path / "model", tmp_path / "pictures"
    assert photograd("fit", capture_folder, "--out", model, *words).code == 0
    done = photograd("gradients", model, capture_folder, "--rays", 4096, "--out", out, "--json")
    assert done.code == 0, done.err
    assert done.result()["steps"] == [0, 1, 4, 12, 40]
    assert {path.stem for path in out.iterdir()} == PICTURES
    steps = out / "gradient_steps.png"
    # An octree begins with matter, which is what the start of a grid asks for.
    assert share_of(steps, "red" if name == "octree_sh" else "blue") > 0.03
    missing = not all(field.active_voxels.all() for field in load_snapshots(model).values())
    assert missing == (name != "dense_sh")
    assert (share_of(steps, "gray") > 0.003) == missing
    assert ("the fit began with the matter of another model" in done.err) == (name == "octree_sh")
