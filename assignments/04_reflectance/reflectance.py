"""Reflectance models (BRDFs): from Phong's highlight to the glTF material.

Directions are unit vectors in the frame of the surface, whose normal is +z. wo points to the
viewer, wi to the light. A BRDF f(wo, wi), in 1/sr, does not contain the cosine, and is 0 unless
both directions lie above the surface. N pairs of directions are two arrays (N, 3); parameters are
arrays of N, too, one number for each pair. C is the number of color channels.

Your tasks are six functions, one section of the handout each; `photograd course check 04` tells
how far you are. The other functions are given and stay as they are. All numbers are float64.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Numbers = Annotated[np.ndarray, "N"]
Directions = Annotated[np.ndarray, "N 3"]  # unit vectors
Colors = Annotated[np.ndarray, "N 3"]
Albedos = Annotated[np.ndarray, "K C"]
Pairs = Annotated[np.ndarray, "N 2"]
Model = Callable[[Directions, Directions], Colors]

# Geometry ----------------------------------------------------------------------------------------


def above(wo, wi):
    """Whether both directions of each pair lie above the surface: (N,) of bool."""
    return (wo[:, 2] > 0) & (wi[:, 2] > 0)


def half_vector(wo, wi):
    """Unit vectors (N, 3) halfway between wo and wi; zeros where these are opposite."""
    sums = wo + wi
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-300)


def stretched(w, alpha):
    """Lengths (N,) of directions (N, 3) with x and y scaled by alpha (N,)."""
    return np.sqrt(alpha**2 * (w[:, 0] ** 2 + w[:, 1] ** 2) + w[:, 2] ** 2)


def hemisphere(heights=48, turns=96):
    """Directions (M, 3) above the surface, and their quadrature weights (M,), solid angles.

    The integral of g over the hemisphere is approximately the sum of weights times g(directions),
    more accurately for smooth g. The weights sum to 2 pi. Nodes are denser near the horizon.
    """
    nodes, weights = np.polynomial.legendre.leggauss(heights)
    root = (nodes + 1) / 2
    z, phi = np.meshgrid(root**2, (np.arange(turns) + 0.5) * (2 * np.pi / turns), indexing="ij")
    r = np.sqrt(1 - z * z)
    wi = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).reshape(-1, 3)
    return wi, np.repeat(root * weights * (2 * np.pi / turns), turns)


def ball(size):
    """A ball seen from far away: where it is in an image, and the frame of each of its pixels.

    Returns:
        a mask (size, size), and for its N pixels, row by row, matrices (N, 3, 3) that take
        directions of the camera (x right, y up, z to the camera) into the frame of the surface.
    """
    x = (np.arange(size) + 0.5) / size * 2.06 - 1.03
    right, up = np.meshgrid(x, -x)
    inside = right**2 + up**2 < 0.998
    z = np.sqrt(np.maximum(1 - right**2 - up**2, 0))
    normal = np.stack([right, up, z], axis=-1)[inside]
    tangent = np.cross([0.0, 1.0, 0.0], normal)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    return inside, np.stack([tangent, np.cross(normal, tangent), normal], axis=1)


# Models to measure --------------------------------------------------------------------------------


def _colored(value, color, wo, wi):
    """value (N,) times a color, (3,) or one number, above the surface: (N, 3)."""
    return np.where(above(wo, wi), value, 0.0)[:, None] * (color * np.ones(3))


def lambert(wo, wi, albedo):
    """A matte surface: equally bright from everywhere (N, 3)."""
    return _colored(np.full(len(wo), 1 / np.pi), albedo, wo, wi)


def phong(wo, wi, specular, exponent):
    """Phong's highlight, in the form of section 0 (N, 3)."""
    c = np.maximum(wo[:, 2] * wi[:, 2] - wo[:, 0] * wi[:, 0] - wo[:, 1] * wi[:, 1], 0)
    return _colored((exponent + 2) / (2 * np.pi) * c**exponent, specular, wo, wi)


def schlick(f0, cos_oh):
    """Schlick's Fresnel reflectance: f0 at normal incidence, 1 at grazing angles.

    cos_oh is the cosine <wo, wh> between a direction and the normal of the facet.
    """
    return f0 + (1 - f0) * (1 - cos_oh) ** 5


def burley_diffuse(wo, wi, albedo, roughness):
    """Burley's diffuse model, fitted to measurements (N, 3); roughness: one number, 0 to 1."""
    wh = half_vector(wo, wi)
    f90 = 0.5 + 2 * roughness * np.sum(wi * wh, axis=1) ** 2
    towards, from_light = (1 + (f90 - 1) * (1 - w[:, 2]) ** 5 for w in (wo, wi))
    return _colored(towards * from_light / np.pi, albedo, wo, wi)


def cook_torrance(wo, wi, f0, rms_slope, printed=False):
    """Cook and Torrance's metal: Beckmann's distribution, V-groove masking (N, 3).

    rms_slope is the root mean square slope of the facets: its roughness. With `printed` the
    constants are those that the paper of 1982 prints.
    """
    up = above(wo, wi)
    o, i = (np.where(up[:, None], w, [0.0, 0.0, 1.0]) for w in (wo, wi))
    wh = half_vector(o, i)
    z2, seen = wh[:, 2] ** 2, np.sum(o * wh, axis=1)
    D = np.exp((1 - 1 / z2) / rms_slope**2) / (rms_slope**2 * z2**2)
    G = np.minimum(1, 2 * wh[:, 2] * np.minimum(o[:, 2], i[:, 2]) / seen)
    constants = np.pi if printed else 4 * np.pi
    f = schlick(f0, seen) * D * G / (constants * o[:, 2] * i[:, 2])
    return _colored(f, 1.0, wo, wi)


# Your tasks ---------------------------------------------------------------------------------------


def furnace(f: Model, cosines: Numbers) -> Albedos:
    """The furnace test: directional albedo, the reflected fraction of uniform light.

    Args:
        f: a function of wo (M, 3) and wi (M, 3) that returns (M, C), a BRDF without the cosine.
        cosines: (K,), for K viewers: cosine between viewer and normal, above 0 and up to 1.

    Returns:
        (K, C), the albedo for each viewer and channel, with the quadrature of `hemisphere()`;
        handout equation (5). The viewers are in the plane y = 0, on the side of +x.
    """
    # >>> solution 04.1
    wi, solid_angles = hemisphere()
    rows = []
    for z in cosines:
        wo = np.tile([np.sqrt(1 - z * z), 0.0, z], (len(wi), 1))
        rows.append((solid_angles * wi[:, 2]) @ f(wo, wi))
    return np.array(rows)
    # <<< solution


def ggx_lobe(wo: Directions, wi: Directions, roughness: Numbers) -> Numbers:
    """The GGX lobe of a microfacet model without the Fresnel factor: D V of the handout.

    Args:
        wo, wi: (N, 3).
        roughness: (N,), 0.045 to 1.

    Returns:
        (N,); handout equations (6) to (10). 0 unless both directions are above the surface.
    """
    # >>> solution 04.2
    up = above(wo, wi)
    o, i, alpha = wo[up], wi[up], roughness[up] ** 2
    h = half_vector(o, i)
    q = (h[:, 0] ** 2 + h[:, 1] ** 2) / alpha**2 + h[:, 2] ** 2
    L = stretched(o, alpha) * i[:, 2] + stretched(i, alpha) * o[:, 2]
    lobe = np.zeros(len(wo))
    lobe[up] = 1 / (2 * np.pi * alpha**2 * q**2 * L)
    return lobe
    # <<< solution


def ggx_pdf(wo: Directions, wi: Directions, roughness: Numbers) -> Numbers:
    """The density of `sample_ggx` per solid angle, above the surface.

    Args:
        wo, wi: (N, 3).
        roughness: (N,), 0.045 to 1.

    Returns:
        (N,), in 1/sr; handout equations (11) to (13). 0 unless both directions are above the
        surface.
    """
    # >>> solution 04.3
    up = above(wo, wi)
    o, i, alpha = wo[up], wi[up], roughness[up] ** 2
    length = stretched(o, alpha)
    L = length * i[:, 2] + stretched(i, alpha) * o[:, 2]
    pdf = np.zeros(len(wo))
    pdf[up] = ggx_lobe(o, i, roughness[up]) * L / (o[:, 2] + length)
    return pdf
    # <<< solution


def sample_ggx(wo: Directions, roughness: Numbers, u2: Pairs) -> Directions:
    """Sample a visible normal of GGX for wo, and reflect wo at it.

    Args:
        wo: (N, 3), above the surface.
        roughness: (N,), 0.045 to 1.
        u2: (N, 2), uniform in [0, 1). Direction n depends on row n of wo, roughness and u2 only;
            use no other random numbers.

    Returns:
        (N, 3), unit vectors, whose density above the surface is `ggx_pdf`; some may lie below
        it. Handout equations (14) to (16).
    """
    # >>> solution 04.4
    stretch = np.stack([roughness**2, roughness**2, np.ones(len(wo))], axis=1)
    viewer = wo * stretch
    viewer = viewer / np.linalg.norm(viewer, axis=1, keepdims=True)
    z = 1 - u2[:, 0] * (1 + viewer[:, 2])
    phi = 2 * np.pi * u2[:, 1]
    r = np.sqrt(1 - z * z)
    cap = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)
    h = (cap + viewer) * stretch
    h = h / np.linalg.norm(h, axis=1, keepdims=True)
    return 2 * np.sum(wo * h, axis=1, keepdims=True) * h - wo
    # <<< solution


def gltf(
    wo: Directions, wi: Directions, base_color: Colors, metalness: Numbers, roughness: Numbers
) -> Colors:
    """The glTF material: a diffuse base layer under a specular coating, a metal, or a blend.

    Args:
        wo, wi: (N, 3).
        base_color: (N, 3), 0 to 1.
        metalness: (N,), 0 to 1.
        roughness: (N,), 0.045 to 1.

    Returns:
        (N, 3); handout equations (17) to (20). 0 unless both directions are above the surface.
    """
    # >>> solution 04.5
    lobe = ggx_lobe(wo, wi, roughness)[:, None]
    cos = np.sum(wo * half_vector(wo, wi), axis=1)[:, None]
    F = schlick(0.04, cos)
    diffuse = above(wo, wi)[:, None] * base_color / np.pi
    m = metalness[:, None]
    return (1 - m) * ((1 - F) * diffuse + F * lobe) + m * schlick(base_color, cos) * lobe
    # <<< solution


def gltf_backward(
    wo: Directions,
    wi: Directions,
    base_color: Colors,
    metalness: Numbers,
    roughness: Numbers,
    d_f: Colors,
) -> tuple[Colors, Numbers, Numbers]:
    """The adjoint of `gltf` with respect to its parameters; directions are held fixed.

    Args:
        wo, wi, base_color, metalness, roughness: as for `gltf`.
        d_f: (N, 3), the derivative of some loss with respect to the result of `gltf`.

    Returns:
        (d_base_color (N, 3), d_metalness (N,), d_roughness (N,)); handout equations (21) to (25).
    """
    # >>> solution 04.6
    lobe = ggx_lobe(wo, wi, roughness)
    h = half_vector(wo, wi)
    cos = np.sum(wo * h, axis=1)
    F, m = schlick(0.04, cos), metalness
    by_color = above(wo, wi) * (1 - m) * (1 - F) / np.pi + m * (1 - schlick(0.0, cos)) * lobe
    metal = gltf(wo, wi, base_color, np.ones(len(wo)), roughness)
    dielectric = gltf(wo, wi, base_color, np.zeros(len(wo)), roughness)
    mirrored = ((1 - m) * F)[:, None] + m[:, None] * schlick(base_color, cos[:, None])
    up = above(wo, wi)
    o, i, h, alpha = wo[up], wi[up], h[up], roughness[up] ** 2
    flat_o, flat_i, flat_h = (w[:, 0] ** 2 + w[:, 1] ** 2 for w in (o, i, h))
    q = flat_h / alpha**2 + h[:, 2] ** 2
    long_o, long_i = stretched(o, alpha), stretched(i, alpha)
    L = long_o * i[:, 2] + long_i * o[:, 2]
    of_D = (4 * flat_h / (alpha**2 * q) - 2) / alpha
    of_V = alpha * (flat_o * i[:, 2] / long_o + flat_i * o[:, 2] / long_i) / L
    d_roughness = np.zeros(len(wo))
    d_roughness[up] = (np.sum(d_f * mirrored, axis=1) * lobe * 2 * roughness)[up] * (of_D - of_V)
    return d_f * by_color[:, None], np.sum(d_f * (metal - dielectric), axis=1), d_roughness
    # <<< solution
