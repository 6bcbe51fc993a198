"""Encodings of points without parameters: frequencies, and blobs over bins."""

from __future__ import annotations

import numpy as np

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array

MAX_OCTAVES = 24
MAX_BINS = 256


@typed_call
class FrequencyEncoding:
    """p, then sin(2^k pi p_a) for k below `octaves`, then cos(2^k pi p_a) [Mildenhall2020, Eq. 4].

    Within sines and cosines the octave is the outer index and the coordinate the inner one.

    Attributes:
        octaves: 0 to 24; with 0 of them points stay as they are.
        dimensions: coordinates of a point.
    """

    def __init__(self, octaves: int, *, dimensions: int = 3) -> None:
        """State the size.

        Args:
            octaves: 0 to 24.
            dimensions: coordinates of a point.

        Raises:
            RangeError: octaves outside of 0 to 24, or no dimension.
        """
        _require("FrequencyEncoding", "octaves", octaves, 0, MAX_OCTAVES)
        _require("FrequencyEncoding", "dimensions", dimensions, 1, 1024)
        self.octaves, self.dimensions = octaves, dimensions

    @property
    def outputs(self) -> int:
        """Numbers that a point becomes."""
        return self.dimensions * (1 + 2 * self.octaves)

    def encode(self, points: Array) -> Array:
        """Features (N, outputs) of points (N, dimensions), float32 or float64.

        Raises:
            ShapeError, DtypeError, RangeError: other arrays, or points that are not finite.
        """
        call = Arguments("FrequencyEncoding.encode")
        points = call.array("points", points, ("N", self.dimensions))
        features = np.empty((len(points), self.outputs), points.dtype)
        call.run(_core.frequency_encode, points, self.octaves, features)
        return features

    def encode_backward(self, points: Array, d_features: Array) -> Array:
        """Derivatives (N, dimensions) of a loss with respect to the points.

        Args:
            points: (N, dimensions), float32 or float64.
            d_features: (N, outputs), derivatives of the loss with respect to the features.

        Raises:
            ShapeError, DtypeError, RangeError: other arrays, or points that are not finite.
        """
        call = Arguments("FrequencyEncoding.encode_backward")
        points = call.array("points", points, ("N", self.dimensions))
        d_features = call.array("d_features", d_features, ("N", self.outputs), finite=False)
        d_points = np.zeros_like(points)
        call.run(_core.frequency_encode_backward, points, self.octaves, d_features, d_points)
        return d_points


@typed_call
class OneBlobEncoding:
    """A Gaussian around each coordinate, one bin wide, at the centers of `bins` bins of [0, 1].

    [Mueller2019, Sec. 4.3]: exp(-K^2 (c_i - p)^2 / 2) at c_i = (i + 1/2) / K.

    Attributes:
        bins: K, 1 to 256.
        dimensions: coordinates of a point.
    """

    def __init__(self, bins: int, *, dimensions: int = 3) -> None:
        """State the size.

        Args:
            bins: 1 to 256, over [0, 1].
            dimensions: coordinates of a point.

        Raises:
            RangeError: bins outside of 1 to 256, or no dimension.
        """
        _require("OneBlobEncoding", "bins", bins, 1, MAX_BINS)
        _require("OneBlobEncoding", "dimensions", dimensions, 1, 1024)
        self.bins, self.dimensions = bins, dimensions

    @property
    def outputs(self) -> int:
        """Numbers that a point becomes."""
        return self.dimensions * self.bins

    def encode(self, points: Array) -> Array:
        """Features (N, outputs) of points (N, dimensions), float32 or float64.

        Raises:
            ShapeError, DtypeError, RangeError: other arrays, or points that are not finite.
        """
        call = Arguments("OneBlobEncoding.encode")
        points = call.array("points", points, ("N", self.dimensions))
        features = np.empty((len(points), self.outputs), points.dtype)
        call.run(_core.one_blob_encode, points, self.bins, features)
        return features

    def encode_backward(self, points: Array, d_features: Array) -> Array:
        """Derivatives (N, dimensions) of a loss with respect to the points.

        Args:
            points: (N, dimensions), float32 or float64.
            d_features: (N, outputs), derivatives of the loss with respect to the features.

        Raises:
            ShapeError, DtypeError, RangeError: other arrays, or points that are not finite.
        """
        call = Arguments("OneBlobEncoding.encode_backward")
        points = call.array("points", points, ("N", self.dimensions))
        d_features = call.array("d_features", d_features, ("N", self.outputs), finite=False)
        d_points = np.zeros_like(points)
        call.run(_core.one_blob_encode_backward, points, self.bins, d_features, d_points)
        return d_points


def _require(function: str, argument: str, got: int, low: int, high: int) -> None:
    if not low <= got <= high:
        raise RangeError(message(function, argument, f"{low} to {high}", got))
