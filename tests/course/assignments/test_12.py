"""Assignment 12 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.drawing import draw as draw_question
from photograd_course.assignment.load import load_beside
from PIL import Image

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    lost,
    source,
)

FOLDER = ASSIGNMENTS / "12_nerf"
EARLIER = {
    "engine.py": ASSIGNMENTS / "02_backpropagation",
    "volume_rendering.py": ASSIGNMENTS / "08_volume_rendering",
}
PRINTED = 6e-7  # the handout rounds to six decimals


class TestNerf(AssignmentTests):
    folder = FOLDER
    long_figures = frozenset({"fig1_view", "fig2_encoding"})


@pytest.fixture(scope="module")
def bundle() -> Bundle:
    return read_folder(FOLDER, secret=SECRET)


@pytest.fixture(scope="module")
def solution(bundle: Bundle):
    return bundle.reference


def mutant(bundle: Bundle, name: str):
    return load_beside("nerf", apply_mutant(FOLDER, name), bundle.brought)


def small_network(solution) -> dict:
    """The network of the handout's check values: every number is 0.1."""
    network = solution.make_network(2, 1, np.random.default_rng(0))
    return {name: [0 * array + 0.1 for array in layers] for name, layers in network.items()}


def two_rays() -> tuple[dict, np.ndarray]:
    """The batch of the handout's check values, and its distances."""
    batch = {
        "origins": np.array([[0.0, 0, 3], [0.3, 0, 3]]),
        "directions": np.array([[0.0, 0, -1], [0, 0, -1]]),
        "colors": np.array([[0.9, 0.2, 0.1], [0.5, 0.5, 0.5]]),
        "background": np.ones(3),
        "near": 2.0,
        "far": 4.0,
    }
    return batch, np.array([[2.2, 3, 3.5], [2.5, 2.6, 3.8]])


def test_check_values_of_the_warm_up(solution) -> None:
    """One neuron, by `mlp_backward`: layers of one number each."""
    for w, expected in ((0.5, (1.6, 0.96, 1.6, 9.6, 4.8, 2.4)), (0.1, (-2, 0, -2, 0, 0, 0))):
        layers = [np.array([[w]]), np.array([-0.4]), np.array([[3.0]]), np.array([1.0])]
        activations = solution.mlp_forward(layers, np.array([[2.0]]))
        if w == 0.5:
            assert [float(each[0, 0]) for each in activations[1:]] == pytest.approx([0.6, 2.8])
        g = 2 * (activations[-1] - 2.0)
        (g_w, g_b, g_v, g_c), g_x = solution.mlp_backward(layers, activations, g)
        got = [float(each.ravel()[0]) for each in (g, g_v, g_c, g_w, g_b, g_x)]
        assert got == pytest.approx(expected)


def test_check_values_of_encoding_and_layers(solution) -> None:
    features, derivatives = solution.positional_encoding(np.array([[0.3, -0.7]]), 2)
    expected = [0.3, -0.7, 0.809017, -0.809017, 0.587785, -0.587785]
    expected += [0.951057, 0.951057, -0.309017, -0.309017]
    np.testing.assert_allclose(features[0], expected, atol=PRINTED)
    expected = [-1.941611, -1.941611, -5.975664, -5.975664]
    np.testing.assert_allclose(derivatives[0, -4:], expected, atol=PRINTED)
    layers = [np.array([[1.0, -1, 2], [0.5, 1, -1]]), np.array([0.0, 0.5, -0.5])]
    layers += [np.array([[1.0, 2], [3, -1], [-2, 1]]), np.array([0.1, -0.1])]
    x, g = np.array([[1.0, 2], [-1, 1]]), np.array([[1.0, 0], [0.5, -1]])
    activations = solution.mlp_forward(layers, x)
    np.testing.assert_allclose(activations[1], [[2, 1.5, 0], [0, 2.5, 0]])
    np.testing.assert_allclose(activations[2], [[6.6, 2.4], [7.6, -2.6]])
    d_layers, d_x = solution.mlp_backward(layers, activations, g)
    np.testing.assert_allclose(d_layers[2], [[2, 0], [2.75, -2.5], [0, 0]])
    np.testing.assert_allclose(d_layers[3], [1.5, -1])
    np.testing.assert_allclose(d_layers[0], [[1, 0.5, 0], [2, 8.5, 0]])
    np.testing.assert_allclose(d_layers[1], [1, 5.5, 0])
    np.testing.assert_allclose(d_x, [[-2, 3.5], [-2.5, 2.5]])
    by_graph, d_x_by_graph = solution.graph_gradients(layers, x, g)
    for mine, theirs in zip([*d_layers, d_x], [*by_graph, d_x_by_graph], strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-14)


def test_check_values_of_distances(solution) -> None:
    u = np.array([[0.2, 0.5, 0.9]])
    edges, weights = np.array([[2.0, 3, 5, 6]]), np.array([[1.0, 0, 3]])
    got = solution.sample_distances(edges, weights, u)[0]
    np.testing.assert_allclose(got, [2.266667, 5.333333, 5.955556], atol=PRINTED)
    got = solution.sample_distances(np.array([[2.0, 6]]), np.ones((1, 1)), u)[0]
    np.testing.assert_allclose(got, [2.266667, 4, 5.866667], atol=PRINTED)
    u[0, 2] = 1 - 2.0**-53
    assert u[0, 2] < 1
    for given in ((edges, weights), (np.array([[2.0, 6]]), np.ones((1, 1)))):
        assert solution.sample_distances(*given, u)[0, 2] == 6


def test_check_values_of_field_loss_and_training(solution) -> None:
    network = small_network(solution)
    p, d = np.array([[0.5, 0, 0.25]]), np.array([[0.6, 0, 0.8]])
    sigma, color, trunk, head = solution.radiance_field(network, p, d)
    np.testing.assert_allclose(trunk[-1], [[0.160657, 0.160657]], atol=PRINTED)
    np.testing.assert_allclose(sigma, [0.776698], atol=PRINTED)
    np.testing.assert_allclose(head[-1], [[0.129426] * 3], atol=PRINTED)
    np.testing.assert_allclose(color, [[0.532311] * 3], atol=PRINTED)
    batch, t = two_rays()
    loss, slopes = solution.loss_and_grad(network, batch, t)
    assert loss == pytest.approx(0.299232, abs=PRINTED)
    np.testing.assert_allclose(slopes["trunk"][-1], [-0.117773, 0.002166], atol=PRINTED)
    np.testing.assert_allclose(slopes["head"][-1], [-0.025854, 0.111422, 0.131033], atol=PRINTED)
    assert slopes["trunk"][0][0, 0] == pytest.approx(-0.000255, abs=PRINTED)
    after, losses = solution.train_nerf(batch, network, 2, np.random.default_rng(0))
    np.testing.assert_allclose(losses, [0.299450, 0.291234], atol=PRINTED)
    np.testing.assert_allclose(after["trunk"][-1], [0.119954, 0.080179], atol=PRINTED)
    np.testing.assert_allclose(after["head"][-1], [0.119969, 0.080041, 0.080040], atol=PRINTED)
    assert all((array == 0.1).all() for layers in network.values() for array in layers)


def test_the_given_derivative_of_the_density_is_right(solution) -> None:
    rng = np.random.default_rng(3)
    network, p, way = solution.make_network(6, 2, rng), rng.uniform(-1, 1, (5, 3)), np.eye(3)
    before = [
        solution.mlp_forward(network["trunk"], solution.positional_encoding(q, solution.BANDS)[0])
        for axis in range(3)
        for q in (p + 1e-6 * way[axis], p - 1e-6 * way[axis])
    ]
    s = np.array([each[-1][:, 0] for each in before]).reshape(3, 2, 5)
    differences = (s[:, 0] - s[:, 1]).T / 2e-6
    np.testing.assert_allclose(solution.density_gradient(network, p), differences, rtol=1e-6)


def test_diagnoses_fit_one_answer_alone(bundle: Bundle, solution) -> None:
    rng = np.random.default_rng(0)
    network, (batch, t) = solution.make_network(8, 4, rng), two_rays()
    right = solution.loss_and_grad(network, batch, t)[1]
    cut = mutant(bundle, "loss_features_cut").loss_and_grad(network, batch, t)[1]
    for mine, theirs in zip(cut["head"], right["head"], strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-15)
    np.testing.assert_allclose(cut["trunk"][-2][:, 0], right["trunk"][-2][:, 0], atol=1e-15)
    assert not cut["trunk"][-2][:, 1:].any()
    there = right["trunk"][0] != 0
    assert np.ptp(cut["trunk"][0][there] / right["trunk"][0][there]) > 0.1
    # Open ReLUs pass what arrives: without the mask the derivatives are right.
    wrong = mutant(bundle, "backward_no_relu")
    layers = [rng.uniform(0.1, 1, shape) for shape in ((3, 4), (4,), (4, 2), (2,))]
    for x, agrees in ((rng.uniform(0.1, 1, (5, 3)), True), (-rng.uniform(0.5, 1, (5, 3)), False)):
        activations, g = solution.mlp_forward(layers, x), rng.uniform(-1, 1, (5, 2))
        mine, theirs = (m.mlp_backward(layers, activations, g)[0] for m in (wrong, solution))
        np.testing.assert_allclose(mine[2], theirs[2])
        assert np.allclose(mine[0], theirs[0]) is agrees


def test_answers_of_the_other_questions(bundle: Bundle, solution) -> None:
    assert solution.positional_encoding(np.zeros((1, 3)), 10)[0].shape[1] == 63
    network = solution.make_network(64, 16, np.random.default_rng(0))
    numbers = sum(array.size for layers in network.values() for array in layers)
    assert numbers == 8180
    assert 8 * numbers / (20**3 * 4 * 8) == pytest.approx(0.25, abs=0.02)
    keys, text = bundle.keys, source(FOLDER)
    assert keys is not None
    omega = 8 * np.pi
    expected = omega * np.cos(omega * 0.26)
    assert keys.derivative_of_the_last_sine(bundle.reference, 4, 0.26) == pytest.approx(expected)
    assert keys.numbers_of_an_mlp(bundle.reference, 27, 32, 3) == 28 * 32 + 33 * 32 + 33 * 3
    got = keys.distance_of_a_number(bundle.reference, 2, 5, 0.6)
    assert got == pytest.approx(3 + 3 * (0.6 * 7 - 2) / 5)
    for question in bundle.questions:
        if question.kind == "generated":
            drawn = draw_question(question, "somebody", text)
            assert "{" not in drawn.text
            answer = getattr(keys, str(question.answer))(bundle.reference, **drawn.values)
            assert abs(answer) > 0.01  # so that a relative tolerance means something


def test_a_wrong_engine_costs_the_check_of_the_graph_alone(bundle: Bundle, monkeypatch) -> None:
    engine = bundle.brought["engine"].replace("(other, self.data)", "(other, other.data)")
    assert engine != bundle.brought["engine"]
    monkeypatch.setitem(bundle.brought, "engine", engine)
    monkeypatch.setattr("course.assignments.support.bundle_of", lambda *_: bundle)
    outcomes = judge(FOLDER, tasks=["12.2"])
    assert lost(outcomes) == {"12.2.graph"}
    assert any("engine.py" in str(each.hint) for each in outcomes)


@pytest.mark.parametrize("capture", [False, True])
def test_the_exploration_runs_and_says_what_it_did(tmp_path: Path, capture: bool) -> None:
    for name in ("explore.py", "nerf.py"):
        shutil.copy(FOLDER / name, tmp_path)
    for name, folder in EARLIER.items():
        shutil.copy(folder / name, tmp_path)
    shutil.copytree(FOLDER / "data", tmp_path / "data")
    order = [sys.executable, "explore.py", "--views", "3", "--pixels", "6", "--steps", "2"]
    order += ["--shown", "12"]
    if capture:
        order += ["--capture", str(small_capture(tmp_path / "photos"))]
    ran = subprocess.run(order, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert "3 photographs of 6 x 6" in ran.stdout
    assert "8180 numbers, 2 steps" in ran.stdout
    assert (tmp_path / "nerf.png").stat().st_size > 5_000
    assert ("dB on the held-out photograph" in ran.stdout) is capture


def small_capture(folder: Path) -> Path:
    """Three photographs in the form of NeRF tools."""
    folder.mkdir()
    pose, frames = np.eye(4), []
    for k in range(3):
        pose[:3, 3] = 0, 0, 3 + 0.1 * k
        Image.new("RGB", (16, 16), (40 * k, 90, 200)).save(folder / f"{k}.png")
        frames.append({"file_path": f"{k}.png", "transform_matrix": pose.tolist()})
    said = {"camera_angle_x": 0.8, "frames": frames}
    (folder / "transforms.json").write_text(json.dumps(said), encoding="utf-8")
    return folder
