"""Signed distance functions in scene files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.geometry import Body
from photograd.geometry.sdf import (
    box,
    capsule,
    difference,
    placed,
    rounded,
    rounded_box,
    scaled,
    smooth_union,
    sphere,
    torus,
    union,
)
from photograd.transport import BOUNDARY, PathTracer, SdfShape, read_scene
from photograd.transport.sdf_nodes import quaternion_of

TEXT = """\
[camera]
position = [0, 1, 4]
look_at = [0, 0.5, 0]
field_of_view = 40
size = [8, 6]
[environment]
radiance = 1
[materials.clay]
model = "lambert"
albedo = [0.6, 0.4, 0.3]
[media.milk]
sigma_t = 2
albedo = 0.9

[sdfs.dish]
kind = "difference"
of = ["grown", "ball", "rod"]
[sdfs.ball]
kind = "sphere"
radius = 0.5
scale = 1.2
rotate = [10, 20, 30]
translate = [0.1, 0.2, 0.3]
[sdfs.rod]
kind = "capsule"
half_length = 0.4
radius = 0.1
[sdfs.grown]
kind = "smooth_union"
of = ["brick", "ring"]
width = 0.2
[sdfs.brick]
kind = "rounded_box"
half_sizes = [0.5, 0.4, 0.3]
radius = 0.1
[sdfs.ring]
kind = "torus"
ring = 0.5
tube = 0.1
[sdfs.soft]
kind = "rounded"
of = ["cube"]
radius = 0.05
[sdfs.cube]
kind = "box"
half_sizes = [0.2, 0.2, 0.2]
[sdfs.both]
kind = "union"
of = ["soft", "rod"]
translate = [0, 2, 0]

[[shapes]]
kind = "sdf"
body = "dish"
material = "clay"
[[shapes]]
kind = "sdf"
name = "pair"
body = "both"
material = "boundary"
interior = "milk"
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "s.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_says_what_the_functions_say(tmp_path: Path) -> None:
    scene = read_scene(write(tmp_path, TEXT))
    first, second = scene.shapes
    assert isinstance(first, SdfShape)
    assert isinstance(second, SdfShape)
    assert (first.name, first.material, first.interior) == ("sdf 0", "clay", None)
    assert (second.name, second.material, second.interior) == ("pair", BOUNDARY, "milk")
    ball = placed(scaled(sphere(0.5), 1.2), [0.1, 0.2, 0.3], quaternion_of([10, 20, 30]))
    grown = smooth_union(rounded_box([0.5, 0.4, 0.3], 0.1), torus(0.5, 0.1), 0.2)
    rod = capsule(0.4, 0.1)
    p = np.random.default_rng(1).uniform(-1, 1, (500, 3))
    expected = Body(difference(difference(grown, ball), rod))
    np.testing.assert_array_equal(Body(first.body).distance(p), expected.distance(p))
    pair = placed(union(rounded(box([0.2] * 3), 0.05), rod), [0, 2, 0])
    np.testing.assert_array_equal(Body(second.body).distance(p), Body(pair).distance(p))
    assert PathTracer(scene).render(spp=4, seed=1).radiance.any()


def test_turns_are_about_x_then_y_then_z() -> None:
    x, y, z = np.radians([10, 20, 30])
    about_x = np.array([[1, 0, 0], [0, np.cos(x), -np.sin(x)], [0, np.sin(x), np.cos(x)]])
    about_y = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    about_z = np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]])
    turn = about_z @ about_y @ about_x
    p = np.random.default_rng(2).uniform(-1, 1, (50, 3))
    turned = Body(placed(box([0.5, 0.3, 0.1]), quat=quaternion_of([10, 20, 30])))
    straight = Body(box([0.5, 0.3, 0.1]))
    np.testing.assert_allclose(turned.distance(p @ turn.T), straight.distance(p), atol=1e-14)


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("radius = 0.5", "radius = -1", 20, "sdfs.ball.radius: expected a length above 0 m"),
        ("radius = 0.5", "", 18, "sdfs.ball.radius: expected a value"),
        ("scale = 1.2", "scale = [1, 2, 1]", 21, "sdfs.ball.scale"),
        ("scale = 1.2", "scale = 0", 21, "one factor above 0"),
        ('kind = "torus"', 'kind = "donut"', 37, "sdfs.ring.kind: expected one of sphere, box"),
        ("tube = 0.1", "tubes = 0.1", 39, "sdfs.ring.tube"),
        ("tube = 0.1", "tube = 0.1\nwidth = 2", 40, "sdfs.ring.width: expected a key"),
        ('of = ["brick", "ring"]', 'of = ["brick", "rink"]', 30, "names among dish, ball"),
        ('of = ["brick", "ring"]', 'of = ["brick"]', 30, "a list of two names or more"),
        ('of = ["brick", "ring"]', 'of = ["brick", "dish"]', 30, "not made of themselves"),
        ('of = ["cube"]', 'of = ["cube", "rod"]', 42, "a list of one name"),
        ("radius = 0.1\n[sdfs.ring]", "radius = 0.3\n[sdfs.ring]", 32, "less than the half sizes"),
        ('body = "dish"', 'body = "dosh"', 54, "did you mean 'dish'"),
        ('body = "dish"', 'body = "dish"\nemission = 2', 55, "let a mesh or a sphere shine"),
        ('material = "clay"', 'material = "loam"', 55, "shapes.0.material"),
        ('kind = "sphere"\nradius = 0.5', 'kind = "plane"\nnormal = [0, 1]', 20, "3 finite"),
        ('of = ["soft", "rod"]', 'of = ["soft", "soft"]\nrod = 1', 50, "sdfs.both.rod"),
    ],
)
def test_a_mistake_is_named_with_line_and_key(
    tmp_path: Path, old: str, new: str, line: int, words: str
) -> None:
    assert TEXT.count(old) >= 1
    with pytest.raises(SceneError) as caught:
        read_scene(write(tmp_path, TEXT.replace(old, new, 1)))
    text = str(caught.value)
    assert f"line {line}:" in text, text
    assert words in text, text


def test_bodies_that_grow_without_end_are_refused(tmp_path: Path) -> None:
    doubled = "".join(
        f'[sdfs.d{i}]\nkind = "union"\nof = ["d{i - 1}", "d{i - 1}"]\n' for i in range(1, 14)
    )
    text = TEXT + '[sdfs.d0]\nkind = "sphere"\nradius = 1\n' + doubled
    with pytest.raises(SceneError, match="at most 4096 parts in all"):
        read_scene(write(tmp_path, text))
    chain = "".join(
        f'[sdfs.e{i}]\nkind = "rounded"\nradius = 0.1\nof = ["e{i + 1}"]\n' for i in range(80)
    )
    text = TEXT + chain + '[sdfs.e80]\nkind = "sphere"\nradius = 1\n'
    with pytest.raises(SceneError, match="at most 64 names within names"):
        read_scene(write(tmp_path, text))


def test_a_file_without_bodies_has_no_such_shapes(tmp_path: Path) -> None:
    head = TEXT[: TEXT.index("[sdfs.dish]")]
    shape = TEXT[TEXT.index("[[shapes]]") : TEXT.rindex("[[shapes]]")]
    with pytest.raises(SceneError, match=r"tables \[sdfs\.NAME\] to take a body from"):
        read_scene(write(tmp_path, head + shape))
