"""Assignment 06 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.load import load_beside
from PIL import Image

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    lost,
)

FOLDER = ASSIGNMENTS / "06_real_time_frame"
EARLIER = {
    "rays.py": ASSIGNMENTS / "05_rays_and_shapes",
    "reflectance.py": ASSIGNMENTS / "04_reflectance",
}
PRINTED = 6e-7  # the handout rounds to six decimals


class TestRealTimeFrame(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def bundle() -> Bundle:
    return read_folder(FOLDER, secret=SECRET)


@pytest.fixture(scope="module")
def solution(bundle: Bundle):
    return bundle.reference


def mutant(bundle: Bundle, name: str):
    return load_beside("real_time_frame", apply_mutant(FOLDER, name), bundle.brought)


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), np.ravel(expected), atol=PRINTED)


def test_numbers_of_the_warm_up(solution) -> None:
    """The floor in perspective: one pixel on an edge, depths 2 and 6."""
    assert pytest.approx(3.428571, abs=PRINTED) == 12 / 3.5
    corners = np.array([[[0.5, 6.5, 2], [0.5, 2.5, 6], [4.5, 2.5, 4]]])  # the edge is a left one
    face, weights, depth = solution.rasterize(corners, 8, 6)
    # Row 3 has its center at 3.5, a part 0.75 of the way; row 4 the half of it.
    assert face[3, 0] == face[4, 0] == 0
    for row, s in ((3, 0.75), (4, 0.5)):
        z = 1 / ((1 - s) / 2 + s / 6)
        close(depth[row, 0], z)
        close(weights[row, 0], [z * (1 - s) / 2, z * s / 6, 0])
    z = 1 / (0.375 / 2 + 0.625 / 6)
    close([1 / z, z, z * 0.375 / 2, z * 0.625 / 6], [0.291667, 3.428571, 0.642857, 0.357143])


def test_check_values_of_rasterizer_and_shadows(solution) -> None:
    corners = np.array([[[0, 0, 1], [4, 0, 2], [0, 4, 4.0]]])
    face, weights, depth = solution.rasterize(corners, 4, 4)
    assert (face >= 0).sum(axis=1).tolist() == [3, 2, 1, 0]
    close(weights[1, 1], [0.470588, 0.352941, 0.176471])
    close(weights[0, 2], [0.421053, 0.526316, 0.052632])
    close([depth[1, 1], depth[0, 2]], [1.882353, 1.684211])
    shadows = np.full((4, 4), 4.0)
    shadows[:, :2] = 2
    point, n, pose = np.array([[-0.375, -0.375, 3]]), np.array([[0, 0, -1.0]]), np.eye(3, 4)
    for bias, place, lit in (
        (0, (1.5, 1.5, 3), 0.333333),
        (0.5, (1.4, 1.4, 2.5), 0.333333),
        (1.5, (1, 1, 1.5), 1),
    ):
        close(solution.project(point + bias * n, 4.0, pose, 4, 4), place)
        close(solution.shadow_test(point, n, shadows, 4.0, pose, bias), lit)


def test_check_values_of_light_and_bloom(solution) -> None:
    pixel = {
        "depth": np.array([[2.0]]),
        "normal": np.array([[[0.6, 0, -0.8]]]),
        "base_color": np.array([[[0.8, 0.4, 0.2]]]),
        "emission": np.array([[[0, 0, 0.1]]]),
        "metalness": np.array([[0.0]]),
        "roughness": np.array([[0.5]]),
        "alpha": np.array([[0.5]]),
    }
    lights = {
        "to_sun": np.array([0.6, 0, 0.8]),
        "sun": np.array([3.0, 3, 3]),
        "sky": np.array([0.5, 0.5, 1]),
    }
    pose = solution.look_at((0, 0, 5), (0, 0, 0))
    close(lights["to_sun"] @ pose[:, :3], [0.6, 0, -0.8])
    layer = solution.light_surfaces(pixel, 1.0, pose, lights, np.ones((1, 1)), np.full((1, 1), 0.5))
    close(layer, [0.481840, 0.248493, 0.206820, 0.5])
    sky = 0.5 * lights["sky"] * pixel["base_color"] + pixel["emission"]
    close((layer[..., :3] / 0.5 - sky) / 3, [0.254560, 0.132329, 0.071213])
    row = np.zeros((1, 5, 3))
    row[0, 2] = 5, 1, 0
    got = solution.bloom(row, 1.0, 0.5, 0.5)
    close(got[0, :, 0], [0.000415, 0.167462, 4.237387, 0.167462, 0.000415])
    np.testing.assert_array_equal(got[..., 1:], row[..., 1:])
    k = np.exp(-2.0 * np.arange(-2, 3) ** 2)
    close(k / k.sum(), [0.000264, 0.106451, 0.786571, 0.106451, 0.000264])


def test_check_values_of_tone_and_occlusion(solution) -> None:
    color, g = np.array([[[1, 0.5, 0.25]]]), np.array([[[1.0, 0, 0]]])
    shown, d_radiance, d_settings = solution.tone_map(color, np.array([1.0, 2.0]), g)
    close(2 * color @ solution.LUMINANCE, 1.1765)
    close(shown, [1.189180, 0.594590, 0.297295])
    close(d_radiance, [1.054542, -0.452930, -0.045724])
    close(d_settings, [0.566056, -0.270273])
    depth, offsets = np.array([[2, 2, 1.8]]), np.zeros((1, 3, 1, 2))
    offsets[0, 1, 0, 0] = 0.3
    normals = np.tile([0, 0, -1.0], (1, 3, 1))
    settings, g = np.array([0.6, 2, 1.5]), np.array([[0, 1.0, 0]])
    assert pytest.approx(0.96) == solution.REACH * 8 / 2 * 0.3
    got = solution.ambient_occlusion(depth, normals, 8.0, offsets, settings, g)
    close(got[0], [1, 0.509223, 1])
    close(got[1], [-1.100737, 0.142325, -0.327185])
    v = solution.unproject(depth, 8.0)[0, 2] - solution.unproject(depth, 8.0)[0, 1]
    close(v, [0.225, 0, -0.2])
    close([v @ v, -v[2] / np.sqrt(v @ v)], [0.090625, 0.664364])
    assert got[1][2] == pytest.approx((got[0][0, 1] - 1) / 1.5)


def test_a_bias_of_texels_suffices_at_every_angle_and_none_gives_stripes(solution) -> None:
    # Section 2, and prediction 2: a plane before its own map.
    rng, size, focal = np.random.default_rng(2), 60, 2e5
    for angle in (0.3, 0.8, 1.4):
        n = np.array([np.sin(angle), 0, -np.cos(angle)])
        u, v = rng.uniform(8, size - 8, (2, 2000))
        flat = np.stack([(u - size / 2) / focal, (v - size / 2) / focal, np.ones(2000)], axis=1)
        points = flat * (1e4 * n[2] / (flat @ n))[:, None]
        rays = solution.unproject(np.ones((size, size)), focal)
        what = np.tile(n, (2000, 1)), 1e4 * n[2] / (rays @ n), focal, np.eye(3, 4)
        texel = 1e4 / focal
        assert (solution.shadow_test(points, *what, 2.2 * texel) == 1).all()
        bare = solution.shadow_test(points, *what, 0.0)
        assert 0.4 < bare.mean() < 0.7
        assert (bare < 1).mean() > 0.9
        least = 1.5 * np.sqrt(2) * np.sin(angle)
        assert least < 2.2
    corner = points - 0.9 * 1.4 * texel * np.tile(n, (2000, 1))
    assert (solution.shadow_test(corner, *what, 2.2 * texel) < 1).any()


def test_predictions_and_diagnoses_come_true(bundle: Bundle, solution) -> None:
    corners = np.array([[[-3.5, 0.5, 1], [4.5, 0.5, 4], [0.5, 8.5, 2]]])
    _, weights, depth = solution.rasterize(corners, 1, 1)  # p1: halfway between 1 m and 4 m
    close([weights[0, 0, 1], depth[0, 0]], [0.2, 1.6])
    # d1: the sun is kept in the frame of the first camera, the scene's; right there alone.
    wrong, rng = mutant(bundle, "light_sun_in_world"), np.random.default_rng(4)
    first = solution.LIGHTS["to_sun"] @ solution.POSE[:, :3]
    kept = {**solution.LIGHTS, "to_sun": first}  # the mutant takes it as it is
    gbuffer = solution.render(12, 18, rings=4, size=32)
    parts = rng.uniform(0, 1, (2, 12, 18))
    assert np.abs(solution.POSE[:, :3] - np.eye(3)).max() > 1  # in the world it is wrong at once
    for pose, least, most in (
        (solution.POSE, 0.0, 1e-9),
        (solution.look_at((5, 1.9, 4), (0.3, 0.92, 0)), 1.0, np.inf),
    ):
        drawn = solution.draw(solution.meshes(6), 18.0, pose, 12, 18)
        got = wrong.light_surfaces(drawn, 18.0, pose, kept, *parts)
        right = solution.light_surfaces(drawn, 18.0, pose, solution.LIGHTS, *parts)
        assert least <= np.abs(got - right).max() <= most
    still = np.concatenate([np.eye(3), [[0], [1], [2]]], axis=1)
    lights = {**solution.LIGHTS, "to_sun": np.array([-0.6, 0, -0.8])}
    # d2: straight alpha is an opaque bubble before black, and brighter than all before a floor.
    straight = mutant(bundle, "light_alpha_straight")
    thin = {**gbuffer, "alpha": np.full((12, 18), 0.3)}
    layer = straight.light_surfaces(thin, 18.0, still, lights, *parts)
    opaque = solution.light_surfaces(
        {**thin, "alpha": np.ones((12, 18))}, 18.0, still, lights, *parts
    )
    floor, here = opaque[..., :3].mean() * np.ones((12, 18, 3)), opaque[..., 3] > 0
    np.testing.assert_allclose(solution.over(layer, 0 * floor)[here], opaque[here][:, :3])
    assert (solution.over(layer, floor) > opaque[..., :3])[here].all()
    bright = here & (opaque[..., :3] > 0.31 * floor).all(axis=2)
    assert bright.any()
    assert (solution.over(layer, floor) > floor)[bright].all()


def test_generated_questions_have_the_answers_that_their_reasons_give(bundle: Bundle) -> None:
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    draws = {question.id: question.draw for question in bundle.questions if question.draw}
    for a in draws["06.g1"]["a"]:
        for b in draws["06.g1"]["b"]:
            for s in draws["06.g1"]["s"]:
                right = (s / b) / ((1 - s) / a + s / b)
                assert keys.weight_in_perspective(reference, a, b, s) == pytest.approx(right)
    for c in draws["06.g2"]["c"]:
        for e in draws["06.g2"]["e"]:
            for w in draws["06.g2"]["w"]:
                Y = 2.0**e * c
                right = Y * (1 + Y / w**2) / (1 + Y)
                assert keys.shown_gray(reference, c, e, w) == pytest.approx(right)
    for d in draws["06.g3"]["d"]:
        for h in draws["06.g3"]["h"]:
            right = -(h / d - 0.08) * 2 * (1 - d * d) * 2 * d * d
            assert keys.slope_by_the_radius(reference, d, h) == pytest.approx(right)


def test_the_rasterizer_and_the_tone_curve_are_those_of_the_core(solution) -> None:
    raster = pytest.importorskip("photograd.raster")
    frame = pytest.importorskip("photograd.frame")
    height, width = 60, 96
    corners = solution.joined(solution.meshes(8))[0].reshape(-1, 3)
    flat = solution.project(corners, solution.ZOOM * width, solution.POSE, height, width)
    flat[:, :2] = np.round(256 * flat[:, :2]) / 256
    face, weights, depth = solution.rasterize(flat.reshape(-1, 3, 3), height, width)
    positions = np.concatenate([flat[:, :2] * flat[:, 2:], flat[:, 2:]], axis=1)
    order = np.arange(len(flat), dtype=np.uint32).reshape(-1, 3)
    seen = raster.rasterize(positions, order, (height, width))
    alike = seen.face == face
    assert alike.mean() > 0.999
    here = alike & (face >= 0)
    np.testing.assert_allclose(seen.depth[here], depth[here], rtol=1e-9)
    np.testing.assert_allclose(seen.barycentrics[here], weights[here][:, 1:], atol=1e-7)
    gray = np.linspace(0, 8, 50)[None, :, None] * np.ones(3)
    shown = frame.tone_map(gray, "reinhard", exposure=0.7, params={"white": 2.5})
    mine = solution.tone_map(gray, np.array([0.7, 2.5]), 0 * gray)[0]
    np.testing.assert_allclose(mine, shown, rtol=1e-12)


def test_a_wrong_sphere_costs_the_checks_of_the_scene_alone(bundle: Bundle, monkeypatch) -> None:
    rays = bundle.brought["rays"].replace("(rest >= 0)", "(rest >= 1e9)")
    assert rays != bundle.brought["rays"]
    monkeypatch.setitem(bundle.brought, "rays", rays)
    monkeypatch.setattr("course.assignments.support.bundle_of", lambda *_: bundle)
    outcomes = judge(FOLDER, tasks=["06.1", "06.2", "06.6"])
    assert lost(outcomes) <= {"06.2.traced", "06.6.tuned"}
    assert "06.2.traced" in lost(outcomes)


def test_a_stub_of_the_material_is_named_itself(bundle: Bundle, monkeypatch) -> None:
    stub = "def gltf(*_):\n    raise NotImplementedError\n"
    monkeypatch.setitem(bundle.brought, "reflectance", stub)
    monkeypatch.setattr("course.assignments.support.bundle_of", lambda *_: bundle)
    texts = {each.id: each.text for each in judge(FOLDER, tasks=["06.3"])}
    for name in ("sun", "rest", "linear"):
        assert texts[f"06.3.{name}"] == "gltf: not implemented yet"


def test_the_exploration_runs_beside_the_core(tmp_path: Path) -> None:
    for name in ("explore.py", "real_time_frame.py"):
        shutil.copy(FOLDER / name, tmp_path)
    for name, folder in EARLIER.items():
        shutil.copy(folder / name, tmp_path)
    shutil.copytree(FOLDER / "data", tmp_path / "data")
    order = [sys.executable, "explore.py", "--small", "48", "--steps", "8", "--size", "128"]
    order += ["--angle", "40", "--width", "64", "--side", "2"]
    ran = subprocess.run(order, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert "48 x 30: drawn in" in ran.stdout
    errors = ran.stdout.split("error ")[1].split()
    assert float(errors[2]) < 0.8 * float(errors[0])
    if "core not installed" not in ran.stdout:
        assert float(ran.stdout.split("core: ")[1].split()[0]) > 99.9
    with Image.open(tmp_path / "frame.png") as image:
        assert image.size == (64, 40)
        assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    assert (tmp_path / "compared.png").stat().st_size > 5_000
