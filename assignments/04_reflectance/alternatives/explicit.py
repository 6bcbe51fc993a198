"""Whole arrays with angles and Lambda; samples by projected half disks instead of a cap."""

import numpy as np
from reflectance import above, half_vector, hemisphere


def furnace(f, cosines):
    wi, solid = hemisphere()
    K, M = len(cosines), len(wi)
    viewers = np.stack([np.sqrt(1 - cosines**2), np.zeros(K), cosines], axis=1)
    values = f(np.repeat(viewers, M, axis=0), np.tile(wi, (K, 1))).reshape(K, M, -1)
    return np.einsum("m,m,kmc->kc", solid, wi[:, 2], values)


def _tan2(w):
    return np.where(w[:, 2] > 0, (w[:, 0] ** 2 + w[:, 1] ** 2) / np.maximum(w[:, 2], 1e-30) ** 2, 0)


def _parts(wo, wi, roughness):
    """D, Lambda of both sides, and alpha; of use above the surface alone."""
    alpha = roughness**2
    h = half_vector(wo, wi)
    z = np.maximum(h[:, 2], 1e-30)
    D = alpha**2 / (np.pi * z**4 * (alpha**2 + _tan2(h)) ** 2)
    return D, *((np.sqrt(1 + alpha**2 * _tan2(w)) - 1) / 2 for w in (wo, wi)), alpha, h


def ggx_lobe(wo, wi, roughness):
    D, of_o, of_i, _, _ = _parts(wo, wi, roughness)
    good = above(wo, wi)
    cosines = np.where(good, 4 * wo[:, 2] * wi[:, 2], 1)
    return np.where(good, D / (1 + of_o + of_i) / cosines, 0)


def ggx_pdf(wo, wi, roughness):
    D, of_o, _, _, _ = _parts(wo, wi, roughness)
    good = above(wo, wi)
    return np.where(good, D / (1 + of_o) / (4 * np.where(good, wo[:, 2], 1)), 0)


def sample_ggx(wo, roughness, u2):
    a = (roughness**2)[:, None] * [1.0, 1.0, 0.0] + [0.0, 0.0, 1.0]
    v = wo * a
    v = v / np.linalg.norm(v, axis=1)[:, None]
    side = np.hypot(v[:, 0], v[:, 1])
    flat = side < 1e-12
    t1 = np.stack([np.where(flat, 1, -v[:, 1]), np.where(flat, 0, v[:, 0]), 0 * side], axis=1)
    t1 = t1 / np.where(flat, 1, side)[:, None]
    t2 = np.cross(v, t1)
    radius, angle = np.sqrt(u2[:, 0]), 2 * np.pi * u2[:, 1]
    p, q = radius * np.cos(angle), radius * np.sin(angle)
    s = (1 + v[:, 2]) / 2
    q = (1 - s) * np.sqrt(1 - p**2) + s * q
    up = np.sqrt(np.maximum(1 - p**2 - q**2, 0))
    n = p[:, None] * t1 + q[:, None] * t2 + up[:, None] * v
    n = n * a
    n[:, 2] = np.maximum(n[:, 2], 1e-15)
    n = n / np.linalg.norm(n, axis=1)[:, None]
    return 2 * np.einsum("nk,nk->n", wo, n)[:, None] * n - wo


def gltf(wo, wi, base_color, metalness, roughness):
    ramp = (1 - np.einsum("nk,nk->n", wo, half_vector(wo, wi)))[:, None] ** 5
    lobe = ggx_lobe(wo, wi, roughness)[:, None]
    good = above(wo, wi)[:, None]
    ground = base_color * (0.96 / np.pi) * (1 - ramp)
    dielectric = np.where(good, ground + (0.04 + 0.96 * ramp) * lobe, 0)
    metal = (base_color * (1 - ramp) + ramp) * lobe
    return dielectric + metalness[:, None] * (metal - dielectric)


def gltf_backward(wo, wi, base_color, metalness, roughness, d_f):
    D, of_o, of_i, alpha, h = _parts(wo, wi, roughness)
    good, m = above(wo, wi), metalness[:, None]
    g = np.where(good[:, None], d_f, 0)
    ramp = (1 - np.einsum("nk,nk->n", wo, h))[:, None] ** 5
    cosines = np.where(good, 4 * wo[:, 2] * wi[:, 2], 1)
    G2 = 1 / (1 + of_o + of_i)
    lobe = (D * G2 / cosines)[:, None]
    F = 0.04 + 0.96 * ramp
    metal = base_color * (1 - ramp) + ramp
    d_color = g * ((1 - m) * (1 - F) / np.pi + m * (1 - ramp) * lobe)
    d_m = np.einsum("nc,nc->n", g, (metal - F) * lobe - (1 - F) * base_color / np.pi)
    d_lobe = np.einsum("nc,nc->n", g, (1 - m) * F + m * metal)
    t = _tan2(h)
    d_D = D * (2 / alpha - 4 * alpha / (alpha**2 + t))
    d_G2 = 0
    for w in (wo, wi):
        d_G2 = d_G2 - G2**2 * alpha * _tan2(w) / (2 * np.sqrt(1 + alpha**2 * _tan2(w)))
    d_alpha = d_lobe * (d_D * G2 + D * d_G2) / cosines
    return d_color, d_m, np.where(good, d_alpha * 2 * roughness, 0)
