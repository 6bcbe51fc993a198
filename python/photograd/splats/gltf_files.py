"""Gaussians in glTF files, by the extension KHR_gaussian_splatting.

A primitive of points, in the frame of glTF (+Y up) and with these attributes:

    POSITION, COLOR_0               the mean; display color and opacity, for what draws points
    KHR_gaussian_splatting:SCALE    standard deviations in meters (not their logarithms)
    ...:ROTATION, ...:OPACITY       a unit quaternion (x, y, z, w); 0 to 1
    ...:SH_DEGREE_l_COEF_n          red, green and blue of coefficient n of degree l

The harmonics are those of `photograd.sh`, with its signs and in its order m = -l to l, which the
tests prove orthonormal; .ply files have the same. Drafts of the extension stored logarithms of
scales, and printed a harmonic of degree 3 without its squares: what is written here agrees with
files of SplatTransform 2.7, whose readers take scales as they are.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._gltf_bytes import GltfBytes
from photograd.errors import IoError, message
from photograd.sh import Y_0
from photograd.splats.coding import Coding, Codings, logit_of, opacity_of, turn_of_error, unit_quats
from photograd.splats.frames import half_turn
from photograd.splats.splatting import Gaussians

EXTENSION = "KHR_gaussian_splatting"
GLTF = (".glb", ".gltf")
LOG_SCALES = (-87.0, 88.0)
"""Exponentials that float32 holds in full precision."""
_WRITER = "write_gaussian_gltf"
_POINTS = 0


def write_gaussian_gltf(path: Path, gaussians: Gaussians) -> None:
    """Write Gaussians as .glb, or as .gltf with everything in one file, whole or not at all.

    They are turned so that +Y is up, and their colors are said to be sRGB display values.

    Args:
        path: ends in .glb or .gltf.
        gaussians: in the frame of .ply files, with -y up.

    Raises:
        IoError: none to write, another end of the name, or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in GLTF:
        raise IoError(
            message(_WRITER, "path", f"a name that ends in {' or '.join(GLTF)}", path.name)
        )
    if not len(gaussians):
        raise IoError(message(_WRITER, "gaussians", "at least one", 0))
    upright, file = half_turn(gaussians), GltfBytes()
    opacity = opacity_of(upright.opacity_logits)
    shown = (0.5 + Y_0 * upright.sh[:, 0].astype(np.float64)).clip(0.0, 1.0)
    attributes = {
        "POSITION": file.attribute(upright.means, bounds=True),
        "COLOR_0": file.attribute(np.concatenate([shown, opacity[:, None]], axis=1)),
        f"{EXTENSION}:SCALE": file.attribute(
            np.exp(upright.log_scales.astype(np.float64).clip(*LOG_SCALES))
        ),
        f"{EXTENSION}:ROTATION": file.attribute(unit_quats(upright.quats)[:, [1, 2, 3, 0]]),
        f"{EXTENSION}:OPACITY": file.attribute(opacity),
    }
    for k in range(upright.sh.shape[1]):
        degree = int(np.sqrt(k))
        name = f"{EXTENSION}:SH_DEGREE_{degree}_COEF_{k - degree * degree}"
        attributes[name] = file.attribute(upright.sh[:, k])
    said = {
        "kernel": "ellipse",
        "colorSpace": "srgb_rec709_display",
        "sortingMethod": "cameraDistance",
        "projection": "perspective",
    }
    part = {"attributes": attributes, "mode": _POINTS, "extensions": {EXTENSION: said}}
    node = {"mesh": file.entry("meshes", {"name": "gaussians", "primitives": [part]})}
    file.root |= {"nodes": [node], "scenes": [{"nodes": [0]}], "scene": 0}
    file.root["extensionsUsed"] = [EXTENSION]
    atomic_write(path, file.glb() if suffix == ".glb" else file.gltf())


def gltf_codings(gaussians: Gaussians) -> Codings:
    """Errors of float32: of a scale, of a quaternion's unit length, and of an opacity.

    Args:
        gaussians: to be written.
    """
    finite = np.isfinite(gaussians.log_scales)
    largest = float(np.abs(gaussians.log_scales).max(initial=0.0, where=finite))
    codings = {
        "means": Coding(0.0),
        "log_scales": Coding(6e-8 * (2.0 + min(largest, 88.0)), *LOG_SCALES),
        "rotation": Coding(turn_of_error(2e-7)),
        "opacity": Coding(1e-7),
        "color": Coding(0.0),
    }
    return codings | ({"harmonics": Coding(0.0)} if gaussians.degree else {})


def stored_gaussians(gaussians: Gaussians) -> Gaussians:
    """The Gaussians, float32, that a file has after its numbers are rounded; -y is up again.

    Args:
        gaussians: to be written.
    """
    scales = np.exp(gaussians.log_scales.astype(np.float64).clip(*LOG_SCALES)).astype(np.float32)
    opacity = opacity_of(gaussians.opacity_logits).astype(np.float32)
    return Gaussians(
        means=gaussians.means.astype(np.float32),
        log_scales=np.log(scales.astype(np.float64)).astype(np.float32),
        quats=unit_quats(gaussians.quats).astype(np.float32),
        opacity_logits=logit_of(opacity.astype(np.float64)).astype(np.float32),
        sh=gaussians.sh.astype(np.float32),
    )
