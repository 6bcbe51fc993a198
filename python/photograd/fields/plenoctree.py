"""PlenOctrees: a fitted field of networks, tabulated into the leaves of an octree [Yu2021]."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal, Self

import numpy as np

from photograd._arrays import Arguments
from photograd._fit_options import MAX_DEGREE
from photograd.capture.capture import Capture
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import cubic_voxels
from photograd.fields.neural_field import NeuralField
from photograd.fields.octree_leaves import Leaves
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.tabulate import cells_in_reach, radiance_of, tabulated
from photograd.representation import RayBatch, Start, register
from photograd.types import Array

VISIBILITY_RAYS = 1 << 22
"""Of all training views, that say which leaves are visible. A cell may be smaller than a pixel: far
fewer rays than the photographs have would miss some of those that are seen."""


@register
class PlenOctree(OctreeSh):
    """An octree of harmonics whose leaves are read from a field of networks, and refined.

    Parameters and rendering are those of `OctreeSh`: no network is left.
    """

    name: ClassVar[str] = "plenoctree"
    fit_defaults: ClassVar[Mapping[str, Any]] = {"resolution": 192, "prune": 0.01}
    fit_options: ClassVar[frozenset[str]] = frozenset({"degree", "prune"})
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "required"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("hash_grid", "nerf")
    same_resolution: ClassVar[bool] = False
    first_model_help: ClassVar[str] = (
        "fit a hash_grid or a nerf first, and start from that (--start-from)"
    )

    @classmethod
    def from_field(
        cls,
        field: NeuralField,
        resolution: int,
        capture: Capture | None = None,
        *,
        degree: int = 2,
        opacity: float = 0.01,
        prune: float = 0.01,
    ) -> Self:
        """Tabulate a field of networks: cubic cells that are visible become leaves.

        Args:
            field: that was fitted.
            resolution: cells along the longest edge of its box.
            capture: leaves stay that have a weight in a training view; None keeps all.
            degree: of the harmonics, 0 to 3.
            opacity: cells that are less opaque than this, along their edge, become empty.
            prune: least weight of a leaf that stays.

        Raises:
            RangeError: another degree, or a field that is empty everywhere.
        """
        call = Arguments("PlenOctree.from_field")
        call.integer("degree", degree, low=0, high=MAX_DEGREE)
        corners = field.box.astype(np.float64)
        x, y, z = cubic_voxels(corners[1] - corners[0], resolution)
        shape = x, y, z
        edge = float((corners[1] - corners[0]).max()) / resolution
        box = np.stack([corners[0], corners[0] + edge * np.array(shape)])
        kind = field.params["density"].dtype

        def weights(leaves: Leaves) -> Array:
            if capture is None:
                return np.ones(len(leaves.density))
            bare = cls._of_leaves(leaves, kind, 1 / edge)
            return bare.greatest_weights(_training_rays(capture))

        leaves = tabulated(
            radiance_of(field, edge / 8),
            box,
            shape,
            degree=degree,
            opacity=opacity,
            weights=weights,
            least=prune,
            reach=cells_in_reach(field, box, shape),
        )
        if not len(leaves.density):
            expected = f"a field with cells more opaque than {opacity} in sight of a view"
            raise RangeError(message("PlenOctree.from_field", "field", expected, "none"))
        return cls._of_leaves(leaves, kind, 1 / edge)

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """The leaves of a field of networks that was fitted before.

        Raises RangeError for another field.
        """
        options, field = start.options, start.field
        if not isinstance(field, NeuralField):
            expected = f"a model of {' or '.join(cls.first_model_kinds)}"
            got = "none" if field is None else repr(field.name)
            raise RangeError(message("Fit.start", "start_from", expected, got))
        tree = cls.from_field(
            field, options.resolution, start.capture, degree=options.degree, prune=options.prune
        )
        return tree, tree._sentence()


def _training_rays(capture: Capture) -> Iterator[RayBatch]:
    """Rays of all training views, evenly spaced, about `VISIBILITY_RAYS` of them."""
    pixels = sum(view.camera.width * view.camera.height for view in capture.train)
    stride = max(1, -(-pixels // VISIBILITY_RAYS))
    for view in capture.train:
        chosen = np.arange(0, view.camera.width * view.camera.height, stride)
        yield RayBatch(*view.camera.rays(chosen), chosen.astype(np.uint32))
