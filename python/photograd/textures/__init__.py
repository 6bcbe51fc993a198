"""Textures: lookups, mip maps and recovery from samples, each with its adjoint.

A texture is an array T[row, column, channel] of shape (H, W, C), float32 or float64, with 1 to 4
channels. Texture coordinates (u, v) lie in [0, 1], v points down, the center of texel i of n lies
at (i + 0.5) / n, and outside of the outermost centers the border's value continues. The formulas
stand in cpp/photograd/ops/bilinear.h and cpp/photograd/texture/mip_chain.h.
"""

from photograd.textures.mips import (
    build_mips,
    build_mips_backward,
    mip_level,
    mip_level_backward,
    sample_mips,
    sample_mips_backward,
)
from photograd.textures.recovery import RecoveredTexture, recover, stable_learning_rate
from photograd.textures.sample import TexturePlan, loss_and_gradient, sample, sample_backward

__all__ = [
    "RecoveredTexture",
    "TexturePlan",
    "build_mips",
    "build_mips_backward",
    "loss_and_gradient",
    "mip_level",
    "mip_level_backward",
    "recover",
    "sample",
    "sample_backward",
    "sample_mips",
    "sample_mips_backward",
    "stable_learning_rate",
]
