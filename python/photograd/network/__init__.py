"""Small multilayer perceptrons and the encodings of their inputs, forward and backward.

* `Perceptron`: weights in one array, evaluated in blocks that stay in the cache.
* `Perceptrons`: many of one shape, each at inputs of its own.
* `LayerValues`: what its forward pass may keep for the backward pass.
* `HashEncoding`: multiresolution hash encoding of points in the unit square or cube.
* `FrequencyEncoding`, `OneBlobEncoding`: encodings without parameters.

Directions are encoded by spherical harmonics, `photograd.sh.basis`.
"""

from __future__ import annotations

from .encodings import FrequencyEncoding, OneBlobEncoding
from .hash_encoding import HashEncoding, Level
from .perceptron import Activation, LayerValues, Perceptron
from .perceptrons import Perceptrons

__all__ = [
    "Activation",
    "FrequencyEncoding",
    "HashEncoding",
    "LayerValues",
    "Level",
    "OneBlobEncoding",
    "Perceptron",
    "Perceptrons",
]
