"""A mesh with a texture and opacity: closed forms, its adjoint, and meshes that are refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import photograd
import pytest
from photograd.capture.camera import Camera
from photograd.errors import DtypeError, RangeError, SceneError, ShapeError
from photograd.fields import MeshSurface, TexturedSurface
from photograd.fields.layered_picture import LayeredPicture, Unwrapped
from photograd.geometry.octahedron import unwrapped_sphere
from photograd.representation import GradientProblem, ImageBatch, Outputs, RenderOptions
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants

CAMERA = Camera(24, 20, fx=20.0, fy=20.0, cx=12.0, cy=10.0, world_from_camera=np.eye(4))
OPTIONS = RenderOptions()
PLACES = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])


def raw(values: Any) -> Any:
    values = np.asarray(values, np.float64)
    return np.log(values / (1 - values))


def sheets(*depths: float, size: float = 4.0, shift: float = 0.0) -> tuple[Any, Unwrapped]:
    """Squares across the axis of the camera, one at each depth, all with the whole texture."""
    square = size * np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]]) + np.array([shift, 0.0])
    vertices = [[*(z * xy / 2.0), z] for z in depths for xy in square]
    faces = [
        [4 * k + i for i in part] for k in range(len(depths)) for part in ((0, 1, 2), (0, 2, 3))
    ]
    uv = np.tile(PLACES, (len(depths), 1))
    return np.array(vertices), Unwrapped(uv, np.array(faces), np.arange(len(vertices)))


def field_of(vertices: Any, unwrapped: Unwrapped, rgba: Any, **more: Any) -> TexturedSurface:
    more = {"smoothness": 0.0, "dtype": np.float64, **more}
    return TexturedSurface.of_mesh(vertices, unwrapped, raw(rgba), **more)


def drawn(field: Any, camera: Camera = CAMERA) -> Any:
    outputs, _ = field.render(ImageBatch(camera), seed=0, step=0, options=OPTIONS)
    size = (camera.height, camera.width)
    return (
        outputs.color.reshape(*size, 3),
        outputs.opacity.reshape(size),
        outputs.depth.reshape(size),
    )


def test_layers_lie_over_each_other_in_closed_form() -> None:
    vertices, unwrapped = sheets(2.0, 3.0, 5.0)
    field = field_of(vertices, unwrapped, np.full((2, 2, 4), [0.2, 0.5, 0.8, 0.4]))
    color, opacity, depth = drawn(field)
    seen = 0.4 * np.array([1, 0.6, 0.36])  # share of each layer
    np.testing.assert_allclose(opacity, seen.sum(), rtol=1e-12)
    np.testing.assert_allclose(
        color, np.broadcast_to(seen.sum() * np.array([0.2, 0.5, 0.8]), color.shape)
    )
    np.testing.assert_allclose(depth, seen @ [2.0, 3.0, 5.0], rtol=1e-12)
    two = TexturedSurface(
        *(field.params[name] for name in ("differential", "texels")),
        unwrapped,
        photograd.fields.textured_surface.TexturePolicy(0.0, 1.0, max_layers=2),
    )
    np.testing.assert_allclose(drawn(two)[1], seen[:2].sum(), rtol=1e-12)


def test_an_opaque_mesh_of_one_color_is_that_of_vertex_colors() -> None:
    sphere, *places = unwrapped_sphere(4)
    vertices, unwrapped = 0.8 * sphere + np.array([0.1, 0, 3]), Unwrapped(*places)
    field = field_of(vertices, unwrapped, np.full((4, 4, 3), [0.2, 0.5, 0.8]))
    logits = np.tile(raw([0.2, 0.5, 0.8]), (len(vertices), 1))
    plain = MeshSurface.of_mesh(vertices, unwrapped.faces, logits, smoothness=0.0, dtype=np.float64)
    for ours, theirs in zip(drawn(field), drawn(plain), strict=True):
        np.testing.assert_allclose(ours, theirs, atol=1e-12)
    assert drawn(field)[1].min() == 0
    assert ((drawn(field)[1] > 0) & (drawn(field)[1] < 1)).sum() > 10  # the silhouette


def test_texels_lie_where_the_places_say() -> None:
    vertices, unwrapped = sheets(2.0, size=1.0)
    rgba = np.random.default_rng(1).uniform(0.1, 0.9, (4, 4, 3))
    near = Camera(4, 4, fx=4.0, fy=4.0, cx=2.0, cy=2.0, world_from_camera=np.eye(4))
    np.testing.assert_allclose(drawn(field_of(vertices, unwrapped, rgba), near)[0], rgba, rtol=1e-9)


@pytest.mark.parametrize("shift", [0.013, 0.037, 0.061])
def test_a_silhouette_behind_a_transparent_sheet_covers_what_it_should(shift: float) -> None:
    """The edge at x = (1 + shift) z / 2 of the sheet behind, through the one in front."""
    front, _ = sheets(2.0)
    back, _ = sheets(3.0, size=0.5, shift=shift)
    vertices = np.concatenate([front, back])
    _, unwrapped = sheets(2.0, 3.0)
    field = field_of(vertices, unwrapped, np.full((2, 2, 4), [0.2, 0.5, 0.8, 0.5]))
    row = drawn(field)[1][10]
    left, right = (12 + 20 * (side * 0.5 + shift) / 2 for side in (-1, 1))
    x = np.arange(24)
    covered = np.clip(np.minimum(x + 1, right) - np.maximum(x, left), 0, 1)
    np.testing.assert_allclose(row, 0.5 + 0.5 * 0.5 * covered, atol=1e-12)
    # Without the silhouettes of the second layer it would be a step.
    steps = 0.5 + 0.25 * ((x + 0.5 > left) & (x + 0.5 < right))
    assert np.abs(row - steps).max() > 0.02


class Opaque(TexturedSurface):
    """Its example without opacity."""

    @classmethod
    def example(cls, *, seed: int, dtype: Any = np.float64) -> Any:
        field = TexturedSurface.example(seed=seed, dtype=dtype)
        u, texels = field.params["differential"], field.params["texels"]
        return cls(u, np.ascontiguousarray(texels[..., :3]), field.unwrapped, field.policy)


@pytest.mark.parametrize("kind", [TexturedSurface, Opaque])
def test_derivatives_with_respect_to_everything_are_proved(kind: Any) -> None:
    for seed in (0, 3):
        checks = photograd.check_gradients(kind, seed=seed, camera=True)
        assert checks, str(checks)
        assert checks.camera is not None


class Problem(GradientProblem):
    """Of the gradient checks, with a part of the adjoint left out."""

    def without(self, part: str) -> Any:
        whole = LayeredPicture.position_gradients

        def wrong(picture: Any, d_image: Any) -> Any:
            found = whole(picture, d_image)
            zero = {"silhouettes": np.zeros_like(found.silhouettes)}
            if part == "interior":
                zero = {"interior": np.zeros_like(found.interior)}
            return photograd.fields.layered_picture.LayeredGradients(**{**vars(found), **zero})

        return wrong

    def cotangent(self) -> dict[str, Any]:
        g = np.random.default_rng(7)
        return {k: g.uniform(0.5, 1.5, v.shape) for k, v in self.forward(self.params).items()}


@pytest.mark.parametrize("part", ["silhouettes", "interior"])
def test_an_adjoint_without_one_of_its_parts_is_noticed(
    part: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    proof = Problem(TexturedSurface, seed=2)
    assert check_gradient(proof.forward, proof.backward, proof.params, seed=2)
    monkeypatch.setattr(LayeredPicture, "position_gradients", proof.without(part))
    assert not check_gradient(proof.forward, proof.backward, proof.params, seed=2)


def test_mutants_of_the_backward_pass_die() -> None:
    proof = Problem(TexturedSurface, seed=4)
    report = check_gradient_mutants(
        proof.forward, proof.backward, proof.params, proof.cotangent(), seed=4, directions=4
    )
    assert report, str(report)


def test_what_is_no_such_mesh_is_refused() -> None:
    vertices, unwrapped = sheets(2.0)
    texels = np.zeros((2, 2, 4))
    of = TexturedSurface.of_mesh
    with pytest.raises(RangeError, match=r"vertices: .*finite"):
        of(np.where(vertices == 2, np.nan, vertices), unwrapped, texels)
    with pytest.raises(RangeError, match="uv: "):
        of(vertices, Unwrapped(2 * PLACES, unwrapped.corners, unwrapped.vertex), texels)
    with pytest.raises(RangeError, match="vertex: "):
        of(vertices, Unwrapped(PLACES, unwrapped.corners, unwrapped.vertex + 1), texels)
    with pytest.raises(RangeError, match="corners: "):
        of(vertices, Unwrapped(PLACES, unwrapped.corners + 1, unwrapped.vertex), texels)
    for shape in ((2, 2), (2, 2, 2), (0, 2, 4), (2, 2, 5)):
        with pytest.raises(ShapeError, match="texels"):
            of(vertices, unwrapped, np.zeros(shape))
    with pytest.raises(SceneError, match="triangles with area, got 2 without"):
        of(vertices * [1, 0, 0], unwrapped, texels)
    three = np.array([[0, 1, 2], [0, 2, 3], [2, 0, 1]])
    with pytest.raises(SceneError, match="edges of one or two faces"):
        of(vertices, Unwrapped(PLACES, three, unwrapped.vertex), texels)
    with pytest.raises(DtypeError, match="differential"):
        TexturedSurface(np.zeros((4, 3), int), texels, unwrapped)
    field = of(vertices, unwrapped, texels)
    with pytest.raises(RangeError, match="load_state: state: expected this mesh's"):
        field.load_state(field.state() | {"uv": PLACES / 2})
    with pytest.raises(RangeError, match="max_layers"):
        photograd.fields.textured_surface.TexturePolicy(max_layers=0)


def test_a_picture_of_nothing_has_no_gradient() -> None:
    vertices, unwrapped = sheets(-2.0)  # behind the camera
    field = field_of(vertices, unwrapped, np.full((2, 2, 4), 0.5))
    outputs, context = field.render(ImageBatch(CAMERA), seed=0, step=0, options=OPTIONS)
    assert not outputs.opacity.any()  # type: ignore[union-attr]
    ones = Outputs(np.ones((480, 3)), np.ones(480), np.ones(480))
    assert not any(part.any() for part in field.render_backward(context, ones).values())
