"""Sliders of a scene in `photograd view`, and what a click on one hits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.commands.view_drawing import reduced, viewed_scene
from photograd.commands.view_scene import SceneParameters, add_controls, controls, pick_in_scene
from photograd.transport.builtin import builtin_scene
from photograd.transport.material import Material
from photograd.transport.scene import Environment, Scene
from photograd.transport.shapes import SphereShape
from photograd.transport.tracer import PathTracer
from photograd_course.color import srgb_encode

pytestmark = pytest.mark.usefixtures("core")


def room() -> PathTracer:
    return PathTracer(builtin_scene("cornell-box", 32))


def ball() -> PathTracer:
    camera = replace(builtin_scene("cornell-box", 32).camera)
    at = camera.position + 2 * camera.forward
    material = Material(
        "principled", {"base_color": (0.6, 0.2, 0.1), "metalness": 0.0, "roughness": 0.4}
    )
    scene = Scene(
        "ball",
        (SphereShape("ball", at, 0.2, "skin"),),
        {"skin": material},
        camera,
        Environment.constant(1.0),
    )
    return PathTracer(scene)


def test_materials_have_colors_and_numbers_lights_have_stops() -> None:
    found = {control.name: control for control in controls(room())}
    assert found["materials.red.albedo"].kind == "color"
    light = next(control for name, control in found.items() if name.startswith("emission."))
    assert (light.kind, light.low, light.high) == ("stops", -4.0, 4.0)
    found = {control.name: control for control in controls(ball())}
    roughness = found["materials.skin.roughness"]
    assert (roughness.kind, roughness.group, roughness.label) == ("number", "skin", "roughness")
    assert 0 <= roughness.low < roughness.high <= 1
    assert found["environment"].kind == "stops"


def test_a_change_is_that_of_the_parameter_and_can_be_undone() -> None:
    tracer = ball()
    before = {name: value.copy() for name, value in tracer.params.items()}
    parameters = SceneParameters(tracer)
    found = {control.name: control for control in controls(tracer)}
    color = found["materials.skin.base_color"]
    assert parameters.shown(color) == tuple(
        np.rint(255 * srgb_encode(np.array([0.6, 0.2, 0.1]))).astype(int).tolist()
    )
    held = tracer.params
    parameters.change(color, (255, 0, 0))
    np.testing.assert_allclose(tracer.params["materials.skin.base_color"], [1, 0, 0], atol=1e-6)
    np.testing.assert_array_equal(held["materials.skin.base_color"], before[color.name])
    parameters.change(found["materials.skin.roughness"], 0.9)
    assert tracer.params["materials.skin.roughness"] == pytest.approx(0.9)
    parameters.change(found["environment"], 2.0)
    np.testing.assert_allclose(tracer.params["environment"], 4.0)
    parameters.change(found["environment"], -1.0)
    np.testing.assert_allclose(tracer.params["environment"], 0.5)
    parameters.reset()
    for name, value in before.items():
        np.testing.assert_array_equal(tracer.params[name], value)


def test_a_brighter_light_brightens_the_next_picture() -> None:
    viewed = viewed_scene("cornell-box", spp=4, max_depth=4)
    assert viewed.tracer is not None
    assert viewed.start is not None
    camera = reduced(viewed.start, 32)
    parameters = SceneParameters(viewed.tracer)
    light = next(c for c in controls(viewed.tracer) if c.kind == "stops")

    def last() -> Any:
        return [picture for picture in viewed.draw(camera) if picture is not None][-1].color

    dark = last()
    parameters.change(light, 2.0)
    assert last().mean() > dark.mean() + 0.1
    parameters.change(light, 0.0)
    np.testing.assert_array_equal(last(), dark)


def test_a_click_finds_shape_material_and_triangle() -> None:
    tracer = room()
    camera = tracer.scene.camera
    origins, directions = camera.rays()
    titles = set()
    for row, column in ((16, 2), (16, 29), (30, 16), (22, 11)):
        found = pick_in_scene(tracer, camera, (column + 0.5, row + 0.5))
        assert found is not None
        titles.add(found.facts["material"])
        number = row * camera.width + column
        away = found.position - origins[number]
        np.testing.assert_allclose(
            np.cross(away, directions[number]), 0, atol=1e-4 * np.linalg.norm(away)
        )
        assert found.title.startswith("Triangle ")
        assert len(found.lines) == 3
    assert {"red", "green"} <= titles
    assert "photographs" in found.facts["gradient"]


def test_a_click_on_a_sphere_and_on_nothing() -> None:
    tracer = ball()
    camera = tracer.scene.camera
    middle = (0.5 * camera.width, 0.5 * camera.height)
    found = pick_in_scene(tracer, camera, middle)
    assert found is not None
    assert found.title == "Sphere ball"
    assert np.linalg.norm(found.position - camera.position) == pytest.approx(1.8, abs=0.01)
    assert found.facts["roughness"] == "0.4"
    assert pick_in_scene(tracer, camera, (0.5, 0.5)) is None


class Handle:
    """A slider of viser, as far as it is used: setting its value tells the callbacks."""

    def __init__(self, value: Any) -> None:
        self.held, self.calls = value, list[Any]()

    def on_update(self, call: Any) -> Any:
        self.calls.append(call)
        return call

    on_click = on_update

    @property
    def value(self) -> Any:
        return self.held

    @value.setter
    def value(self, value: Any) -> None:
        self.held = value
        for call in self.calls:
            call(None)


class Gui:
    """Remembers handles."""

    def __init__(self) -> None:
        self.handles: dict[str, Handle] = {}

    def add_folder(self, _: str, **__: Any) -> Gui:
        return self

    def __enter__(self) -> None:
        return None

    def __exit__(self, *_: object) -> None:
        return None

    def add_rgb(self, _: str, value: Any, *, hint: str) -> Handle:
        return self.handles.setdefault(hint, Handle(value))

    def add_slider(self, _: str, *, initial_value: Any, hint: str, **__: Any) -> Handle:
        return self.handles.setdefault(hint, Handle(initial_value))

    def add_button(self, label: str) -> Handle:
        return self.handles.setdefault(label, Handle(None))


def test_sliders_change_the_scene_and_the_button_undoes_all() -> None:
    tracer, gui, changes = ball(), Gui(), list[int]()
    add_controls(gui, SceneParameters(tracer), lambda: changes.append(1))
    gui.handles["materials.skin.roughness"].value = 0.7
    assert tracer.params["materials.skin.roughness"] == pytest.approx(0.7)
    assert changes == [1]
    gui.handles["Reset parameters"].value = None
    assert tracer.params["materials.skin.roughness"] == pytest.approx(0.4)
    assert gui.handles["materials.skin.roughness"].value == pytest.approx(0.4)
