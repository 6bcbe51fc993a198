"""What a capture is: posed photographs, split into training and held-out views."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._notebook import EDGE, as_html, png_of_sheet, sheet
from photograd._typed import typed_call
from photograd.capture.view import View
from photograd.errors import IoError, RangeError, message
from photograd.images.read import ColorSpace
from photograd.types import FloatArray

HOLD_OUT_EVERY = 8
"""Every eighth photograph, starting with the first: the custom since [Mildenhall2019]."""


THUMBNAILS = 8
"""Photographs that a notebook shows of a capture."""

Split: TypeAlias = tuple[tuple[View, ...], tuple[View, ...], str]
"""Training views, test views, and a sentence for the log."""


def hold_out(views: Sequence[View]) -> Split:
    """Training and test views by their rank in the order of names; a single one is not held out."""
    ordered = sorted(views, key=lambda view: view.name)
    if len(ordered) < 2:
        return tuple(ordered), (), "no view held out: there is only one"
    test = tuple(ordered[::HOLD_OUT_EVERY])
    train = tuple(view for index, view in enumerate(ordered) if index % HOLD_OUT_EVERY)
    line = (
        f"no split in the file: every {HOLD_OUT_EVERY}th view by name is held out, "
        f"starting with the first ({len(train)} train, {len(test)} test)"
    )
    return train, test, line


# What a capture is: posed photographs, split into training and held-out views.


@typed_call
@dataclass(frozen=True, eq=False)
class Capture:
    """Posed photographs of one scene, in the world frame of the project.

    Attributes:
        train, test, val: views; test and val are never fitted to.
        format: name of the file format that it came from.
        source: folder or file that it was loaded from.
        color_space: of all views.
        has_alpha: every view carries alpha.
        background: linear or display (3,) color to composite over, as `color_space` says; None if
            there is no alpha.
        points, point_colors: sparse points (N, 3) in the world of the cameras, and their 8-bit
            display colors (N, 3), from formats that have them: COLMAP, OpenSfM, and nerfstudio
            with a ply_file_path. There may be points without colors.
        bounds: (2, 3) lower and upper corner that the file declares, else None.
        depth_range: nearest and farthest depth that the file declares, else None.
        world_from_source: (4, 4) turn from the file's world into ours.
        conversions: what was converted or assumed, one sentence each, for the log.
    """

    train: tuple[View, ...]
    test: tuple[View, ...]
    format: str
    source: Path
    color_space: ColorSpace
    has_alpha: bool
    val: tuple[View, ...] = ()
    background: tuple[float, float, float] | None = None
    points: FloatArray | None = None
    point_colors: npt.NDArray[np.uint8] | None = None
    bounds: FloatArray | None = None
    depth_range: tuple[float, float] | None = None
    world_from_source: FloatArray = field(default_factory=lambda: np.eye(4))
    conversions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.train:
            got = "an empty capture"
            raise IoError(message("Capture", str(self.source), "at least one training view", got))
        name, count = Counter(view.name for view in self.views).most_common(1)[0]
        if count > 1:
            got = f"{name!r} {count} times"
            raise IoError(message("Capture", str(self.source), "different names of views", got))
        self._check_points()
        if self.bounds is not None:
            Arguments("Capture", np.float64).box("bounds", self.bounds)

    def _check_points(self) -> None:
        call = Arguments("Capture")
        points = np.zeros((0, 3)) if self.points is None else self.points
        call.array("points", points, ("N", 3), finite=False)
        if self.point_colors is not None:
            colors = call.array("point_colors", self.point_colors, ("N", 3), dtype=np.uint8)
            object.__setattr__(self, "point_colors", colors)

    def _repr_html_(self) -> str:
        """What it is, and some of its photographs. One that cannot be read is named instead."""
        views = self.views[:: -(-len(self.views) // THUMBNAILS)]
        sizes = sorted({f"{view.camera.width} x {view.camera.height}" for view in self.views})
        facts: dict[str, object] = {
            "source": f"{self.source} ({self.format})",
            "views": f"{len(self.train)} to learn from, {len(self.test)} held out",
            "pixels": ", ".join(sizes[:3]) + (", ..." if len(sizes) > 3 else ""),
            "values": f"{self.color_space}, {'with' if self.has_alpha else 'without'} alpha",
            "points": 0 if self.points is None else f"{len(self.points):,}",
        }
        picture = None
        try:
            shown = [view.thumbnail(EDGE // 2) for view in views]
            picture = png_of_sheet(sheet(shown, 4, EDGE // 2))
        except IoError as failure:
            facts["photographs"] = failure
        return as_html("Capture", facts, picture)

    @property
    def views(self) -> tuple[View, ...]:
        """All views: training, validation, test."""
        return self.train + self.val + self.test

    def split_hash(self) -> str:
        """Twelve hexadecimal digits that two captures share only if their splits agree by name."""
        lines = [f"{kind} {view.name}" for kind in ("train", "test") for view in self._split(kind)]
        text = "\n".join(lines).encode("utf-8", "surrogatepass")
        return hashlib.sha256(text).hexdigest()[:12]

    def _split(self, kind: str) -> tuple[View, ...]:
        return self.train if kind == "train" else self.test

    def with_line(self, line: str) -> Capture:
        """The same capture with one more sentence in its log.

        Args:
            line: a sentence.
        """
        return replace(self, conversions=(*self.conversions, line))

    def with_validation_split(self) -> Capture:
        """The training views alone, every eighth of them held out; the test views are put away.

        For choosing a resolution or another option: a choice that looked at the test views would
        make their score say more than it knows.

        Raises:
            RangeError: fewer than two training views.
        """
        train, test, _ = hold_out(self.train)
        if not test:
            raise RangeError(
                message("with_validation_split", "capture", "two training views or more", "one")
            )
        line = (
            f"{len(test)} training views held out to choose by, {len(self.test)} test views unseen"
        )
        return replace(self, train=train, test=test, val=(), conversions=(*self.conversions, line))

    def downscaled(self, factor: int) -> Capture:
        """The same capture with every image reduced by an integer box average.

        Raises:
            RangeError: factor below 1 or larger than the smallest image.
        """
        if factor == 1:
            return self
        smaller = replace(
            self,
            train=tuple(view.downscaled(factor) for view in self.train),
            val=tuple(view.downscaled(factor) for view in self.val),
            test=tuple(view.downscaled(factor) for view in self.test),
        )
        sizes = {(view.camera.width, view.camera.height) for view in self.views}
        cut = sorted(f"{w} x {h}" for w, h in sizes if w % factor or h % factor)
        rest = f", rest of {', '.join(cut)} cut off at right and bottom" if cut else ""
        line = f"images reduced by a {factor} x {factor} box average in premultiplied alpha{rest}"
        return smaller.with_line(line)

    def subsample(self, count: int) -> Capture:
        """The same capture with at most `count` views in each split, evenly spaced in their order.

        Raises:
            RangeError: count below 1.
        """
        count = Arguments("Capture.subsample").integer("count", count, low=1)
        line = f"at most {count} views of each split kept, evenly spaced"
        return replace(
            self,
            train=evenly_spaced(self.train, count),
            val=evenly_spaced(self.val, count),
            test=evenly_spaced(self.test, count),
            conversions=(*self.conversions, line),
        )


def evenly_spaced(views: Sequence[View], count: int) -> tuple[View, ...]:
    """At most `count` of the views, the first always among them."""
    if len(views) <= count:
        return tuple(views)
    return tuple(views[index * len(views) // count] for index in range(count))
