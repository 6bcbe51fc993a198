"""One Gaussian at a time, in loops; the blend goes from the back to the front."""

import numpy as np
from splatting import FAINT, LOW_PASS, NEAR, SHRINK, SMALL, THRESHOLD, depths, limits

ALPHA_MIN, ALPHA_MAX = 1 / 255, 0.999


def turning(q):
    """R of a unit quaternion, entry by entry."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def turning_slopes(q):
    """The derivatives of `turning` by w, x, y, z."""
    w, x, y, z = q
    return 2 * np.array(
        [
            [[0, -z, y], [z, 0, -x], [-y, x, 0]],
            [[0, y, z], [y, -2 * x, -w], [z, w, -2 * x]],
            [[-2 * y, x, w], [x, 0, z], [-w, z, -2 * y]],
            [[-2 * z, -w, x], [w, -2 * z, y], [x, y, 0]],
        ]
    )


def covariance(quats, log_scales):
    """The covariances of Gaussians."""
    N = len(quats)
    cov, axes, lengths = np.zeros((N, 3, 3)), np.zeros((N, 3, 3)), np.zeros(N)
    for i in range(N):
        lengths[i] = np.sqrt(quats[i] @ quats[i])
        axes[i] = turning(quats[i] / lengths[i]) @ np.diag(np.exp(log_scales[i]))
        cov[i] = axes[i] @ axes[i].T

    def back(d_cov):
        d_quats, d_log_scales = np.zeros((N, 4)), np.zeros((N, 3))
        for i in range(N):
            d_axes = d_cov[i] @ axes[i] + d_cov[i].T @ axes[i]
            for j in range(3):
                d_log_scales[i, j] = d_axes[:, j] @ axes[i][:, j]
            unit = quats[i] / lengths[i]
            slopes = turning_slopes(unit) * np.exp(log_scales[i])
            d_unit = np.array([np.sum(slope * d_axes) for slope in slopes])
            d_quats[i] = (np.eye(4) - np.outer(unit, unit)) @ d_unit / lengths[i]
        return d_quats, d_log_scales

    return cov, back


def project(means, cov, camera):
    """Gaussians as the camera sees them."""
    W, b = camera["camera_from_world"][:, :3], camera["camera_from_world"][:, 3]
    fx, fy = camera["focal"]
    low, high = limits(camera)
    N = len(means)
    mean2d, cov2d, depth, kept = np.zeros((N, 2)), np.zeros((N, 3)), np.zeros(N), []
    for i in range(N):
        t = W @ means[i] + b
        u, v = t[0] / t[2], t[1] / t[2]
        hu, hv = min(max(u, low[0]), high[0]), min(max(v, low[1]), high[1])
        J = np.array([[fx, 0, -fx * hu], [0, fy, -fy * hv]]) / t[2]
        flat = J @ W @ cov[i] @ W.T @ J.T
        mean2d[i] = fx * u + camera["center"][0], fy * v + camera["center"][1]
        cov2d[i], depth[i] = (flat[0, 0], flat[0, 1], flat[1, 1]), t[2]
        kept.append((t, u, v, hu, hv, J))

    def back(d_mean2d, d_cov2d):
        d_means, d_cov = np.zeros((N, 3)), np.zeros((N, 3, 3))
        for i in range(N):
            t, u, v, _, _, J = kept[i]
            # All of the derivative of xy goes to one of its two entries: the same sum.
            g = np.array([[d_cov2d[i, 0], d_cov2d[i, 1]], [0.0, d_cov2d[i, 2]]])
            camera_cov = W @ cov[i] @ W.T
            d_J = g @ J @ camera_cov + g.T @ J @ camera_cov
            d_cov[i] = W.T @ J.T @ g @ J @ W
            d_u, d_v = fx * d_mean2d[i, 0], fy * d_mean2d[i, 1]
            if low[0] < u < high[0]:
                d_u -= d_J[0, 2] * fx / t[2]
            if low[1] < v < high[1]:
                d_v -= d_J[1, 2] * fy / t[2]
            d_z = -(d_u * u + d_v * v) / t[2] - np.sum(d_J * J) / t[2]
            d_means[i] = W.T @ np.array([d_u / t[2], d_v / t[2], d_z])
        return d_means, d_cov

    return mean2d, cov2d, depth, back


def screen_alpha(mean2d, cov2d, opacity_logits, pixels):
    """How much of each pixel's light each splat takes."""
    N, P = len(mean2d), len(pixels)
    alpha, kept = np.zeros((N, P)), []
    for i in range(N):
        xx, xy, yy = cov2d[i] + np.array([LOW_PASS, 0.0, LOW_PASS])
        conic = np.linalg.inv(np.array([[xx, xy], [xy, yy]]))
        d = mean2d[i] - pixels
        o = 1 / (1 + np.exp(-opacity_logits[i]))
        G = np.exp(-0.5 * np.einsum("pi,ij,pj->p", d, conic, d))
        held, dropped = o * G > ALPHA_MAX, o * G < ALPHA_MIN
        alpha[i] = np.where(dropped, 0.0, np.where(held, ALPHA_MAX, o * G))
        kept.append((conic, d, o, G, ~held & ~dropped))

    def back(d_alpha):
        d_mean2d, d_cov2d = np.zeros((N, 2)), np.zeros((N, 3))
        d_logits, absgrad = np.zeros(N), np.zeros((N, 2))
        for i in range(N):
            conic, d, o, G, moves = kept[i]
            d_raw = d_alpha[i] * moves
            d_logits[i] = np.sum(d_raw * G) * o * (1 - o)
            d_sigma = -d_raw * o * G
            each = d_sigma[:, None] * (d @ conic)
            d_mean2d[i], absgrad[i] = each.sum(axis=0), np.abs(each).sum(axis=0)
            d_conic = 0.5 * np.einsum("p,pi,pj->ij", d_sigma, d, d)
            d_full = -conic @ d_conic @ conic
            d_cov2d[i] = d_full[0, 0], d_full[0, 1] + d_full[1, 0], d_full[1, 1]
        return d_mean2d, d_cov2d, d_logits, absgrad

    return alpha, back


def composite_splats(alpha, colors, depth, background):
    """Splats over one another, nearest first."""
    nearest = sorted(range(len(depth)), key=lambda i: depth[i])
    shown = np.tile(background, (alpha.shape[1], 1))
    behind = {}
    for i in reversed(nearest):
        behind[i] = shown
        shown = alpha[i][:, None] * colors[i] + (1 - alpha[i])[:, None] * shown

    def back(d_shown):
        d_alpha, d_colors = np.zeros(alpha.shape), np.zeros(colors.shape)
        g = d_shown.copy()
        for i in nearest:
            d_alpha[i] = np.sum(g * (colors[i] - behind[i]), axis=1)
            d_colors[i] = alpha[i] @ g
            g = g * (1 - alpha[i])[:, None]
        return d_alpha, d_colors, g.sum(axis=0)

    return shown, back


def render(gaussians, camera, pixels, background):
    """What some pixels show of a scene."""
    index = [i for i, z in enumerate(depths(gaussians["means"], camera)) if z > NEAR]
    means, log_scales, quats = (gaussians[k][index] for k in ("means", "log_scales", "quats"))
    cov, back1 = covariance(quats, log_scales)
    mean2d, cov2d, z, back2 = project(means, cov, camera)
    alpha, back3 = screen_alpha(mean2d, cov2d, gaussians["opacity_logits"][index], pixels)
    shown, back4 = composite_splats(alpha, gaussians["colors"][index], z, background)

    def back(d_shown):
        out = {key: np.zeros_like(value) for key, value in gaussians.items()}
        out["absgrad"] = np.zeros((len(gaussians["means"]), 2))
        d_alpha, out["colors"][index], d_background = back4(d_shown)
        d_mean2d, d_cov2d, out["opacity_logits"][index], out["absgrad"][index] = back3(d_alpha)
        out["means"][index], d_cov = back2(d_mean2d, d_cov2d)
        out["quats"][index], out["log_scales"][index] = back1(d_cov)
        out["background"] = d_background
        return out

    return shown, back


def densify(gaussians, grad2d, rng, max_count):
    """Clone, split and drop Gaussians."""
    opacity = 1 / (1 + np.exp(-gaussians["opacity_logits"]))
    alive = [i for i in range(len(opacity)) if opacity[i] >= FAINT]
    wanted = sorted((i for i in alive if grad2d[i] > THRESHOLD), key=lambda i: -grad2d[i])
    wanted = sorted(wanted[: max(max_count - len(alive), 0)])
    long = [i for i in wanted if np.exp(gaussians["log_scales"][i]).max() > SMALL]
    short = [i for i in wanted if i not in long]
    stay = [i for i in alive if i not in long]
    new = {key: value.copy() for key, value in gaussians.items()}
    for i in short:
        a = 1 - np.sqrt(1 - opacity[i])
        new["opacity_logits"][i] = np.log(a) - np.log(1 - a)
    new = {key: value[[*stay, *short, *long, *long]] for key, value in new.items()}
    z = rng.standard_normal((2 * len(long), 3))
    cov, _ = covariance(gaussians["quats"][long], gaussians["log_scales"][long])
    at = len(stay) + len(short)
    for k in range(2 * len(long)):
        new["means"][at + k] += np.linalg.cholesky(cov[k % len(long)]) @ z[k]
        new["log_scales"][at + k] -= np.log(SHRINK)
    return new, np.array(stay + [-1] * (len(short) + 2 * len(long)))
