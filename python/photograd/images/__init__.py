"""Images on disk: PNG, JPEG, EXR, Radiance .hdr and PFM, read and written as linear arrays."""

from __future__ import annotations

from photograd.images.read import ColorSpace, downscale_image, read_image, read_radiance
from photograd.images.write import write_exr, write_jpeg, write_png, write_radiance

__all__ = [
    "ColorSpace",
    "downscale_image",
    "read_image",
    "read_radiance",
    "write_exr",
    "write_jpeg",
    "write_png",
    "write_radiance",
]
