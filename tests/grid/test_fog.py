"""Densities as glowing fog: the transfer function, the frame, the command."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.fitting.fog import GRAY, THICK, fog_model
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import write_vdb
from photograd.representation import RayBatch, RenderOptions
from photograd_course.cli import run
from PIL import Image

VOXEL = np.diag([0.25, 0.25, 0.25, 1.0])


def block() -> SparseGrid:
    """A homogeneous block of 16 x 8 x 8 voxels, 4 x 2 x 2 m, of value 0.5."""
    return SparseGrid.from_dense(
        np.full((16, 8, 8), 0.5, np.float32), origin=(0, 0, 0), world_from_index=VOXEL
    )


@pytest.mark.parametrize("sigma_t", [None, 0.7])
def test_a_ray_through_a_homogeneous_block_obeys_beer(sigma_t: float | None) -> None:
    model = fog_model(block(), sigma_t=sigma_t)
    np.testing.assert_allclose(model.field.box, [(-0.125,) * 3, (3.875, 1.875, 1.875)])
    batch = RayBatch(np.array([[-5, 1, 1.0]]), np.array([[1.0, 0, 0]]), np.zeros(1, np.uint32))
    outputs, _ = model.field.render(batch, seed=0, step=0, options=RenderOptions())
    assert outputs.opacity is not None
    opacity = 1 - np.exp(-(THICK if sigma_t is None else 0.5 * sigma_t * 4))
    np.testing.assert_allclose(outputs.opacity, opacity, atol=1e-5)
    np.testing.assert_allclose(outputs.color[0], GRAY * outputs.opacity[0], atol=1e-6)


def test_resolution_limits_the_field_and_keeps_the_box() -> None:
    coarse = fog_model(block(), resolution=8)
    assert coarse.field.params["values"].shape == (8, 4, 4, 4)
    np.testing.assert_allclose(coarse.field.box, fog_model(block()).field.box)


def test_a_turned_grid_is_resampled_in_the_world() -> None:
    turned = block()
    turned.world_from_index = VOXEL @ np.array(
        [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]
    )
    model = fog_model(turned)
    assert model.field.params["values"].shape == (8, 16, 8, 4)
    np.testing.assert_allclose(model.field.params["values"][..., 3], 0.5, atol=1e-6)


def test_ramps_color_by_the_share_of_the_highest_value() -> None:
    values = np.linspace(0.01, 1, 4, dtype=np.float32).reshape(4, 1, 1).repeat(2, 1).repeat(2, 2)
    model = fog_model(SparseGrid.from_dense(values), ramp="inferno")
    red = model.field.color[:, 0, 0, 0]
    assert (np.diff(red) > 0).all()
    assert red[-1] == pytest.approx(0.974, abs=1e-2)  # pale yellow is the end of the map


def test_bad_input_is_refused() -> None:
    with pytest.raises(RangeError, match="one of white, inferno"):
        fog_model(block(), ramp="rainbow")
    with pytest.raises(RangeError, match=r"above zero somewhere, got -1\.0"):
        fog_model(SparseGrid.from_dense(np.full((2, 2, 2), -1, np.float32)))


def test_the_command_draws_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_vdb(tmp_path / "block.vdb", [block()])
    words = ["--out", str(tmp_path / "frames"), "--frames", "2", "--size", "24", "--json"]
    assert run(["render", str(tmp_path / "block.vdb"), *words]) == 0
    assert json.loads(capsys.readouterr().out.splitlines()[-1])["frames"] == 2
    picture = np.asarray(Image.open(tmp_path / "frames" / "frame_0000.png").convert("L"))
    assert picture[12, 12] > 200
    assert picture[0, 0] < 20
