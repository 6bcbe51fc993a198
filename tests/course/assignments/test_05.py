"""Assignment 05 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_module
from PIL import Image

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    load_checks_of,
    source,
)

FOLDER = ASSIGNMENTS / "05_rays_and_shapes"
PRINTED = 6e-7  # the handout rounds to six decimals
X = np.array([1.0, 0, 0])


class TestRaysAndShapes(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


@pytest.fixture(scope="module")
def checks():
    return load_checks_of(FOLDER)


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), np.ravel(expected), atol=PRINTED)


def pixel_of_the_warm_up(solution):
    pose = np.array([[1, 0, 0, 0], [0, -1, 0, 2], [0, 0, -1, 5.0]])
    origins, directions = solution.camera_rays(4, 3, 2, 2, 2, 1.5, pose)
    return origins[11:], directions[11:]


def floor(height):
    def shape(places):
        up = np.tile([0.0, 1, 0], (len(places), 1))
        return places[:, 1] - height, up, -np.ones(len(places))

    return shape


def test_numbers_of_the_warm_up(solution) -> None:
    o, d = pixel_of_the_warm_up(solution)
    close(d, [0.557086, -0.371391, -0.742781])
    t, d_t = solution.march_sdf(floor(0.0), o, d, 50.0, 500)
    close(t, 5.385165)
    close(d_t, -2.692582)
    close(o + t[:, None] * d, [3, 0, 1])
    close(d_t[:, None] * d, [-1.5, 1, 2])
    t, _ = solution.march_sdf(floor(0.1), o, d, 50.0, 500)
    close(o + t[:, None] * d, [2.85, 0.1, 1.2])


def test_check_values_of_sphere_triangle_and_glass(solution) -> None:
    origins = np.array([[-4, 0.6, 0], [0, 0, 0], [-4, 1.5, 0], [2, 0, 0]])
    directions = np.array([2 * X, [0, 0, 0.5], X, X])
    t = solution.hit_sphere(origins, directions, np.zeros(3), 1.0)
    close(t[:2], [1.6, 2])
    assert np.isinf(t[2:]).all()
    two = np.array([[[0, 0, 4], [3, 0, 4], [0, 3, 4]], [[0, 0, 4], [0, 3, 4], [-3, 0, 4.0]]])
    z = np.array([0, 0, 2.0])
    t, weights = solution.hit_triangle(np.array([1, 0.5, 0]), z, two)
    assert np.isinf(t).tolist() == [False, True]
    close(t[0], 2)
    close(weights, [1 / 3, 1 / 6, 0, 0])
    t, weights = solution.hit_triangle(np.array([0, 1, 0.0]), z, two)
    close(t, [2, 2])
    close(weights, [0, 1 / 3, 1 / 3, 0])
    a, b, c = two[0] - [1, 0.5, 0]
    assert [np.cross(*pair) @ z for pair in ((b, c), (c, a), (a, b))] == [9, 6, 3]
    up = np.tile([0, 0, 1.0], (3, 1))
    d = np.array([[0.6, 0, -0.8], [0.6, 0, 0.8], [0.8, 0, 0.6]])
    out, through = solution.refract(d, up, 1.5)
    close(out, [0.4, 0, -0.916515, 0.9, 0, 0.435890, 0.8, 0, -0.6])
    assert through.tolist() == [True, True, False]
    assert np.degrees(np.arcsin(1 / 1.5)) == pytest.approx(41.810315, abs=PRINTED)


def test_check_values_of_the_march(solution, checks) -> None:
    asked: list[float] = []
    ball = checks.ball(np.zeros(3), 1.0)

    def sdf(places):
        asked.extend((places[:, 0] + 3).tolist())
        return ball(places)

    t, d_t = solution.march_sdf(sdf, np.array([[-3, 0.6, 0]]), X[None], 10.0, 100)
    close(asked[:4], [0, 2.059412, 2.175076, 2.195125])
    assert len(asked) == 14
    close([t, d_t], [2.2, -1.25])


def test_a_sphere_is_met_on_its_surface_from_far_away(solution) -> None:
    for distance in (1e4, 1e7):
        origins = np.array([[-distance, 0.6, 0], [-distance, 0.99, 0.1]])
        t = solution.hit_sphere(origins, np.tile(X, (2, 1)), np.zeros(3), 1.0)
        away = np.linalg.norm(origins + t[:, None] * X, axis=1)
        np.testing.assert_allclose(away, 1, atol=1e-15 * distance / 0.05)


def test_the_derivative_of_a_hit_is_that_of_the_closed_form(solution, checks) -> None:
    # t = -f.d - h with h^2 = r^2 - l.l, so dt/dr = -r/h, dt/dm = n / (n.d) at the place met.
    rng = np.random.default_rng(6)
    n, d = rng.normal(size=(2, 30, 3))
    n, d = n / np.linalg.norm(n, axis=1, keepdims=True), d - 2 * n
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    steep = np.sum(n * d, axis=1) < -0.3
    n, d = n[steep], d[steep]
    assert len(n) > 10
    cosine = np.sum(n * d, axis=1)
    center, by = np.array([0.3, -0.2, 0.5]), np.array([0.6, 0.0, 0.8])
    origins = center + 1.5 * n - 3 * d
    for moves, right in ((None, 1 / cosine), (by, n @ by / cosine)):
        ball = checks.ball(center, 1.5, moves)
        t, d_t = solution.march_sdf(ball, origins, d, 20.0, 2000)
        np.testing.assert_allclose(t, 3, atol=1e-8)
        np.testing.assert_allclose(d_t, right, rtol=1e-6)


def test_check_values_of_the_tree(solution) -> None:
    low = np.array([[0, 0, 0], [4, 1, 0], [1, 0, 0], [6, 0, 0], [2, 0, 0.0]])
    high = low + 1
    high[4, 1] = 3
    boxes, first, count, order = solution.build_bvh(low, high)
    assert boxes[0].tolist() == [[0, 0, 0], [7, 3, 1]]
    assert len(boxes) == 5
    told = [({0, 2}, {4, 1, 3}), ({0, 2, 4}, {1, 3})]
    halves = order[:2], order[2:]
    assert tuple(set(half.tolist()) for half in halves) in told
    for y, t, number, many in ((0.5, 1, 0, 3), (1.5, 3, 4, 5)):
        asked: list[int] = []
        origin = np.array([-1, y, 0.5])

        def box(node, asked=asked):
            asked.append(node)
            return boxes[node]

        def intersect(primitives, y=y):
            ahead = low[primitives, 0] + 1
            return np.where((low[primitives, 1] <= y) & (y <= high[primitives, 1]), ahead, np.inf)

        got = solution.traverse(first, count, order, box, intersect, origin, X)
        assert (*got, len(asked)) == (t, number, many)


def test_predictions_and_diagnoses_come_true(solution, checks) -> None:
    # p2 is the gate of task 4; p1 and p3 are facts of figures 2 and 4.
    inside = load_module("rays", apply_mutant(FOLDER, "traverse_starts_outside"))
    rng = np.random.default_rng(3)
    # d1: a room of triangles, seen from within and from far behind.
    corners = 3 * checks.ring()
    o, d = rng.normal(size=(40, 3)) * 0.3 + [6, 0, 0], rng.normal(size=(40, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    right = solution.trace_mesh(corners, o, d)
    assert (right[1] >= 0).all()
    assert (inside.trace_mesh(corners, o, d)[1] < 0).any()
    far = inside.trace_mesh(corners, o - 100 * d, d)
    np.testing.assert_array_equal(far[1], solution.trace_mesh(corners, o - 100 * d, d)[1])
    # d2: right at eta = 1, and along the normal.
    alike = load_module("rays", apply_mutant(FOLDER, "refract_from_inside_alike"))
    for eta, angle, same in ((1.0, 0.4, True), (1.5, 0.0, True), (1.5, 0.4, False)):
        way, up = np.array([[np.sin(angle), 0, np.cos(angle)]]), np.array([[0, 0, 1.0]])
        ends = [module.refract(way, up, eta)[0] for module in (solution, alike)]
        assert np.allclose(*ends) is same


def test_generated_questions_have_the_answers_that_their_reasons_give() -> None:
    bundle = read_folder(FOLDER, secret=SECRET)
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    drawn = {question.id: question.draw for question in bundle.questions if question.draw}
    for y in drawn["05.g1"]["y"]:
        got = keys.slope_by_radius(reference, 4.0, y)
        assert got == pytest.approx(-1 / np.sqrt(1 - y * y), rel=1e-5)
    for eta in drawn["05.g2"]["eta"]:
        for angle in drawn["05.g2"]["angle"]:
            sine = eta * np.sin(np.radians(angle))
            right = np.degrees(np.arcsin(sine)) if sine < 1 else angle
            assert keys.angle_behind(reference, eta, angle) == pytest.approx(right)
    for primitives in drawn["05.g3"]["primitives"]:
        leaves, groups = 0, [primitives]
        for many in groups:
            leaves += many <= 2
            groups += [many // 2, many - many // 2] if many > 2 else []
        assert keys.nodes_of_tree(reference, primitives) == 2 * leaves - 1 == len(groups)


def test_rays_of_the_camera_are_those_of_the_core(solution) -> None:
    cameras = pytest.importorskip("photograd.capture.camera")
    turn, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn * np.linalg.det(turn), [1, -2, 3]
    camera = cameras.Camera(7, 5, 6.0, 6.5, 3.25, 2.75, pose)
    mine = solution.camera_rays(7, 5, 6.0, 6.5, 3.25, 2.75, pose[:3])
    np.testing.assert_allclose(mine, camera.rays(), atol=1e-14)


def test_the_tree_finds_what_embree_finds(solution, checks) -> None:
    meshes = pytest.importorskip("photograd.geometry.mesh")
    corners = checks.ring()
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    tree = meshes.Bvh(meshes.Mesh(corners.reshape(-1, 3).astype(np.float32), faces))

    def core(origins, directions):
        hits = tree.trace(origins, directions)
        return tree.surface_points(origins, directions, hits).t, hits

    # The table that checks carry.
    t, hits = core(*checks.ring_rays())
    assert tuple(hits.primitive.tolist()) == checks.EMBREE
    np.testing.assert_allclose(t[hits.hit], checks.EMBREE_T, rtol=1e-12)
    # Random rays: the same off a band of 1e-7 around edges.
    rng = np.random.default_rng(5)
    origins = rng.normal(size=(800, 3)) * 2.5
    directions = rng.normal(size=(800, 3)) * [1.5, 0.4, 1.5] - origins
    t, hits = core(origins, directions)
    mine, number = solution.trace_mesh(corners, origins, directions)
    u = hits.barycentrics
    edge = np.minimum(u.min(axis=1), 1 - u.sum(axis=1)) < 1e-7
    assert 300 < hits.hit.sum() < 780
    clear = ~(hits.hit & edge)
    assert clear.mean() > 0.99
    np.testing.assert_array_equal(number[clear], hits.primitive[clear])
    met = clear & hits.hit
    np.testing.assert_allclose(mine[met], t[met], rtol=1e-9)


# Mistakes that no mutant's fingerprint meets, as everybody makes them a little differently.
LIKELY = {
    "05.1.outside fails as well": (
        "05.1.inside",
        "nearest - half, nearest + half)",
        "nearest, np.inf)",
    ),
    "both sides": ("05.2.inside", "| (volumes <= 0).all(axis=0)", ""),
}


@pytest.mark.parametrize("said", LIKELY)
def test_likely_mistakes_are_recognized(said: str) -> None:
    check, right, wrong = LIKELY[said]
    text = source(FOLDER)
    assert text.count(right) == 1
    outcomes = {
        each.id: each for each in judge(FOLDER, text.replace(right, wrong), tasks=[check[:4]])
    }
    assert said in outcomes[check].hint


def test_the_exploration_runs_beside_the_core(tmp_path: Path) -> None:
    for name in ("rays.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    done = subprocess.run(
        [
            sys.executable,
            "explore.py",
            "--triangles",
            "64",
            "--size",
            "32",
            "--rays",
            "200",
            "--figure",
            "0",
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    with Image.open(tmp_path / "seen.png") as image:
        assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    assert float(done.stdout.split("your derivative is ")[1].split()[0]) < 1e-3
    assert " 0 rays are still inside" in done.stdout
    if "core not installed" not in done.stdout:
        assert ", 0 in one of the two only" in done.stdout
        assert float(done.stdout.split("t is ")[1].split()[0]) < 1e-9
