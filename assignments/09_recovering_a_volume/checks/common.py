"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance

# Evidence: worst of the solution and three alternatives, against the nearest of all named wrong
# solutions.
EXACT = Tolerance(
    1e-11, "right ones differ by at most 1e-15, the nearest wrong one (psnr_capped) by 6e-10"
)
GATE = Tolerance(1e-6, "finite differences leave 2e-10, the nearest wrong one (mse_root) 0.2")


def looking(place, roll=0.0):
    """The pose of a camera at a place that looks at the origin."""
    forward = -place / np.linalg.norm(place)
    side = np.cross(forward, [0.3, 1.0, 0.2])
    side /= np.linalg.norm(side)
    down = np.cross(forward, side)
    c, s = np.cos(roll), np.sin(roll)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([c * side + s * down, c * down - s * side, forward], axis=1)
    pose[:3, 3] = place
    return pose


def around(count, distance=3.2, turn=0.0, roll=0.0):
    """Poses (count, 4, 4) of cameras all around the origin."""
    height = 1 - (np.arange(count) + 0.5) * 2 / count
    phi = np.arange(count) * 2.399963 + turn
    ring = np.sqrt(1 - height**2)
    places = np.stack([ring * np.cos(phi), height, ring * np.sin(phi)], axis=1)
    return np.stack([looking(distance * place, roll) for place in places])


def views_of(pictures, poses, background, focal=None):
    """Views of the box from -1 to 1, which fits into each picture."""
    width = pictures.shape[2]
    return {
        "pictures": pictures,
        "world_from_camera": poses,
        "focal": focal or 1.25 * width,
        "low": np.full(3, -1.0),
        "high": np.full(3, 1.0),
        "background": background,
    }


def random_views(t, count=2, rows=3, columns=4):
    """Views of random colors by cameras all around."""
    pictures = t.rng.uniform(0.0, 1.0, (count, rows, columns, 3))
    poses = around(count, turn=t.rng.uniform(0, 6), roll=t.rng.uniform(-0.5, 0.5))
    return views_of(pictures, poses, t.rng.uniform(0.0, 0.5, 3))


def batch(n):
    """Result of `ray_batch`."""
    return Items(
        Array((n, 3)), Array((n, 3)), Array((n, 3)), names=("origins", "directions", "truth")
    )


def loss_and_slope(shape):
    """What `mse_and_cotangent` and `tv_loss_adjoint` return."""
    return Items(Number(), Array(shape), names=("loss", "derivative"))


def rough(t, grid, eps):
    """`tv_loss_adjoint` of the submission."""
    return t.call("tv_loss_adjoint", grid, eps, returns=loss_and_slope(grid.shape))


EARLIER = ("ray_batch", "mse_and_cotangent", "render_rays", "render_adjoint")
