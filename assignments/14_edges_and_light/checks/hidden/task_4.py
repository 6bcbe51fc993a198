"""Task 14.4, hidden checks."""

from photograd_course.grading import Items, Subject, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import corner_scene, material_spec, rays_down, replayed

check = checks_for(calls=("replay_backward",), visibility="hidden")

REPLAYED = Tolerance(1e-6, "right ones differ by 1e-13, wrong ones by 1e-3 or more")


def arguments(t, n):
    """Arguments of `replay_backward` for n rays."""
    scene, rays, seed = corner_scene(t.rng), rays_down(t.rng, n), n
    radiance = t.reference.path_radiance(scene, *rays, 3, seed)
    return scene, *rays, 3, seed, radiance, random_cotangent(t.rng, (n, 3))


@check(
    "14.4.hidden",
    points=2,
    tolerance=REPLAYED,
    sole="unseen scenes, deeper paths",
    battery=[
        Subject("replay_backward", arguments, lambda _: Items(*material_spec({"matte": range(4)})))
    ],
)
def unseen_scenes(t):
    """A corner at depth 2 and 5, compared with the solution."""
    for depth in (2, 5):
        scene, rays = corner_scene(t.rng), rays_down(t.rng, 30)
        d, seed = random_cotangent(t.rng, (30, 3)), int(t.rng.integers(10**6))
        radiance = t.reference.path_radiance(scene, *rays, depth, seed)
        right = t.reference.replay_backward(scene, *rays, depth, seed, radiance, d)
        got = replayed(t, scene, rays, depth, seed, d)
        t.close("d_base_color", got["base_color"], right[0])
        t.close("d_roughness", got["roughness"], right[1])
