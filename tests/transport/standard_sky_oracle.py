"""Balls under a sky, by quadrature: the second implementation of `standard_oracle`, goes on.

The ground's light is a mean over the cosine's distribution, the lobe's one over that of facets:

    integral of f L <n,wi> dwi = mean over h of  f L <n,wi> 4 <wo,h> / (D(h) <n,h>)
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.transport.standard_oracle import (
    RIGHT,
    Array,
    Balls,
    Form,
    dot,
    facets,
    free,
    ground,
    lobe,
    nearest,
    rays,
    unit,
)


def sky_radiance(texels: Array, w: Array) -> Array:
    """A picture of all directions (H, 2 H, 3): upper edge +Y, middle +Z, to its right -X."""
    height, width = texels.shape[:2]
    column = (0.5 + np.arctan2(-w[..., 0], w[..., 2]) / (2 * np.pi)) * width - 0.5
    row = np.arccos(np.clip(w[..., 1], -1, 1)) / np.pi * height - 0.5
    c, r = np.floor(column).astype(int), np.floor(row).astype(int)
    g, s = (column - c)[..., None], (row - r)[..., None]

    def texel(r: Array, c: Array) -> Array:
        return texels[np.clip(r, 0, height - 1), c % width]

    upper = texel(r, c) * (1 - g) + texel(r, c + 1) * g
    lower = texel(r + 1, c) * (1 - g) + texel(r + 1, c + 1) * g
    return upper * (1 - s) + lower * s


def nodes(count: int) -> tuple[Array, Array, Array]:
    """u in (0, 1), angles and weights, which add up to 1."""
    x, weight = np.polynomial.legendre.leggauss(count)
    phi = 2 * np.pi * (np.arange(2 * count) + 0.5) / (2 * count)
    u, angle = (part.ravel() for part in np.meshgrid(0.5 * (x + 1), phi, indexing="ij"))
    return u, angle, np.repeat(0.5 * weight, 2 * count) / (2 * count)


def around(n: Array, cosine: Array, phi: Array) -> Array:
    """Unit vectors (P, M, 3) around n (P, 3); cosine (P, M) or (M,)."""
    helper = np.where(np.abs(n[:, :1]) < 0.5, [1.0, 0, 0], [0, 1.0, 0])
    x = unit(np.cross(helper, n))
    y = np.cross(n, x)
    s = np.sqrt(1 - cosine**2)
    a, b = s * np.cos(phi), s * np.sin(phi)
    return (
        a[..., None] * x[:, None]
        + b[..., None] * y[:, None]
        + (0 * a + cosine)[..., None] * n[:, None]
    )


def reflected(
    balls: Balls, texels: Array, x: Array, n: Array, wo: Array, k: Array, count: int, form: Form
) -> Array:
    """Radiance (P, 3) that leaves points x towards wo."""
    u, phi, weight = nodes(count)
    every = np.broadcast_to(k[:, None], (len(k), len(u)))
    far, N, WO = (np.broadcast_to(part[:, None], (*every.shape, 3)) for part in (x, n, wo))
    wi = around(n, np.sqrt(1 - u), phi)
    open_sky = free(balls, every, far, wi)[..., None] * sky_radiance(texels, wi)
    below = np.pi * ground(balls, k, form) * np.einsum("m,pmc->pc", weight, open_sky)

    a = balls.roughness[every] ** 2  # where nodes stand is no part of the formula
    nh = np.sqrt((1 - u) / (1 - u + a**2 * u))
    h = around(n, nh, phi)
    vh = dot(WO, h)
    wi = 2 * vh[..., None] * h - WO
    nl = dot(N, wi)
    good = (vh > 0) & (nl > 1e-9)
    wi = np.where(good[..., None], wi, N)
    share = np.where(good & free(balls, every, far, wi), nl * 4 * vh / (facets(a, nh) * nh), 0)
    light = lobe(balls, every, N, WO, wi, form) * sky_radiance(texels, wi)
    return below + np.einsum("m,pm,pmc->pc", weight, share, light)


def sky_picture(
    balls: Balls, texels: Array, camera: Any, *, count: int, form: Form = RIGHT
) -> tuple[Array, Array]:
    """Means over pixels (H, W, 3), and which pixels show nothing but one ball, not at its rim.

    Four points of Gauss stand for a pixel, which is exact where radiance bends little within it.
    """
    where = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
    corners = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])
    points = np.concatenate([np.stack(np.meshgrid(where, where), -1).reshape(-1, 2), corners])
    column, row = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    at = np.stack([column, row], -1).reshape(-1, 1, 2) + points
    o, d = rays(camera, at[..., 0], at[..., 1])
    k, t = nearest(balls, o, d)
    x = o + np.where(np.isfinite(t), t, 0)[..., None] * d
    n = unit(x - balls.centers[k])
    inner = (np.isfinite(t) & (k == k[:, :1]) & (dot(n, -d) > 0.5)).all(axis=1)
    image = np.zeros((len(at), 3))
    for point in range(4):
        image[inner] += 0.25 * reflected(
            balls,
            texels,
            x[inner, point],
            n[inner, point],
            -d[inner, point],
            k[inner, point],
            count,
            form,
        )
    shape = camera.height, camera.width
    return image.reshape(*shape, 3), inner.reshape(shape)
