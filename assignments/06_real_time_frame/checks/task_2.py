"""Task 06.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import FAITHFUL, pose_of, rays_of

check = checks_for(calls=("shadow_test",), tolerance=FAITHFUL)


def tested(t, points, normals, depth, focal, pose, bias):
    """`shadow_test` of the submission."""
    args = points, normals, depth, focal, pose, bias
    return t.call("shadow_test", *args, returns=Array((len(points),)))


def placed(pose, focal, size, u, v, z):
    """Points (N, 3) of the world at texels (u, v) of the light's camera, and depths z."""
    flat = np.stack([(u - size / 2) / focal * z, (v - size / 2) / focal * z, z], axis=1)
    return flat @ pose[:, :3].T + pose[:, 3]


@check(
    "06.2.texels",
    points=4,
    hint="handout, equations (10) and (11): compare with nine texels, then take the mean of the "
    "nine answers",
    sole="which texels are compared, with closed forms",
)
def nine_comparisons(t):
    """The fraction of nine texels that are not in front of the point; missing ones count as lit."""
    size, pose, focal = 9, pose_of(t.rng), t.rng.uniform(6.0, 12.0)
    depth = t.rng.uniform(2.0, 4.0, (size, size))
    depth[t.rng.random((size, size)) < 0.2] = np.inf
    wide = np.full((size + 4, size + 4), np.inf)
    wide[2:-2, 2:-2] = depth
    v, u = np.mgrid[-1 : size + 1, -1 : size + 1].reshape(2, -1)
    z = t.rng.uniform(2.0, 4.0, len(u))
    inner = t.rng.uniform(0.05, 0.95, (2, len(u)))
    right = [
        np.mean(wide[r + 1 : r + 4, c + 1 : c + 4] >= d) for r, c, d in zip(v, u, z, strict=True)
    ]
    points = placed(pose, focal, size, u + inner[0], v + inner[1], z)
    lit = tested(t, points, unit_vectors(t.rng, len(u)), depth, focal, pose, 0.0)
    t.close("part of the light", lit, np.array(right), reveal=True)
    far = placed(pose, focal, size, 40.0 * u + 80.0, 0.5 * v, z)
    far = np.concatenate([far, placed(pose, focal, size, 0.5 * u, -40.0 * v - 80.0, z)])
    lit = tested(t, far, np.tile(pose[:, 0], (len(far), 1)), depth, focal, pose, 0.0)
    t.close("part of the light, far beyond the map", lit, np.ones(len(far)), reveal=True)
    still, near = np.eye(3, 4), np.array([[0.25, 0.25, 2.0], [-0.5, 0.5, 2.0]])
    lit = tested(t, near, near / 4, np.full((4, 4), 2.0), 4.0, still, 0.0)
    t.require(bool((lit == 1).all()), "a point as far away as its texels is lit")


@check(
    "06.2.bias",
    points=3,
    hint="handout, equation (9): points move along their normals, out of the surface",
    sole="the bias, in a case with a closed form",
)
def a_plane_does_not_shade_itself(t):
    """With a bias of 2.2 texels a slanted plane is lit; just behind it everything is dark."""
    size, focal = 40, 2e5
    z = 1e4
    for slant in (0.0, 0.6, 1.1):
        pose, texel = pose_of(t.rng), z / focal
        turn = t.rng.uniform(0, 2 * np.pi)
        n = np.array([np.sin(slant) * np.cos(turn), np.sin(slant) * np.sin(turn), -np.cos(slant)])
        rays = rays_of(size, size, focal)
        depth = z * n[2] / (rays @ n)
        u, v = t.rng.uniform(8.0, size - 8.0, (2, 60))
        flat = np.stack([(u - size / 2) / focal, (v - size / 2) / focal, np.ones(60)], axis=1)
        points = (flat * (z * n[2] / (flat @ n))[:, None]) @ pose[:, :3].T + pose[:, 3]
        normals = np.tile(pose[:, :3] @ n, (60, 1))
        lit = tested(t, points, normals, depth, focal, pose, 2.2 * texel)
        t.close(f"on a plane at {np.degrees(slant):.0f} degrees", lit, np.ones(60), reveal=True)
        below = points - 5.0 * texel * normals
        lit = tested(t, below, normals, depth, focal, pose, 2.2 * texel)
        t.require(
            not lit.any(),
            f"five texels behind a plane at {np.degrees(slant):.0f} degrees it is dark",
        )


@check(
    "06.2.traced",
    points=2,
    needs=("rasterize", "hit_sphere", "hit_triangle"),
    hint="the experiment also uses your rasterize, and your hit_sphere and hit_triangle of 05",
    sole="the technique against the truth",
)
def shadows_are_those_of_rays(t):
    """In the scene, less than 2 % of pixels off the edges of shadows differ from traced ones."""
    shape = 50, 80
    spec = Items(*(Array(shape) for _ in range(3)), names=("lit", "traced", "alike"))
    lit, traced, alike = t.call("adapters.shadows", *shape, 256, returns=spec)
    around = (traced, *(np.roll(traced, by, axis) for by in (-1, 1) for axis in (0, 1)))
    even = (np.min(around, axis=0) == np.max(around, axis=0)) & (alike > 0.1)
    dark = even & (traced == 0)
    t.require(int(even.sum()) > 2000, "more than 2000 pixels face the sun, off edges of shadows")
    t.require(int(dark.sum()) > 30, "more than 30 of them are in the shadow of something else")
    # Solution: 0.3 % and none; a bias of 0: a third.
    for name, where, most in (("off the edges of shadows", even, 2), ("in shadow", dark, 10)):
        wrong = 100 * float((np.abs(lit - traced)[where] > 0.5).mean())
        said = f"{wrong:.1f} % of pixels {name} differ from traced ones: threshold {most} %"
        t.require(wrong < most, said)
