"""From the handout alone, stage by stage, with einsum."""

import numpy as np
from splatting import CROSS, FAINT, LOW_PASS, NEAR, SHRINK, SMALL, THRESHOLD, depths, limits
from volume_rendering import composite, composite_adjoint

ALPHA_MIN, ALPHA_MAX = 1 / 255, 0.999


def covariance(quats, log_scales):
    """The covariances of Gaussians."""
    unit = quats / np.sqrt((quats**2).sum(axis=1))[:, None]
    w, u = unit[:, 0], unit[:, 1:]
    K = np.einsum("ijk,nk->nij", CROSS, u)
    R = np.eye(3)[None] + 2 * w[:, None, None] * K + 2 * np.einsum("nij,njk->nik", K, K)
    M = R * np.exp(log_scales)[:, None, :]

    def back(d_cov):
        d_M = np.einsum("nij,njk->nik", d_cov, M) + np.einsum("nji,njk->nik", d_cov, M)
        d_R = d_M * np.exp(log_scales)[:, None, :]
        d_w = 2 * np.einsum("nij,nij->n", d_R, K)
        d_K = 2 * w[:, None, None] * d_R
        d_K = d_K + 2 * np.einsum("nij,nkj->nik", d_R, K) + 2 * np.einsum("nji,njk->nik", K, d_R)
        d_u = np.einsum("nij,ijk->nk", d_K, CROSS)
        d_unit = np.concatenate([d_w[:, None], d_u], axis=1)
        d_unit = d_unit - np.einsum("ni,ni->n", d_unit, unit)[:, None] * unit
        return d_unit / np.sqrt((quats**2).sum(axis=1))[:, None], np.einsum("nij,nij->nj", d_M, M)

    return np.einsum("nik,njk->nij", M, M), back


def project(means, cov, camera):
    """Gaussians as the camera sees them."""
    W = camera["camera_from_world"][:, :3]
    t = np.einsum("ij,nj->ni", W, means) + camera["camera_from_world"][:, 3]
    z = t[:, 2]
    u = t[:, :2] / z[:, None]
    low, high = limits(camera)
    h = np.minimum(np.maximum(u, low), high)
    J = np.zeros((len(means), 2, 3))
    J[:, 0, 0], J[:, 1, 1] = camera["focal"][0] / z, camera["focal"][1] / z
    J[:, :, 2] = -camera["focal"] * h / z[:, None]
    A = np.einsum("nij,jk->nik", J, W)
    full = np.einsum("nia,nab,njb->nij", A, cov, A)

    def back(d_mean2d, d_cov2d):
        G = np.empty((len(means), 2, 2))
        G[:, 0, 0], G[:, 1, 1] = d_cov2d[:, 0], d_cov2d[:, 2]
        G[:, 0, 1] = G[:, 1, 0] = d_cov2d[:, 1] / 2
        d_cov = np.einsum("nia,nij,njb->nab", A, G, A)
        d_J = np.einsum("nij,nja,nab,kb->nik", 2 * G, A, cov, W)
        d_u = camera["focal"] * d_mean2d
        inside = (u >= low) & (u <= high)
        d_u = d_u - inside * camera["focal"] * d_J[:, :, 2] / z[:, None]
        d_t = np.zeros_like(t)
        d_t[:, :2] = d_u / z[:, None]
        d_t[:, 2] = -np.einsum("ni,ni->n", d_u, u) / z - np.einsum("nij,nij->n", d_J, J) / z
        return np.einsum("ni,ij->nj", d_t, W), d_cov

    cov2d = np.stack([full[:, 0, 0], full[:, 0, 1], full[:, 1, 1]], axis=1)
    return camera["focal"] * u + camera["center"], cov2d, z, back


def screen_alpha(mean2d, cov2d, opacity_logits, pixels):
    """How much of each pixel's light each splat takes."""
    S = np.zeros((len(cov2d), 2, 2))
    S[:, 0, 0], S[:, 1, 1] = cov2d[:, 0] + LOW_PASS, cov2d[:, 2] + LOW_PASS
    S[:, 0, 1] = S[:, 1, 0] = cov2d[:, 1]
    Q = np.linalg.inv(S)
    d = mean2d[:, None] - pixels[None]
    v = np.einsum("nij,npj->npi", Q, d)
    G = np.exp(-np.einsum("npi,npi->np", d, v) / 2)
    o = 1 / (1 + np.exp(-opacity_logits))
    raw = o[:, None] * G

    def back(d_alpha):
        moves = (raw > ALPHA_MIN) & (raw < ALPHA_MAX)
        d_raw = np.where(moves, d_alpha, 0.0)
        d_sigma = -raw * d_raw
        H = np.einsum("np,npi,npj->nij", d_sigma, d, d) / 2
        d_S = -np.einsum("nij,njk,nkl->nil", Q, H, Q)
        each = d_sigma[:, :, None] * v
        d_cov2d = np.stack([d_S[:, 0, 0], 2 * d_S[:, 0, 1], d_S[:, 1, 1]], axis=1)
        d_logits = np.einsum("np,np->n", d_raw, G) * o * (1 - o)
        return each.sum(axis=1), d_cov2d, d_logits, np.abs(each).sum(axis=1)

    alpha = np.where(raw < ALPHA_MIN, 0.0, raw)
    return np.where(alpha > ALPHA_MAX, ALPHA_MAX, alpha), back


def composite_splats(alpha, colors, depth, background):
    """Splats over one another, nearest first."""
    rank = np.argsort(depth, kind="mergesort")
    if len(rank) == 0:
        gone = alpha * 0.0, colors * 0.0
        return np.tile(background, (alpha.shape[1], 1)), lambda d: (*gone, d.sum(axis=0))
    sigma = -np.log1p(-alpha[rank]).T
    color = np.repeat(colors[rank][None], len(sigma), axis=0)
    ones = np.ones_like(sigma)
    shown, _ = composite(sigma, color, ones, background)

    def back(d_shown):
        zero = np.zeros(len(sigma))
        d_sigma, d_color, d_b = composite_adjoint(sigma, color, ones, background, d_shown, zero)
        place = np.argsort(rank)
        return (d_sigma * np.exp(sigma)).T[place], d_color.sum(axis=0)[place], d_b

    return shown, back


def render(gaussians, camera, pixels, background):
    """What some pixels show: what is not in front is put there, and has no opacity."""
    pose = camera["camera_from_world"]
    ahead = depths(gaussians["means"], camera) > NEAR
    somewhere = pose[:, :3].T @ (np.array([0.0, 0.0, 1.0 + NEAR]) - pose[:, 3])
    means = np.where(ahead[:, None], gaussians["means"], somewhere)
    logits = np.where(ahead, gaussians["opacity_logits"], -50.0)
    shapes, from_shapes = covariance(gaussians["quats"], gaussians["log_scales"])
    *on_screen, z, from_screen = project(means, shapes, camera)
    alpha, from_alpha = screen_alpha(*on_screen, logits, pixels)
    shown, from_shown = composite_splats(alpha, gaussians["colors"], z, background)

    def back(d_shown):
        d_alpha, d_colors, d_background = from_shown(d_shown)
        *d_on_screen, d_logits, absgrad = from_alpha(d_alpha)
        d_means, d_shapes = from_screen(*d_on_screen)
        d_quats, d_log_scales = from_shapes(d_shapes)
        return {
            "means": d_means,
            "log_scales": d_log_scales,
            "quats": d_quats,
            "opacity_logits": d_logits,
            "colors": d_colors,
            "background": d_background,
            "absgrad": absgrad,
        }

    return shown, back


def densify(gaussians, grad2d, rng, max_count):
    """Clone, split and drop Gaussians: sets of rows, and a scene in four parts."""
    opacity = 1 / (1 + np.exp(-gaussians["opacity_logits"]))
    alive = np.flatnonzero(opacity >= FAINT)
    asking = alive[grad2d[alive] > THRESHOLD]
    first = asking[np.lexsort((asking, -grad2d[asking]))]
    first = first[: max(0, max_count - alive.size)]
    longest = np.exp(np.max(gaussians["log_scales"], axis=1))
    split = np.sort(first[longest[first] > SMALL])
    clone = np.setdiff1d(first, split)
    halved = gaussians["opacity_logits"].copy()
    a = 1 - np.sqrt(1 - opacity[clone])  # Eq. (31): two of these let through what one did
    halved[clone] = -np.log(1 / a - 1)
    scene = {**gaussians, "opacity_logits": halved}
    parents = {key: part[split] for key, part in scene.items()}
    factor = np.linalg.cholesky(covariance(parents["quats"], parents["log_scales"])[0])
    thinner = parents["log_scales"] - np.log(SHRINK)
    z = rng.standard_normal((2 * len(split), 3)).reshape(2, -1, 3)
    children = [
        {**parents, "log_scales": thinner, "means": parents["means"] + (factor @ each)[:, :, 0]}
        for each in z[..., None]
    ]
    stay = np.setdiff1d(alive, split)
    parts = [{key: part[rows] for key, part in scene.items()} for rows in (stay, clone)]
    after = {key: np.concatenate([part[key] for part in parts + children]) for key in scene}
    return after, np.append(stay, np.full(len(after["means"]) - len(stay), -1))
