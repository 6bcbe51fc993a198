"""Written from the handout's equations, in their order and with their letters."""

import numpy as np
from reflectance import above, half_vector, hemisphere, schlick, stretched


def furnace(f, cosines):
    wi, omega = hemisphere()
    albedos = []
    for mu in cosines:
        wo = np.zeros_like(wi) + np.array([np.sqrt(1 - mu**2), 0, mu])
        albedos.append(np.sum(f(wo, wi) * wi[:, 2:] * omega[:, None], axis=0))
    return np.stack(albedos)


def _D(wh, alpha):
    q = wh[:, 0] ** 2 / alpha**2 + wh[:, 1] ** 2 / alpha**2 + wh[:, 2] ** 2
    return 1 / (np.pi * alpha**2 * q * q)


def _L(wo, wi, alpha):
    return stretched(wo, alpha) * wi[:, 2] + stretched(wi, alpha) * wo[:, 2]


def _safe(wo, wi):
    """The pairs, with those below the surface replaced by harmless ones."""
    ok = above(wo, wi)[:, None]
    return np.where(ok, wo, [0.0, 0, 1]), np.where(ok, wi, [0.0, 0, 1])


def ggx_lobe(wo, wi, roughness):
    ok, alpha = above(wo, wi), roughness * roughness
    wo, wi = _safe(wo, wi)
    V = 1 / (2 * _L(wo, wi, alpha))
    return ok * _D(half_vector(wo, wi), alpha) * V


def ggx_pdf(wo, wi, roughness):
    ok, alpha = above(wo, wi), roughness * roughness
    wo, wi = _safe(wo, wi)
    wh = half_vector(wo, wi)
    G1 = 2 * wo[:, 2] / (wo[:, 2] + stretched(wo, alpha))
    seen = np.sum(wo * wh, axis=1)
    facets = G1 * _D(wh, alpha) * seen / wo[:, 2]
    return ok * facets / (4 * seen)


def sample_ggx(wo, roughness, u2):
    alpha = (roughness**2)[:, None]
    v = np.concatenate([alpha * wo[:, :2], wo[:, 2:]], axis=1)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    z = 1 - u2[:, :1] * (1 + v[:, 2:])
    phi = 2 * np.pi * u2[:, 1:]
    ring = np.sqrt(np.maximum(1 - z**2, 0))
    h = np.concatenate([ring * np.cos(phi), ring * np.sin(phi), z], axis=1) + v
    wh = np.concatenate([alpha * h[:, :2], h[:, 2:]], axis=1)
    wh /= np.linalg.norm(wh, axis=1, keepdims=True)
    return 2 * np.sum(wo * wh, axis=1, keepdims=True) * wh - wo


def gltf(wo, wi, base_color, metalness, roughness):
    DV = ggx_lobe(wo, wi, roughness)[:, None]
    cos = np.sum(wo * half_vector(wo, wi), axis=1, keepdims=True)
    F_d, F_m = schlick(0.04, cos), schlick(base_color, cos)
    f_dielectric = (1 - F_d) * base_color / np.pi + F_d * DV
    f = (1 - metalness[:, None]) * f_dielectric + metalness[:, None] * F_m * DV
    return np.where(above(wo, wi)[:, None], f, 0)


def gltf_backward(wo, wi, base_color, metalness, roughness, d_f):
    d_f = np.where(above(wo, wi)[:, None], d_f, 0)
    wo, wi = _safe(wo, wi)
    wh, alpha = half_vector(wo, wi), roughness**2
    m = metalness[:, None]
    DV = ggx_lobe(wo, wi, roughness)[:, None]
    cos = np.sum(wo * wh, axis=1, keepdims=True)
    F_d, F_m = schlick(0.04, cos), schlick(base_color, cos)
    f_dielectric, f_metal = (1 - F_d) * base_color / np.pi + F_d * DV, F_m * DV
    d_base_color = d_f * ((1 - m) * (1 - F_d) / np.pi + m * (1 - (1 - cos) ** 5) * DV)
    d_metalness = np.sum(d_f * (f_metal - f_dielectric), axis=1)
    d_lobe = np.sum(d_f * ((1 - m) * F_d + m * F_m), axis=1)
    s2 = wh[:, 0] ** 2 + wh[:, 1] ** 2
    q = s2 / alpha**2 + wh[:, 2] ** 2
    ln_D = -2 / alpha + 4 * s2 / (alpha**3 * q)
    dL = np.zeros(len(wo))
    for w, other in ((wo, wi), (wi, wo)):
        dL += other[:, 2] * alpha * (w[:, 0] ** 2 + w[:, 1] ** 2) / stretched(w, alpha)
    ln_V = -dL / _L(wo, wi, alpha)
    return d_base_color, d_metalness, d_lobe * DV[:, 0] * (ln_D + ln_V) * 2 * roughness
