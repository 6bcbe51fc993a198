"""The jobs that the door of photograd offers: `fit` in one call, and `render` of its result."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import photograd
import pytest
from photograd.errors import DtypeError, RangeError
from photograd.fitting.evaluate import display_image
from photograd_course.color import srgb_encode

from tests.fit import scene

OPTIONS = {"resolution": 16, "steps": 12, "rays": 64, "seed": 3}


def params(model: photograd.Model) -> dict[str, bytes]:
    return {name: values.tobytes() for name, values in model.field.params.items()}


def test_one_call_is_the_loop_bit_for_bit(tmp_path: Path) -> None:
    job = photograd.Fit.start(scene.capture(), photograd.FitOptions(**OPTIONS))
    job.run(tmp_path / "loop")
    model = photograd.fit(scene.capture(), **OPTIONS)
    assert params(model) == params(photograd.load_model(tmp_path / "loop"))
    assert model.history.shape == (12, 3)
    scene.write(tmp_path / "photos")
    kept = photograd.fit(tmp_path / "photos", folder=tmp_path / "kept", **OPTIONS)
    read = photograd.fit(photograd.load_capture(tmp_path / "photos"), **OPTIONS)
    assert params(kept) == params(read) == params(photograd.load_model(tmp_path / "kept"))


def test_a_stopped_fit_is_resumed(tmp_path: Path) -> None:
    job = photograd.Fit.start(scene.capture(), photograd.FitOptions(**OPTIONS))
    job.run(tmp_path, should_stop=lambda: job.step_number >= 5)
    model = photograd.fit(scene.capture(), folder=tmp_path, resume=True)
    assert params(model) == params(photograd.fit(scene.capture(), **OPTIONS))


@pytest.mark.parametrize(
    ("given", "argument"),
    [
        ({"resume": True}, "resume"),
        ({"representation": "tensor_train"}, "representation"),
        ({"prune": 0.1}, "prune"),
        ({"steps": 0}, "steps"),
        ({"folder": "full"}, "folder"),
        ({"folder": "full", "resume": True, "steps": 20}, "options"),
    ],
)
def test_what_fit_refuses(given: dict[str, Any], argument: str, tmp_path: Path) -> None:
    if "folder" in given:
        given = {**given, "folder": tmp_path}
        photograd.fit(scene.capture(), folder=tmp_path, resolution=8, steps=1, rays=8)
    with pytest.raises(RangeError, match=rf"^\w+: {argument}: expected "):
        photograd.fit(scene.capture(), **given)


def test_a_model_is_rendered_as_it_is_evaluated() -> None:
    view = scene.capture().test[0]
    model = photograd.fit(scene.capture(), **OPTIONS)
    picture = photograd.render(model, view.camera)
    assert np.array_equal(picture, display_image(model, view.camera))
    assert picture.std() > 0.01
    with pytest.raises(RangeError, match=r"^render: camera: expected a camera"):
        photograd.render(model)  # type: ignore[call-overload]


def test_a_scene_is_traced() -> None:
    room = photograd.builtin_scene("cornell-box", 16)
    picture = photograd.render(room, spp=4, seed=1)
    tracer = photograd.PathTracer(room)
    expected = srgb_encode(np.clip(tracer.render(spp=4, seed=1).mean, 0, 1))
    assert np.array_equal(picture, expected)
    tracer.params["materials.red.albedo"][:] = 0.1
    assert not np.array_equal(photograd.render(tracer, spp=4, seed=1), picture)
    with pytest.raises(DtypeError, match=r"^render: what: expected a Model, a Scene or"):
        photograd.render("cornell-box")  # type: ignore[call-overload]


def test_files_may_be_named_by_texts(tmp_path: Path) -> None:
    file = tmp_path / "white.png"
    photograd.images.write_png(file, np.ones((2, 3, 4), np.float32))
    assert photograd.read_image(str(file)).shape == (2, 3, 4)
    for read, name in ((photograd.read_scene, "a.toml"), (photograd.read_model, "a.obj")):
        with pytest.raises(photograd.Error, match=rf"^{read.__name__}: .*{name}"):
            read(str(tmp_path / name))
