"""3D Gaussians: pictures of them with derivatives, their files, and scenes that can be fitted.

scene = read_gaussians(Path("scene.ply")).gaussians
picture, context = render(scene, camera)  # and render_backward

`GaussianScene` is the representation. How one begins (`start`) and how the number of Gaussians
changes during a fit (`density`, `clone_split_prune`, `markov_chain`) have files of their own;
`rays` renders the same Gaussians along any rays.
"""

from __future__ import annotations

from photograd.splats.files import GaussianFile, read_gaussians, write_gaussians
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import (
    Gaussians,
    SplatContext,
    SplatGradients,
    SplatOptions,
    SplatPicture,
    render,
    render_backward,
)

__all__ = [
    "GaussianFile",
    "GaussianScene",
    "Gaussians",
    "SplatContext",
    "SplatGradients",
    "SplatOptions",
    "SplatPicture",
    "read_gaussians",
    "render",
    "render_backward",
    "write_gaussians",
]
