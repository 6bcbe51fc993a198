"""Random numbers without a state: each one is a hash of its address.

The address is (seed, step, pixel, sample, dimension). The hash is Philox4x32-10 [Salmon2011]: ten
rounds of two 32x32 -> 64 bit products mix a 128-bit counter under a 64-bit key. Any number can
therefore be drawn in any order, on any number of threads, and drawn again by a backward pass.

One definition, shared with the compiled core:

    key     = (low 32 bits of seed, high 32 bits of seed)
    counter = (pixel, sample, step, dimension // 4)
    word    = philox4x32(counter, key)[dimension % 4]
    uniform = (word >> 8) * 2**-24          exactly representable in float32, never 1
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .checks import require_integer
from .errors import DtypeError, RangeError, ShapeError, message
from .portable_math import cos, log1p, sin

_MULTIPLIERS = (np.uint64(0xD2511F53), np.uint64(0xCD9E8D57))
_WEYL = (0x9E3779B9, 0xBB67AE85)
_LOW = np.uint64(0xFFFFFFFF)
_HALF = np.uint64(32)
_ROUNDS = 10
_WORDS = 2**32

Address = int | NDArray[Any]
"""An integer or an integer array in 0 .. 2**32 - 1."""


def philox4x32(counter: NDArray[np.uint32], key: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Hash counters under keys with ten Philox rounds [Salmon2011].

    Args:
        counter: (..., 4) uint32.
        key: (..., 2) uint32; leading axes broadcast against those of `counter`.

    Returns:
        (..., 4) uint32, each word uniform over all 2**32 values.

    Raises:
        DtypeError, ShapeError: not uint32, or wrong last axis.
    """
    for name, array, width in (("counter", counter, 4), ("key", key, 2)):
        if not isinstance(array, np.ndarray) or array.dtype != np.uint32:
            got = getattr(array, "dtype", type(array).__name__)
            raise DtypeError(message("philox4x32", name, "a uint32 array", got))
        if array.ndim == 0 or array.shape[-1] != width:
            expected = f"shape (..., {width})"
            raise ShapeError(message("philox4x32", name, expected, array.shape))
    lead = np.broadcast_shapes(counter.shape[:-1], key.shape[:-1])
    words = [np.broadcast_to(counter[..., i], lead).astype(np.uint64) for i in range(4)]
    keys = [key[..., i].astype(np.uint64) for i in range(2)]
    for turn in range(_ROUNDS):
        first = words[0] * _MULTIPLIERS[0]
        second = words[2] * _MULTIPLIERS[1]
        key_0 = (keys[0] + np.uint64(turn * _WEYL[0])) & _LOW
        key_1 = (keys[1] + np.uint64(turn * _WEYL[1])) & _LOW
        words = [
            (second >> _HALF) ^ words[1] ^ key_0,
            second & _LOW,
            (first >> _HALF) ^ words[3] ^ key_1,
            first & _LOW,
        ]
    return np.stack(words, axis=-1).astype(np.uint32)


def random_words(
    seed: int, *, step: Address, pixel: Address, sample: Address, dimension: Address
) -> NDArray[np.uint32]:
    """The raw 32-bit word at each address; the addresses broadcast against each other."""
    key = _key("random_words", seed)
    named = {"pixel": pixel, "sample": sample, "step": step, "dimension": dimension}
    parts = [_address("random_words", name, value) for name, value in named.items()]
    shape = np.broadcast_shapes(*(part.shape for part in parts))
    parts = [np.broadcast_to(part, shape) for part in parts]
    lane = parts[3] & np.uint32(3)
    counter = np.stack([parts[0], parts[1], parts[2], parts[3] >> np.uint32(2)], axis=-1)
    words = philox4x32(counter, key)
    picked: NDArray[np.uint32] = np.take_along_axis(words, lane[..., None], axis=-1)[..., 0]
    return picked


def uniform(
    seed: int, *, step: Address = 0, pixel: Address = 0, sample: Address = 0, dimension: Address = 0
) -> NDArray[np.float64]:
    """Uniform numbers in [0, 1) with 24 bits each, so that float32 holds them exactly.

    Args:
        seed: 0 .. 2**64 - 1.
        step, pixel, sample, dimension: addresses in 0 .. 2**32 - 1, broadcast together.

    Returns:
        float64 of the broadcast shape; an array of shape () for four plain integers.

    Raises:
        DtypeError, RangeError: an address is not an integer, or out of range.
    """
    words = random_words(seed, step=step, pixel=pixel, sample=sample, dimension=dimension)
    return np.asarray((words >> np.uint32(8)) * np.float64(2.0**-24))


def normal_vectors(
    seed: int, *, step: int = 0, row: Address = 0, sample: int = 0
) -> NDArray[np.float64]:
    """(N, 3) normally distributed numbers, mean 0 and variance 1, three for each row.

    The four words at pixel = row, dimension = 0 .. 3 make two pairs of a radius and an angle
    [Box1958]; the last of their four numbers is not used. None is farther out than 5.8, since a
    uniform number is 0 or at least 2**-24.

    Args:
        seed: 0 .. 2**64 - 1.
        row: (N,) integers in 0 .. 2**32 - 1.
        step, sample: addresses.

    Raises:
        DtypeError, RangeError: as for `uniform`.
    """
    address = _address("normal_vectors", "row", row).reshape(-1)
    rest = [_address("normal_vectors", n, v) for n, v in (("sample", sample), ("step", step))]
    columns = [address, *(np.broadcast_to(part, address.shape) for part in rest)]
    counter = np.stack([*columns, np.zeros_like(address)], axis=-1)
    words = philox4x32(counter, _key("normal_vectors", seed))
    u = (words >> np.uint32(8)) * np.float64(2.0**-24)
    radius = np.sqrt(-2.0 * log1p(-u[:, 0::2]))
    angle = 2.0 * np.pi * u[:, 1::2]
    pairs = np.stack([radius * cos(angle), radius * sin(angle)], axis=-1)
    return pairs.reshape(-1, 4)[:, :3]


def uniform_int(
    seed: int,
    bound: int,
    *,
    step: Address = 0,
    pixel: Address = 0,
    sample: Address = 0,
    dimension: Address = 0,
) -> NDArray[np.int64]:
    """Integers in 0 .. bound - 1 as (word * bound) >> 32 [Lemire2019], without its rejection.

    One word is spent on each number, so that its address stays fixed; the probability of a value
    is therefore off by at most 2**-32, which matters for no `bound` that counts pixels.

    Raises:
        DtypeError, RangeError: `bound` outside 1 .. 2**32, or a bad address.
    """
    bound = require_integer("uniform_int", "bound", bound, least=1, most=_WORDS)
    words = random_words(seed, step=step, pixel=pixel, sample=sample, dimension=dimension)
    scaled = words.astype(np.uint64) * np.uint64(bound) >> _HALF
    return np.asarray(scaled).astype(np.int64)


def permutation(seed: int, count: int, *, step: int = 0, dimension: int = 0) -> NDArray[np.int64]:
    """A random order of 0 .. count - 1: the indices sorted by one 64-bit hash each.

    Entry i is hashed at pixel = i, from the two words at `dimension` and `dimension` + 1.
    """
    count = require_integer("permutation", "count", count, least=0, most=_WORDS)
    index = np.arange(count, dtype=np.int64)
    high = random_words(seed, step=step, pixel=index, sample=0, dimension=dimension)
    low = random_words(seed, step=step, pixel=index, sample=0, dimension=dimension + 1)
    keys = (high.astype(np.uint64) << _HALF) | low.astype(np.uint64)
    return np.argsort(keys, kind="stable").astype(np.int64)


def choice(
    seed: int, population: int, count: int, *, step: int = 0, dimension: int = 0
) -> NDArray[np.int64]:
    """`count` different indices out of 0 .. population - 1, in random order: pixels of one step.

    A small part of a large population is drawn with `uniform_int` at pixel = 0, 1, 2, ..., each
    value kept at its first appearance; a large part is the beginning of a `permutation`.

    Raises:
        RangeError: `count` exceeds `population`.
    """
    population = require_integer("choice", "population", population, least=0, most=_WORDS)
    count = require_integer("choice", "count", count, least=0, most=population)
    if 4 * count > population:
        return permutation(seed, population, step=step, dimension=dimension)[:count]
    drawn = np.empty(0, dtype=np.int64)
    while True:
        _, first = np.unique(drawn, return_index=True)
        if first.size >= count:
            return drawn[np.sort(first)[:count]]
        start = drawn.size
        pixel = np.arange(start, start + count + count // 4 + 8, dtype=np.int64)
        more = uniform_int(seed, population, step=step, pixel=pixel, dimension=dimension)
        drawn = np.concatenate([drawn, more])


def _key(function: str, seed: int) -> NDArray[np.uint32]:
    seed = require_integer(function, "seed", seed, least=0, most=2**64 - 1)
    return np.array([seed & 0xFFFFFFFF, seed >> 32], dtype=np.uint32)


def _address(function: str, name: str, value: Address) -> NDArray[np.uint32]:
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        raise DtypeError(message(function, name, "integers", array.dtype))
    if array.size and (int(array.min()) < 0 or int(array.max()) >= _WORDS):
        got = f"{int(array.min())} .. {int(array.max())}"
        raise RangeError(message(function, name, "addresses in 0 .. 2**32 - 1", got))
    return array.astype(np.uint32)
