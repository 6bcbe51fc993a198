"""Derivatives inside of faces: differences, mutants, transposition, and what stays zero."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.frames import invert_rigid
from photograd.raster import (
    interpolate,
    interpolate_backward,
    project,
    project_backward,
    rasterize,
    rasterize_backward,
)
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.raster import oracle

SIZE = (20, 24)
CAMERA = oracle.camera()


class Picture:
    """Attributes and depths as pixels see them, of vertices, attributes and the camera."""

    def __init__(self, vertices: Any, faces: Any) -> None:
        self.faces = faces
        attributes = np.random.default_rng(3).uniform(-1, 1, (len(vertices), 2))
        numbers = np.array([CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy])
        self.place = {"vertices": vertices, "attributes": attributes, "intrinsics": numbers}
        # What pixels see is held, as the adjoint holds it: differences at edges say nothing.
        self.visibility = rasterize(project(vertices, CAMERA), faces, SIZE)

    def camera(self, p: dict[str, Any]) -> Any:
        fx, fy, cx, cy = p["intrinsics"]
        return replace(CAMERA, fx=fx, fy=fy, cx=cx, cy=cy)

    def forward(self, p: dict[str, Any]) -> dict[str, Any]:
        positions = project(p["vertices"], self.camera(p))
        visibility = rasterize(positions, self.faces, SIZE)
        if not np.array_equal(visibility.face, self.visibility.face):
            visibility = self.held(positions)
        values = interpolate(p["attributes"], self.faces, visibility)
        return {"values": values, "depth": np.where(visibility.covered, visibility.depth, 0.0)}

    def held(self, positions: Any) -> Any:
        """Barycentrics and depths of the faces that are seen at the place itself."""
        b, z = np.zeros_like(self.visibility.barycentrics), np.zeros_like(self.visibility.depth)
        for y, x in np.argwhere(self.visibility.covered):
            corners = positions[self.faces[self.visibility.face[y, x]]]
            share = np.linalg.solve(corners.T, [x + 0.5, y + 0.5, 1.0])
            z[y, x], b[y, x] = 1 / share.sum(), share[1:] / share.sum()
        return replace(self.visibility, barycentrics=b, depth=z)

    def backward(self, p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        camera = self.camera(p)
        positions = project(p["vertices"], camera)
        visibility = rasterize(positions, self.faces, SIZE)
        d_attributes, d_b = interpolate_backward(
            p["attributes"], self.faces, visibility, d["values"]
        )
        d_positions = rasterize_backward(positions, self.faces, visibility, d_b, d["depth"])
        found = project_backward(p["vertices"], camera, d_positions)
        intrinsics = np.array([found.fx, found.fy, found.cx, found.cy])
        return {"vertices": found.vertices, "attributes": d_attributes, "intrinsics": intrinsics}


SCENES = {
    "sphere": oracle.sphere(6, 4),
    "soup": oracle.soup(15, 1),
    "behind the camera": oracle.soup(6, 2, size=6.0),
}


@pytest.mark.parametrize("name", SCENES)
def test_everything_agrees_with_central_differences(name: str) -> None:
    picture = Picture(*SCENES[name])
    assert picture.visibility.covered.any()
    report = check_gradient(picture.forward, picture.backward, picture.place, seed=1)
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    picture = Picture(*SCENES["sphere"])
    values = picture.forward(picture.place)
    rng = np.random.default_rng(2)
    cotangent = {name: rng.uniform(-1, 1, array.shape) for name, array in values.items()}
    report = check_gradient_mutants(
        picture.forward, picture.backward, picture.place, cotangent, seed=1, coordinates=8
    )
    assert report, str(report)


def test_the_pose_of_the_camera() -> None:
    vertices = SCENES["sphere"][0]
    view = invert_rigid(CAMERA.world_from_camera)[:3]
    matrix = np.array([[CAMERA.fx, 0, CAMERA.cx], [0, CAMERA.fy, CAMERA.cy], [0, 0, 1.0]])

    def forward(p: dict[str, Any]) -> Any:
        local = p["vertices"] @ p["view"][:, :3].T + p["view"][:, 3]
        return local @ matrix.T

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        found = project_backward(p["vertices"], CAMERA, d)
        return {"vertices": found.vertices, "view": found.camera_from_world}

    place = {"vertices": vertices, "view": view}
    np.testing.assert_allclose(forward(place), project(vertices, CAMERA), rtol=1e-12)
    report = check_gradient(forward, backward, place, seed=2)
    assert report, str(report)


def test_a_linear_attribute_is_interpolated_with_perspective() -> None:
    """World positions as attributes: a pixel gets the point where its ray meets the face."""
    vertices, faces = SCENES["soup"]
    visibility = rasterize(project(vertices, CAMERA), faces, SIZE)
    points = interpolate(vertices, faces, visibility)
    origins, directions = CAMERA.rays()
    t = visibility.depth.reshape(-1) / (directions @ CAMERA.forward)
    hit = visibility.covered.reshape(-1)
    rays = origins[hit] + t[hit, None] * directions[hit]
    np.testing.assert_allclose(points.reshape(-1, 3)[hit], rays, atol=1e-12)
    flat = 0.5 * np.ones((3, 1))  # without the perspective, the middle of an edge is at its half
    positions = np.array([[0.0, 0.5, 1], [40, 2, 4], [0, 4, 1]])
    assert interpolate(flat, [[0, 1, 2]], rasterize(positions, [[0, 1, 2]], (4, 10))).max() == 0.5


def test_interpolation_is_transposed() -> None:
    vertices, faces = SCENES["soup"]
    rng = np.random.default_rng(4)
    visibility = rasterize(project(vertices, CAMERA), faces, SIZE)
    a, change = rng.uniform(-1, 1, (2, len(vertices), 3))
    g = rng.uniform(-1, 1, (*SIZE, 3))
    along = (interpolate(change, faces, visibility) * g).sum()
    assert along == pytest.approx((interpolate_backward(a, faces, visibility, g)[0] * change).sum())


def test_point_samples_do_not_see_a_silhouette_move() -> None:
    """Coverage as it is sampled has no derivative: that of a constant attribute is zero."""
    vertices, faces = SCENES["sphere"]
    positions = project(vertices, CAMERA)
    visibility = rasterize(positions, faces, SIZE)
    white = np.ones((len(vertices), 1))
    coverage = interpolate(white, faces, visibility)
    assert 0 < coverage.sum() < coverage.size
    _, d_b = interpolate_backward(white, faces, visibility, np.ones_like(coverage))
    assert not rasterize_backward(positions, faces, visibility, d_b).any()
