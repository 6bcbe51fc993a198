"""Between the checks and your `splatting.py`: functions `back` cannot cross the pipe.

Runs beside your file; do not change or submit it. Each function calls yours, and
the `back` that it returns with the derivatives that the check gives.
"""

import numpy as np
import splatting


def covariance(quats, log_scales):
    """The values of `covariance`."""
    return splatting.covariance(quats, log_scales)[0]


def covariance_back(quats, log_scales, d_cov):
    """Result of its `back`."""
    return splatting.covariance(quats, log_scales)[1](d_cov)


def project(means, cov, camera):
    """The values of `project`."""
    return splatting.project(means, cov, camera)[:3]


def project_back(means, cov, camera, d_mean2d, d_cov2d):
    """Result of its `back`."""
    return splatting.project(means, cov, camera)[3](d_mean2d, d_cov2d)


def screen_alpha(mean2d, cov2d, opacity_logits, pixels):
    """The values of `screen_alpha`."""
    return splatting.screen_alpha(mean2d, cov2d, opacity_logits, pixels)[0]


def screen_alpha_back(mean2d, cov2d, opacity_logits, pixels, d_alpha):
    """Result of its `back`."""
    return splatting.screen_alpha(mean2d, cov2d, opacity_logits, pixels)[1](d_alpha)


def composite_splats(alpha, colors, depth, background):
    """The values of `composite_splats`."""
    return splatting.composite_splats(alpha, colors, depth, background)[0]


def composite_splats_back(alpha, colors, depth, background, d_shown):
    """Result of its `back`."""
    return splatting.composite_splats(alpha, colors, depth, background)[1](d_shown)


def render(gaussians, camera, pixels, background):
    """The values of `render`."""
    return splatting.render(gaussians, camera, pixels, background)[0]


def render_back(gaussians, camera, pixels, background, d_shown):
    """Result of its `back`."""
    return splatting.render(gaussians, camera, pixels, background)[1](d_shown)


def densify(gaussians, grad2d, seed, max_count):
    """`densify` with a generator of this seed; the scene as a list, then source as float64."""
    rng = np.random.default_rng(seed)
    after, source = splatting.densify(gaussians, grad2d, rng, max_count)
    names = ("means", "log_scales", "quats", "opacity_logits", "colors")
    return [*(after[name] for name in names), np.asarray(source).astype(np.float64)]


def densify_again(gaussians, grad2d, seed, max_count):
    """`densify` for the same arrays the second time."""
    densify(gaussians, grad2d, seed, max_count)
    return densify(gaussians, grad2d, seed, max_count)


def fitted(gaussians, views, steps, seed, background, max_count):
    """The losses of a fit from here."""
    rng = np.random.default_rng(seed)
    return splatting.fit(gaussians, views, steps, rng, background, max_count, every=20)[1]
