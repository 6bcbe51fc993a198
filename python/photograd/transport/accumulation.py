"""Sums of samples: a picture that more can be added to, how sure it is, and where more should go.

Where samples go (`sample_counts`): a derivative is a sum over pixels of d_p times the mean of that
pixel's n_p paths, so that its variance is the sum of d_p^2 s_p^2 / n_p, s_p being the spread of one
path's part. For a given sum of n_p it is least where n_p grows as |d_p| s_p. s_p is not known, but
d_p is, and for a loss of squares few pixels (a highlight, the rim of a light) hold most of it.

Whatever n_p is, the mean of the estimate stays, as long as n_p knows nothing of these very paths:
it may follow d_image, which comes from other paths.
"""

from __future__ import annotations

import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from photograd_course.atomic_io import atomic_write
from photograd_course.color import srgb_encode

from photograd._arrays import Arguments
from photograd._checks import typed
from photograd._files import read_npz
from photograd._notebook import png, smaller
from photograd._typed import typed_call
from photograd.errors import Error, IoError, RangeError, message
from photograd.types import Array

VERSION = 1


@typed_call
@dataclass(eq=False)
class Accumulation:
    """Samples of every pixel, summed up.

    Attributes:
        radiance: (H, W, 3) float64, sum over samples.
        squares: (H, W, 3) float64, sum over samples of the squared radiance.
        count: samples of each pixel.
    """

    radiance: Array
    squares: Array
    count: int = 0

    @classmethod
    def empty(cls, height: int, width: int) -> Accumulation:
        """No samples yet.

        Args:
            height, width: of the picture, in pixels.

        Raises:
            RangeError: more pixels than there is memory for.
        """
        try:
            return cls(np.zeros((height, width, 3)), np.zeros((height, width, 3)))
        except MemoryError as failure:
            expected, got = "a picture that fits into memory", f"{width} x {height} pixels"
            raise RangeError(message("Accumulation", "size", expected, got)) from failure

    @property
    def mean(self) -> Array:
        """The picture, (H, W, 3) linear radiance.

        Raises:
            RangeError: no samples.
        """
        if self.count < 1:
            raise RangeError(message("Accumulation.mean", "count", "at least 1 sample", 0))
        mean: Array = self.radiance / self.count
        return mean

    def _repr_png_(self) -> bytes | None:
        """The picture in display values, small; nothing before the first sample."""
        return png(srgb_encode(smaller(self.mean))) if self.count else None

    @property
    def standard_error(self) -> Array:
        """(H, W, 3) estimated standard deviation of `mean`, for independent samples.

        Even samples (`PathOptions.sampler`) have about the same spread, and a mean that errs less.

        Raises:
            RangeError: fewer than two samples: one says nothing about its spread.
        """
        if self.count < 2:
            expected = "at least 2 samples"
            raise RangeError(message("standard_error", "count", expected, self.count))
        variance = self.squares / self.count - self.mean**2
        error: Array = np.sqrt(np.maximum(variance, 0.0) / (self.count - 1))
        return error

    @property
    def noise(self) -> float:
        """The standard error's root mean square as a part of the mean of |mean|; 0 if black."""
        level = float(np.abs(self.mean).mean())
        return float(np.sqrt(np.square(self.standard_error).mean())) / level if level > 0 else 0.0

    def check_call(
        self,
        function: str,
        shape: tuple[int, int],
        count: int,
        *,
        name: str = "sums",
        many: str = "spp",
    ) -> None:
        """Check a call that adds samples to these sums; its arguments are called so.

        Args:
            function: that was called, for errors.
            shape: (H, W) that the sums must have.
            count: samples to be added.
            name: of the argument that is these sums.
            many: of the argument that is the count.

        Raises:
            DtypeError, RangeError: a count that is no whole number, or below 1.
            ShapeError: sums of another shape than (H, W).
        """
        call = Arguments(function, np.float64)
        call.integer(many, count, low=1)
        call.array(name, self.radiance, (*shape, 3), finite=False)

    def check_finite(self, function: str) -> None:
        """Raise Error that names the first pixel with a sum that is not finite.

        Args:
            function: on whose behalf the error speaks.
        """
        if not np.isfinite(self.radiance).all():
            row, column = np.argwhere(~np.isfinite(self.radiance))[0][:2]
            got = f"a value that is not, first in pixel ({column}, {row})"
            raise Error(message(function, "radiance", "finite values", got))

    def save(self, path: Path, key: dict[str, Any]) -> None:
        """Write the sums and `key`, which says what they belong to; the file is replaced at once.

        Args:
            path: of the file.
            key: plain values, as JSON has them.

        Raises:
            IoError: the file cannot be written.
        """
        meta = json.dumps({"version": VERSION, "count": self.count, "key": key}, sort_keys=True)
        buffer = io.BytesIO()
        np.savez(buffer, radiance=self.radiance, squares=self.squares, meta=np.array(meta))
        atomic_write(path, buffer.getvalue())


def load_accumulation(path: Path, key: dict[str, Any]) -> Accumulation:
    """The sums that `Accumulation.save` wrote for the same key.

    Args:
        path: of the file.
        key: that the file must have.

    Raises:
        IoError: missing or damaged, or of another scene, seed or options.
    """
    expected = "sums of an interrupted rendering"
    if not path.exists():
        raise IoError(message("load_accumulation", "path", expected, f"no {path}"))
    names = ("radiance", "squares", "meta")
    arrays = read_npz("load_accumulation", path, names, expected=expected)
    radiance, squares = arrays["radiance"], arrays["squares"]
    try:
        meta = json.loads(str(arrays["meta"]))
        count, found, version = int(meta["count"]), meta["key"], meta["version"]
    except (KeyError, TypeError, ValueError, RecursionError) as failure:
        raise IoError(message("load_accumulation", f"{path}", expected, failure)) from failure
    if version != VERSION or found != json.loads(json.dumps(key)):
        differing = (
            sorted(
                name
                for name in {*found, *key}
                if found.get(name) != json.loads(json.dumps(key)).get(name)
            )
            if isinstance(found, dict)
            else ["key"]
        )
        raise IoError(
            message(
                "load_accumulation",
                f"{path}",
                "sums of this very rendering",
                f"others: {', '.join(differing) or 'version'} differ",
                "leave --resume away",
            )
        )
    shape = radiance.shape
    sound = radiance.ndim == 3 and shape[2] == 3 and squares.shape == shape and count >= 0
    if not sound or radiance.dtype != np.float64 or squares.dtype != np.float64:
        got = f"shapes {shape} and {squares.shape}"
        raise IoError(message("load_accumulation", f"{path}", "two (H, W, 3) float64 arrays", got))
    return Accumulation(radiance, squares, count)


# Where the paths of a derivative go: as many to each pixel, or more to those that matter.


Spread = Literal["uniform", "cotangent"]
UNIFORM_SHARE = 0.25
"""Of all paths: a pixel may hide a large s_p behind a small d_p, so that none goes without."""
PAIR_UNIFORM_SHARE = 0.75
"""The same where the paths serve the picture as well."""
AROUND = 2
"""Pixels to each side that are asked how much they vary; a pilot's few paths say little of one."""
MOST = 64
"""Times `spp`, so that one pixel does not keep one thread busy alone."""


def sample_counts(d_image: Array, spp: int, spread: Spread) -> Array | None:
    """Paths of each pixel, (H, W) uint32, at least 1; None where all have `spp`.

    Args:
        d_image: dL/dimage (H, W, 3).
        spp: paths a pixel, on average; the sum is off by the rounding of each pixel.
        spread: "uniform", or "cotangent" for more where the loss looks.

    Raises:
        RangeError: another spread.
    """
    typed("PathTracer.render_backward", "spread", Spread, spread)
    size = np.abs(np.asarray(d_image, np.float64)).sum(axis=-1)
    return None if spread == "uniform" else _dealt(size, spp, UNIFORM_SHARE)


def pair_counts(pilot: Accumulation, d_image: Array, spp: int, spread: Spread) -> Array | None:
    """The same for two pictures that are each other's cotangent, as in `dual_buffer_loss`.

    A pixel's paths serve its derivative, where |d_p| s_p says how many are wanted, and its picture,
    whose noise tells most where d_p may be small. So most are dealt out evenly, and the others by
    |d_p| s_p, s_p being how much the radiance of the pilot's paths varies around the pixel.

    Args:
        pilot: a picture of a few other paths, two at least.
        d_image: dL/dimage (H, W, 3) as that picture says.
        spp: paths a pixel, on average.
        spread: "uniform", or "cotangent" for more where the loss looks.

    Raises:
        RangeError: another spread.
    """
    if spread == "uniform":
        return None
    variance = np.maximum(pilot.squares / pilot.count - pilot.mean**2, 0.0).sum(axis=-1)
    size = np.sqrt(variance) * np.abs(d_image).sum(axis=-1)
    edges = np.pad(size, AROUND, mode="edge")
    around = sliding_window_view(edges, (2 * AROUND + 1, 2 * AROUND + 1)).mean(axis=(2, 3))
    return _dealt(around, spp, PAIR_UNIFORM_SHARE)


def _dealt(size: Array, spp: int, even_share: float) -> Array | None:
    """Counts of which `even_share` is even and the rest in proportion to `size` (H, W)."""
    mean = size.mean()
    if not 0 < mean < np.inf:
        return None
    wanted = spp * (even_share + (1 - even_share) * size / mean)
    counts: Array = np.clip(np.rint(wanted), 1, MOST * spp).astype(np.uint32)
    return counts
