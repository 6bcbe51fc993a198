"""What W2 and W3 share: the room, and how far an estimate is from a reference.

An estimate's variance falls as one over its samples, so seconds times the squared error says what a
program makes of its time: it is the time to an error of 1, whatever the number of samples.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import _common
import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.transport import PathOptions, PathTracer
from photograd.transport.metal_room import metal_room

Array = NDArray[Any]
# Other programs call the metal ball "simple"; their scripts take the same words.
BALLS = {"principled": "principled", "simple": "metal"}


def options(description: str, *, spp: int, reference: str) -> argparse.ArgumentParser:
    """Sizes, the ball, where paths may end by chance, and the file of the reference."""
    parser = _common.options(description, res=256, spp=spp, depth=8, roulette=2)
    parser.add_argument("--sphere", choices=sorted(BALLS), default="principled")
    parser.add_argument("--sampler", choices=("sobol", "independent"), default="sobol")
    parser.add_argument("--reference", default="", help=reference)
    return parser


def tracer(args: argparse.Namespace) -> tuple[PathTracer, PathOptions]:
    """The room, ready; and the options of the path tracer."""
    _core.set_thread_count(args.threads)
    late = args.roulette if args.roulette > 0 else None
    options = PathOptions(max_depth=args.depth, roulette_from=late, sampler=args.sampler)
    return PathTracer(metal_room(args.res, BALLS[args.sphere])), options


def size(args: argparse.Namespace) -> dict[str, Any]:
    """What must be alike. Where paths end by chance is a program's own choice."""
    return {"res": args.res, "spp": args.spp, "depth": args.depth, "sphere": args.sphere}


def reference(path: str, suffix: str = "") -> Array | None:
    """An array, float64; None where no file is named."""
    if not path:
        return None
    file = Path(path.removesuffix(".npy") + suffix + ".npy")
    return np.asarray(np.load(file), np.float64)
