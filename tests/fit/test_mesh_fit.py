"""The texture of a mesh recovered from photographs, drawn, compared, its gradient drawn."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._fit_options import FitOptions
from photograd.commands.gradients import draw_gradients
from photograd.errors import IoError, RangeError
from photograd.fields import TexturedMesh
from photograd.fields.textured_mesh import MeshPolicy
from photograd.fitting import Fit, fit, load_model, options_for
from photograd.fitting.compare import compare_one, parse_candidates, source_of
from photograd.fitting.evaluate import evaluate
from photograd.fitting.model import Model

from tests.fit import scene
from tests.fit.mesh_scene import capture, cube, truth
from tests.fit.test_resume import assert_same, run

CHANGES: dict[str, Any] = {"resolution": 24, "steps": 60, "rays": 512, "seed": 1}


def first() -> Model:
    return Model.of(TexturedMesh.of_mesh(cube()))


def start(**changes: Any) -> Fit:
    options = options_for("textured_mesh", **{**CHANGES, **changes})
    return Fit.start(capture(), options, start_from=first())


def test_the_texture_comes_back(tmp_path: Path) -> None:
    model = fit(capture(), "textured_mesh", folder=tmp_path, start_from=first(), **CHANGES)
    # Measured: 20.8 dB gray, 43.0 dB fitted.
    assert evaluate(first(), capture().test).psnr < 22
    assert evaluate(model, capture().test).psnr > 39
    field: Any = model.field
    assert np.array_equal(field.mesh.vertices, cube().vertices)
    seen = np.abs(field.params["texels"]).max(axis=2) > 0.5
    error = np.abs(field.colors() - truth().field.colors())[seen]  # type: ignore[attr-defined]
    assert np.median(error) < 0.05  # views are coarser than texels
    assert field.policy.pixel_angle == pytest.approx(1 / capture().train[0].camera.fx)


def test_a_stopped_fit_ends_with_the_same_bits(tmp_path: Path) -> None:
    few = {"steps": 12, "rays": 64}
    run(start(**few), tmp_path / "straight")
    run(start(**few), tmp_path / "stopped", until=5)
    run(Fit.resume(capture(), tmp_path / "stopped"), tmp_path / "stopped")
    assert_same(tmp_path / "straight", tmp_path / "stopped")
    with np.load(tmp_path / "straight" / "model.npz") as archive:
        arrays = {name: archive[name] for name in archive.files}
    arrays["state.uv"] = arrays["state.uv"] + 1
    np.savez(tmp_path / "straight" / "model.npz", **arrays)
    with pytest.raises(IoError, match=r"TexturedMesh: mesh.uv: expected texture coordinates in"):
        load_model(tmp_path / "straight")


def test_a_fitted_texture_is_the_start_of_a_finer_one() -> None:
    texels = np.random.default_rng(4).normal(size=(16, 16, 3)).astype(np.float32)
    before = Model.of(TexturedMesh(texels, cube(), MeshPolicy(0.1)))
    options = options_for("textured_mesh", **{**CHANGES, "resolution": 16})
    same = Fit.start(capture(), options, start_from=before).model
    np.testing.assert_allclose(same.params["texels"], texels, atol=1e-6)
    finer = start(resolution=32).model
    assert finer.shape == (32, 32, 3)
    assert finer.resolution == 32


def test_its_mesh_has_to_come_from_somewhere() -> None:
    options = options_for("textured_mesh", **CHANGES)
    with pytest.raises(RangeError, match=r"starts from, got none \(its mesh comes from a file"):
        Fit.start(capture(), options)
    with pytest.raises(RangeError, match="a model of textured_mesh, got 'dense_grid'"):
        Fit.start(capture(), options, start_from=scene.as_model(scene.truth()))


def test_gaussians_begin_on_the_surface_of_a_mesh() -> None:
    job = Fit.start(capture(), options_for("gaussians", gaussians=60, steps=4), start_from=truth())
    means = job.model.params["means"]
    np.testing.assert_allclose(np.abs(means).max(axis=1), 0.4, atol=1e-3)


def test_it_is_compared_and_its_gradient_drawn(tmp_path: Path) -> None:
    listed = parse_candidates("dense_grid:8,textured_mesh:24", gray := first())
    assert [source_of(candidate, listed, gray) for candidate in listed] == [None, gray]
    with pytest.raises(RangeError, match=r"textured_mesh:24 starts from .*with 24 \(its mesh"):
        parse_candidates("dense_grid:24,textured_mesh:24")
    with pytest.raises(RangeError, match="a candidate that starts from a textured_mesh"):
        parse_candidates("dense_grid:24", gray)
    options = listed[1].options(FitOptions(steps=6, rays=128))
    folder = tmp_path / "mesh"
    result = compare_one(
        "memory", capture(), listed[1], folder, options, lambda f, out: f.run(out), source=gray
    )
    assert result is not None
    assert result[0].parameter_bytes == 4 * 3 * 24**2 + sum(
        array.nbytes
        for array in (cube().vertices, cube().faces, cube().uv)  # type: ignore[union-attr]
    )
    found = draw_gradients(load_model(folder), folder, capture(), tmp_path / "pictures", 256, 1)
    assert found["steps"] == [0, 1, 6]
    assert found["group_gradients"].stat().st_size > 10_000


def test_its_gradient_is_drawn_on_the_texture() -> None:
    gradient = np.arange(4 * 4 * 3, dtype=np.float64).reshape(4, 4, 3)
    shown = TexturedMesh.of_mesh(cube()).gradient_image({"texels": gradient})
    np.testing.assert_allclose(shown, gradient.mean(axis=2))


def test_a_texture_larger_than_the_memory_is_refused() -> None:
    options = options_for("textured_mesh", resolution=1000)
    (part,) = TexturedMesh.memory(scene.BOX, options, 10**6)
    assert part.option == "resolution"
    assert part.size > 4 * 4 * 3 * 1000**2
