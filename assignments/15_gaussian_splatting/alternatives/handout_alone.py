"""From the handout alone, stage by stage, with einsum."""

from __future__ import annotations

import numpy as np

LOW_PASS = 0.3  # pixels squared: no splat is thinner than about a pixel
MARGIN = 0.15  # of the picture's size: how far outside of it slopes are still taken where they are
NEAR = 0.01  # metres; Gaussians that are closer are not drawn
ALPHA_MIN, ALPHA_MAX = 1 / 255, 0.999
FAINT = 0.02  # opacity below which a Gaussian is dropped
SMALL = 0.06  # metres; longer ones are split, the others cloned
THRESHOLD = 0.002  # of the pressure
SHRINK = 1.6  # a part of a split Gaussian is smaller by this
TILE = 16  # pixels
RATES = {"means": 0.008, "log_scales": 0.03, "quats": 0.03, "opacity_logits": 0.05, "colors": 0.02}
# The matrix that takes v to the cross product u x v has the entries sum_k CROSS[i, j, k] u_k.
CROSS = np.array(
    [
        [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
        [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
        [[0, -1, 0], [1, 0, 0], [0, 0, 0]],
    ]
)


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


def depths(means, camera):
    """Given: how far in front of the camera means lie, along its axis; (N,)."""
    view = camera["camera_from_world"]
    return means @ view[2, :3] + view[2, 3]


def limits(camera):
    """Given: (low, high), (2,) each: where t_x / t_z and t_y / t_z are held for the slopes."""
    size = np.array([camera["width"], camera["height"]], np.float64)
    low = (-MARGIN * size - camera["centre"]) / camera["focal"]
    return low, ((1 + MARGIN) * size - camera["centre"]) / camera["focal"]


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
    return camera["focal"] * u + camera["centre"], cov2d, z, back


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


def composite(alpha, colors, depth, background):
    """Splats over one another, nearest first."""
    rank = np.argsort(depth, kind="mergesort")
    T = np.ones((len(depth) + 1, alpha.shape[1]))
    for k, i in enumerate(rank):
        T[k + 1] = T[k] * (1 - alpha[i])
    shown = T[-1][:, None] * background[None]
    for k, i in enumerate(rank):
        shown = shown + (T[k] * alpha[i])[:, None] * colors[i]

    def back(d_shown):
        d_alpha, d_colors = np.empty_like(alpha), np.empty_like(colors)
        behind = T[-1] * (d_shown @ background)
        for k in range(len(rank) - 1, -1, -1):
            i = rank[k]
            v = d_shown @ colors[i]
            d_alpha[i] = T[k] * v - behind / (1 - alpha[i])
            d_colors[i] = (T[k] * alpha[i]) @ d_shown
            behind = behind + T[k] * alpha[i] * v
        return d_alpha, d_colors, T[-1] @ d_shown

    return shown, back


def render(gaussians, camera, pixels, background):
    """What some pixels show of a scene."""
    drawn = depths(gaussians["means"], camera) > NEAR
    part = {key: values[drawn] for key, values in gaussians.items()}
    cov, shape_back = covariance(part["quats"], part["log_scales"])
    mean2d, cov2d, depth, lens_back = project(part["means"], cov, camera)
    alpha, alpha_back = screen_alpha(mean2d, cov2d, part["opacity_logits"], pixels)
    shown, blend_back = composite(alpha, part["colors"], depth, background)

    def back(d_shown):
        found = {}
        d_alpha, found["colors"], d_background = blend_back(d_shown)
        d_mean2d, d_cov2d, found["opacity_logits"], found["pull"] = alpha_back(d_alpha)
        found["means"], d_cov = lens_back(d_mean2d, d_cov2d)
        found["quats"], found["log_scales"] = shape_back(d_cov)
        rows = {key: np.zeros((len(drawn), *each.shape[1:])) for key, each in found.items()}
        for key, each in found.items():
            rows[key][drawn] = each
        return {**rows, "background": d_background}

    return shown, back


def densify(gaussians, pressure, rng, most):
    """Clone, split and drop Gaussians."""
    opacity = 1 / (1 + np.exp(-gaussians["opacity_logits"]))
    kept = opacity >= FAINT
    rows = np.argsort(-pressure, kind="stable")
    chosen = rows[(kept & (pressure > THRESHOLD))[rows]][: max(most - kept.sum(), 0)]
    small = np.exp(gaussians["log_scales"]).max(axis=1) <= SMALL
    clone, split = (np.sort(chosen[each]) for each in (small[chosen], ~small[chosen]))
    kept[split] = False
    stay = np.flatnonzero(kept)
    rows = np.concatenate([stay, clone, split, split])
    logits = gaussians["opacity_logits"].copy()
    logits[clone] = np.log(np.sqrt(1 + np.exp(logits[clone])) - 1)
    after = {key: part[rows] for key, part in {**gaussians, "opacity_logits": logits}.items()}
    fresh = slice(len(rows) - 2 * len(split), None)
    whole, _ = covariance(after["quats"][fresh], after["log_scales"][fresh])
    drawn = rng.standard_normal((2 * len(split), 3))
    after["means"][fresh] += np.einsum("nij,nj->ni", np.linalg.cholesky(whole), drawn)
    after["log_scales"][fresh] -= np.log(SHRINK)
    return after, np.where(np.arange(len(rows)) < len(stay), rows, -1)


def reach(gaussians, camera):
    """Given: (low, high), (N, 2) each: outside of this box alpha is below ALPHA_MIN."""
    ahead = depths(gaussians["means"], camera) > NEAR
    low, high = np.full((len(ahead), 2), np.inf), np.full((len(ahead), 2), -np.inf)
    visible = {key: values[ahead] for key, values in gaussians.items()}
    spread, _ = covariance(visible["quats"], visible["log_scales"])
    middle, extent, *_ = project(visible["means"], spread, camera)
    solid = 1 / (1 + np.exp(-visible["opacity_logits"]))
    sigmas = np.sqrt(2 * np.log(np.maximum(solid / ALPHA_MIN, 1)))
    half = sigmas[:, None] * np.sqrt(extent[:, ::2] + LOW_PASS)
    low[ahead], high[ahead] = middle - half, middle + half
    return low, high


def picture(gaussians, camera, background):
    """Given: all pixels by `render`, TILE x TILE of them at a time, with what can reach them."""
    low, high = reach(gaussians, camera)
    height, width = camera["height"], camera["width"]
    shown, tiles = np.zeros((height, width, 3)), []
    for top in range(0, height, TILE):
        for left in range(0, width, TILE):
            block = slice(top, min(top + TILE, height)), slice(left, min(left + TILE, width))
            y, x = (each.ravel() + 0.5 for each in np.mgrid[block])
            here = (high > [x[0], y[0]]) & (low < [x[-1], y[-1]])
            here = np.flatnonzero(here.all(axis=1))
            some = {key: values[here] for key, values in gaussians.items()}
            colors, tile_back = render(some, camera, np.stack([x, y], axis=1), background)
            shown[block] = colors.reshape(shown[block].shape)
            tiles.append((block, here, tile_back))

    def back(d_shown):
        total = {key: np.zeros_like(values) for key, values in gaussians.items()}
        total.update(pull=np.zeros((len(low), 2)), background=np.zeros(3))
        for block, here, tile_back in tiles:
            for key, values in tile_back(d_shown[block].reshape(-1, 3)).items():
                total[key][... if key == "background" else here] += values
        return total

    return shown, back


class Adam:
    """Steps of Adam for a scene, as in assignment 01, with beta 0.9 and 0.99."""

    def __init__(self, gaussians):
        self.m = {key: np.zeros_like(values) for key, values in gaussians.items()}
        self.v = {key: np.zeros_like(values) for key, values in gaussians.items()}
        self.k = 0

    def step(self, gaussians, gradient):
        """The scene after one step; the given one stays as it is."""
        self.k += 1
        moved = {}
        for key, values in gaussians.items():
            self.m[key] = 0.9 * self.m[key] + 0.1 * gradient[key]
            self.v[key] = 0.99 * self.v[key] + 0.01 * gradient[key] ** 2
            m, v = self.m[key] / (1 - 0.9**self.k), self.v[key] / (1 - 0.99**self.k)
            moved[key] = values - RATES[key] * m / (np.sqrt(v) + 1e-8)
        return moved

    def follow(self, source):
        """Rows keep their moments when a scene has changed; new ones begin with none."""
        for moments in (self.m, self.v):
            for key, values in moments.items():
                old = (source >= 0).reshape(-1, *[1] * (values.ndim - 1))
                moments[key] = np.where(old, values[source], 0.0)


def fit(gaussians, views, steps, rng, background, most, every=50, watch=None):
    """Given: fit a scene to photographs, one of them in each step."""
    adam, losses = Adam(gaussians), np.zeros(steps)
    total, times = np.zeros(len(gaussians["means"])), np.zeros(len(gaussians["means"]))
    for step in range(steps):
        camera, truth = views[rng.integers(len(views))]
        shown, back = picture(gaussians, camera, background)
        error = shown - truth
        losses[step] = np.sum(error**2) / error[..., 0].size
        if watch is not None:
            watch(step, gaussians, losses[step])
        gradient = back(2 * error / error[..., 0].size)
        pull = np.linalg.norm(gradient["pull"], axis=1)
        # The loss is a mean over pixels: with this factor a threshold holds for any picture's size.
        total += pull * max(camera["width"], camera["height"]) / 2
        times += pull > 0
        gaussians = adam.step(gaussians, gradient)
        if most and (step + 1) % every == 0 and 3 * step < 2 * steps:
            pressure = total / np.maximum(times, 1)
            gaussians, source = densify(gaussians, pressure, rng, most)
            adam.follow(source)
            total, times = np.zeros(len(source)), np.zeros(len(source))
    return gaussians, losses
