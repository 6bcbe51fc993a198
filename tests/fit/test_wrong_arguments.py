"""Wrong arguments of the functions at the door are refused in one sentence that says what to do."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import photograd
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.fields import DenseGrid
from photograd.fitting import Fit, FitOptions, density_gradient, options_for
from photograd.fitting.drawing import render_field
from photograd.representation import REGISTERED, Outputs, Representation, register

from tests.fit import scene


def model() -> photograd.Model:
    return scene.as_model(scene.truth())


def room() -> photograd.Scene:
    return photograd.builtin_scene("cornell-box", 4)


def tracer() -> photograd.PathTracer:
    return photograd.PathTracer(room())


def camera() -> photograd.Camera:
    return scene.capture().test[0].camera


CALLS: dict[str, tuple[Callable[[], Any], type[Error], str]] = {
    "capture for views": (
        lambda: photograd.evaluate(model(), scene.capture()),  # type: ignore[arg-type]
        DtypeError,
        r"^evaluate: views: expected a sequence of Views, got Capture \(such as capture.test\)",
    ),
    "swapped": (
        lambda: photograd.evaluate(scene.capture().test, model()),  # type: ignore[arg-type]
        DtypeError,
        r"^evaluate: model: expected a Model, got tuple",
    ),
    "view for a camera": (
        lambda: photograd.render(model(), scene.capture().test[0]),  # type: ignore[call-overload]
        DtypeError,
        r"^render: camera: expected a Camera, got View \(pass its .camera\)",
    ),
    "samples of a model": (
        lambda: photograd.render(model(), camera(), spp=4),  # type: ignore[call-overload]
        RangeError,
        r"^render: spp: expected nothing with a Model.*, got 4 \(leave it out\)",
    ),
    "path of a scene": (
        lambda: photograd.PathTracer("room.toml"),  # type: ignore[arg-type]
        DtypeError,
        r"^PathTracer: scene: expected a Scene, got str \(read_scene",
    ),
    "model file for a scene": (
        lambda: photograd.PathTracer(3),  # type: ignore[arg-type]
        DtypeError,
        r"^PathTracer: scene: .*default_scene makes one of what read_model reads",
    ),
    "view for the tracer's camera": (
        lambda: tracer().render(spp=1, seed=0, camera=scene.capture().test[0]),  # type: ignore[arg-type]
        DtypeError,
        r"^PathTracer.render: camera: expected a Camera, got View \(pass its .camera\)",
    ),
    "options as a dictionary": (
        lambda: tracer().render(spp=1, seed=0, options={}),  # type: ignore[arg-type]
        DtypeError,
        r"^PathTracer.render: options: expected a PathOptions, got dict",
    ),
    "half a sample": (
        lambda: photograd.render(room(), spp=1.5),  # type: ignore[call-overload]
        DtypeError,
        r"spp: expected a whole number, got 1.5",
    ),
    "negative seed": (
        lambda: photograd.render(room(), spp=1, seed=-1),
        RangeError,
        r"^PathTracer: seed: expected a whole number in .*2.64 - 1., got -1",
    ),
    "half a sample of a gradient": (
        lambda: tracer().render_backward(np.zeros((4, 4, 3)), spp=0.5, seed=0),  # type: ignore[arg-type]
        DtypeError,
        r"^PathTracer.render_backward: spp: expected a whole number, got 0.5",
    ),
    "path of a scene to recover": (
        lambda: photograd.recover("room.toml", np.zeros((4, 4, 3)), ["x"]),  # type: ignore[arg-type]
        DtypeError,
        r"^recover: scene: expected a Scene, got str \(read_scene reads a file\)",
    ),
    "one name": (
        lambda: photograd.recover(room(), np.zeros((4, 4, 3)), "materials.red.albedo"),
        DtypeError,
        r"^recover: parameters: expected a sequence, got 'materials.*' \(put it into a list\)",
    ),
    "options of recover": (
        lambda: photograd.recover(
            room(),
            np.zeros((4, 4, 3)),
            ["materials.red.albedo"],
            options={"steps": 3},  # type: ignore[arg-type]
        ),
        DtypeError,
        r"^recover: options: expected a RecoveryOptions, got dict",
    ),
    "a number for a path": (
        lambda: photograd.load_capture(3),  # type: ignore[arg-type]
        DtypeError,
        r"^load_capture: path: expected a path, got int",
    ),
    "a number for a model's path": (
        lambda: photograd.load_model(3),  # type: ignore[arg-type]
        DtypeError,
        r"^load_model: path: expected a path, got int",
    ),
    "model for a capture": (
        lambda: photograd.fit(model()),  # type: ignore[arg-type]
        DtypeError,
        r"^fit: capture: expected a Capture or its path, got Model",
    ),
    "bounds of a path": (
        lambda: photograd.estimate_bounds("photos"),  # type: ignore[arg-type]
        DtypeError,
        r"^estimate_bounds: capture: expected a Capture, got str",
    ),
    "class for a name": (
        lambda: photograd.fit("photos", DenseGrid),  # type: ignore[arg-type]
        RangeError,
        r"^Fit: representation: expected one that a capture can start",
    ),
    "size as a text": (
        lambda: photograd.builtin_scene("cornell-box", "8"),  # type: ignore[arg-type]
        DtypeError,
        r"^builtin_scene: size: expected a whole number, got ",
    ),
    "misspelled option": (
        lambda: photograd.fit("photos", step=20),
        DtypeError,
        r"^fit: step: expected an option of FitOptions.* \(did you mean 'steps'\?\)",
    ),
    "unknown representation": (
        lambda: photograd.fit("photos", "sky", steps=3),
        RangeError,
        r"^Fit: representation: expected .*'dense_grid'.*'textured_surface', got 'sky'$",
    ),
    "path of a capture": (
        lambda: Fit.start("photos", FitOptions()),  # type: ignore[arg-type]
        DtypeError,
        r"^Fit.start: capture: expected a Capture, got str \(load_capture reads one\)",
    ),
    "path of a model": (
        lambda: photograd.fit("photos", "octree_sh", start_from="model"),  # type: ignore[arg-type]
        DtypeError,
        r"^fit: start_from: expected a Model, got str \(load_model reads one\)",
    ),
    "name for a model": (
        lambda: density_gradient("model", scene.capture(), seed=0),  # type: ignore[arg-type]
        DtypeError,
        r"^density_gradient: model: expected a model of voxels, such as dense_grid, got str",
    ),
    "views for a capture": (
        lambda: density_gradient(scene.truth(), scene.capture().train, seed=0),  # type: ignore[arg-type]
        DtypeError,
        r"^density_gradient: capture: expected a Capture, got tuple",
    ),
    "group": (
        lambda: Fit.start(scene.capture(), scene.options()).mean_gradient("density", 8),
        RangeError,
        r"^Fit.mean_gradient: group: expected .*, got 'density' \(choose from values\)",
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_what_is_refused(name: str) -> None:
    call, error, words = CALLS[name]
    with pytest.raises(error, match=words):
        call()


@pytest.fixture
def sky() -> Iterator[type[Representation]]:
    class Sky(Representation):
        name, capabilities = "sky", frozenset({"rays"})
        example = example_batch = param_groups = render = render_backward = print  # type: ignore[assignment]

    yield register(Sky)
    del REGISTERED["sky"]


@pytest.mark.usefixtures("sky")
def test_a_registered_class_that_cannot_be_fitted_is_told_what_to_become() -> None:
    with pytest.raises(RangeError, match=r"representation: .*got 'sky' \(derive .* Fittable"):
        photograd.fit("photos", "sky", steps=3)


@pytest.mark.parametrize("lacking", ["opacity", "depth"])
def test_a_rendering_without_opacity_or_depth_is_not_drawn(lacking: str) -> None:
    class Half(DenseGrid):
        def render(self, batch: Any, **named: Any) -> Any:
            whole, context = super().render(batch, **named)
            return Outputs(**{**vars(whole), lacking: None}), context

    with pytest.raises(ShapeError, match=rf"^dense_grid.render: {lacking}: .* got None \(return"):
        render_field(Half(np.ones((4, 4, 4, 4)), scene.truth().policy), camera(), 0.0)


def test_fit_lists_its_options_once() -> None:
    text, described = (inspect.getdoc(thing) or "" for thing in (photograd.fit, FitOptions))
    names = [field.name for field in fields(FitOptions) if field.name != "representation"]
    assert all(text.count(f"\n    {name} (") == 1 for name in names)
    assert "\n    resolution (int, default 128): voxels along the longest edge" in text
    long = "transmittance below which a ray ends; the discarded light is below this fraction."
    assert long in described
    assert long in text
    assert text.index("\n\nReturns:") > text.index("\n    ssim_weight")


def test_a_fit_runs_in_a_folder_named_by_a_text(tmp_path: Path) -> None:
    Fit.start(scene.capture(), scene.options(steps=1)).run(str(tmp_path / "model"))
    assert photograd.load_model(tmp_path / "model").history.shape == (1, 3)


def test_an_option_that_is_none_keeps_its_default() -> None:
    assert options_for("gaussians", steps=None) == options_for("gaussians")
