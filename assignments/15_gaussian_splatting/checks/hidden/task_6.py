"""Task 15.6, hidden checks."""

import numpy as np
from photograd_course.grading import Array, CheckFailed, Subject, checks_for

from ..common import EARLIER, EXACT, SCENE, some_camera, some_scene
from ..task_6 import denser

check = checks_for(calls=("densify",), visibility="hidden")


class Changed:
    """Five arrays of a scene and the rows that they come from; how many is not known beforehand."""

    def require(self, value, where):
        if not isinstance(value, list) or not all(isinstance(e, np.ndarray) for e in value):
            raise CheckFailed(f"{where}: expected a scene and the rows that its own come from")


def crowded(t, n):
    """Arguments of `densify`, with a seed."""
    scene = some_scene(t.rng, some_camera(t.rng), n, size=0.05)
    return scene, t.rng.exponential(0.003, n), 7, 1000


def changed(reference, scene, grad2d, seed, max_count):
    """What `adapters.densify` returns for the solution."""
    after, source = reference.densify(scene, grad2d, np.random.default_rng(seed), max_count)
    return [*(after[name] for name in SCENE), source.astype(float)]


@check(
    "15.6.hidden",
    points=1,
    needs=("covariance",),
    tolerance=EXACT,
    sole="the same mistakes at unseen scenes",
    battery=[Subject("adapters.densify", crowded, lambda _: Changed(), right=changed)],
)
def random_changes(t):
    """Random scenes become what they should."""
    for max_count in (1000, 45):
        scene = {
            "means": t.rng.normal(size=(40, 3)),
            "quats": t.rng.normal(size=(40, 4)),
            "log_scales": np.log(0.05) + t.rng.normal(size=(40, 3)) / 3,
            "opacity_logits": t.rng.uniform(-6.0, 6.0, 40),
            "colors": t.rng.normal(size=(40, 3)),
        }
        # Opacities of 0.0202 and 0.0198, on both sides of FAINT.
        scene["opacity_logits"][:2] = np.log([0.0202 / 0.9798, 0.0198 / 0.9802])
        grad2d, seed = t.rng.exponential(0.003, 40), int(t.rng.integers(1 << 20))
        grad2d = np.array([0.001, 0.003, 0.006])[np.digitize(grad2d, [0.0015, 0.004])]
        given = np.random.default_rng(seed)
        right, source = t.reference.densify(scene, grad2d, given, max_count)
        got, told = denser(t, scene, grad2d, seed, max_count, len(source))
        for name in SCENE:
            t.close(name, got[name], right[name])
        t.close("source", told, source)


def striped_picture(size):
    """What no four Gaussians can show: stripes and a disc; (size, size, 3)."""
    y, x = np.mgrid[0:size, 0:size] / size
    stripes = 0.5 + 0.5 * np.sign(np.sin(2 * np.pi * 2 * (x + 0.3 * y)))
    disc = np.hypot(x - 0.6, y - 0.4) < 0.25
    return np.where(disc[..., None], [0.9, 0.3, 0.1], stripes[..., None] * [0.2, 0.6, 0.9])


@check(
    "15.6.gain",
    points=4,
    needs=(*EARLIER, "render"),
    seconds=60.0,
    sole="the whole: what more Gaussians are good for",
)
def denser_is_better(t):
    """Stripes that four Gaussians cannot show are at least 1 dB better with up to forty."""
    size = 16
    camera = {
        "camera_from_world": np.eye(4)[:3],
        "focal": np.full(2, 16.0),
        "center": np.full(2, 8.0),
        "width": size,
        "height": size,
    }
    places = np.array([[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]])
    views, gains = [[camera, striped_picture(size)]], []
    for _ in range(2):
        start = {
            "means": np.concatenate([places, np.full((4, 1), 2.0)], axis=1)
            + t.rng.uniform(-0.1, 0.1, (4, 3)),
            "log_scales": np.full((4, 3), np.log(0.25)),
            "quats": np.tile([1.0, 0, 0, 0], (4, 1)),
            "opacity_logits": np.zeros(4),
            "colors": np.full((4, 3), 0.5),
        }
        given, losses = (start, views, 120, int(t.rng.integers(1 << 20)), np.zeros(3)), []
        for max_count in (0, 40):
            found = t.call("adapters.fitted", *given, max_count, returns=Array((120,)))
            losses.append(max(float(found[-5:].mean()), 1e-30))
        gains.append(10 * np.log10(losses[0] / losses[1]))
        t.require(losses[1] < 0.5 * found[0], "the fit hardly improves the picture")
    gain = np.mean(gains)
    t.require(gain >= 1.0, f"with densify the fit is {gain:.1f} dB better, threshold 1 dB")
