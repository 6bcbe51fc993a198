"""An octree whose leaves hold one density and one set of spherical-harmonic coefficients each.

The structure half of PlenOctrees [Yu2021]: topology comes from a field that is known already and
stays fixed; the leaves are parameters like any other. A ray meets leaf after leaf, in each of which
everything is constant, so that emission and absorption along it need no quadrature, and the camera
adjoint is exact: no sample hides a border that moves. The mathematics is in
cpp/photograd/render/march/octree_sh.h.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from photograd_course.random import uniform

from photograd import sh
from photograd._arrays import Arguments
from photograd._checkpoint import Row
from photograd._checks import from_plain
from photograd._compiled import _core
from photograd._fit_options import FitOptions
from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.march import cotangent_arrays
from photograd.fields.octree_leaves import Leaves, TreePolicy, leaves_of_grid, leaves_of_voxels
from photograd.fields.sparse_sh import SparseSh
from photograd.fields.voxel_field import VoxelField, harmonic_rows
from photograd.grids.octree import Octree, tree_of_leaves
from photograd.representation import Outputs, ParamSpec, RayBatch, RenderOptions, Start, register
from photograd.types import Array


@dataclass(frozen=True)
class OctreeContext:
    """What the backward pass needs: O(1) per ray."""

    parameters: tuple[Array, Array, Array]
    rays: tuple[Array, Array, Array]
    stop: float
    image: tuple[Array, Array, Array]
    camera_adjoint: bool


@register
class OctreeSh(VoxelField):
    """params["density"] (N,) raw and params["sh"] (N, K, 3), a row for each leaf that is not empty.

    sigma_t = density_scale * softplus(density) in 1/m, rgb = sigmoid(sum_k Y_k(direction) sh_k),
    linear Rec. 709; direction is that of the ray, away from the camera. `row` (L,) says which row a
    leaf of `tree` has, -1 for none.
    """

    name: ClassVar[str] = "octree_sh"
    fit_options: ClassVar[frozenset[str]] = frozenset({"degree"})
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "required"
    first_model_kinds: ClassVar[tuple[str, ...]] = ("dense_grid", "sparse_sh", "dense_sh")
    first_model_help: ClassVar[str] = (
        "fit a dense_grid or a sparse_sh first, and start from that (--start-from)"
    )
    keeps_background: ClassVar[bool] = True
    rays_at_once: ClassVar[int] = 1 << 15  # each keeps numbers of every leaf that it crosses
    starts_empty: ClassVar[bool] = False
    gradient_note: ClassVar[str] = "Each cell of a leaf shows the gradient of the whole leaf."

    def __init__(
        self,
        tree: Octree,
        row: NDArray[np.int32],
        density: Array,
        coefficients: Array,
        *,
        density_scale: float = 1.0,
    ) -> None:
        """Raises ShapeError unless the arrays fit the tree, RangeError for rows that do not.

        Args:
            tree: where the leaves are.
            row: of each leaf; -1 for empty ones.
            density: (N,) raw.
            coefficients: (N, K, 3) of the harmonics.
            density_scale: extinction in 1/m of an activated density of 1.
        """
        row = Arguments("OctreeSh").array("row", row, (len(tree.values),), dtype=np.int32, low=-1)
        rows = int((row >= 0).sum())
        if not np.array_equal(np.sort(row[row >= 0]), np.arange(rows)):
            raise RangeError(message("OctreeSh", "row", "each of 0, 1, ... once, or -1", "others"))
        call = Arguments("OctreeSh")
        density = call.array("density", density, (rows,), finite=False)
        coefficients = call.array("sh", coefficients, (rows, "K", 3), finite=False)
        sh.degree_of(coefficients.shape[1])  # refuses a K that is no square
        self.tree = tree
        self.row = row
        self.params = {"density": density, "sh": coefficients}
        self.density_scale = density_scale

    @classmethod
    def from_dense_grid(
        cls, field: DenseGrid, *, degree: int = 2, opacity: float = 0.01, tolerance: float = 0.05
    ) -> Self:
        """Tabulate a dense grid: its voxels become leaves, and equal ones share a larger leaf.

        Args:
            field: its sigma_t and color are read at the voxels' centers.
            degree: of the harmonics; those above the constant start as 0.
            opacity: voxels that are less opaque than this, along their edge, become empty.
            tolerance: in linear color, and in opacity, that voxels of one leaf may differ by.
        """
        leaves = leaves_of_grid(field, degree=degree, opacity=opacity, tolerance=tolerance)
        return cls._of_leaves(leaves, field.params["values"].dtype, field.policy.density_scale)

    @classmethod
    def from_sparse_sh(
        cls, field: SparseSh, *, degree: int | None = None, opacity: float = 0.01
    ) -> Self:
        """Tabulate a sparse grid: a leaf for each voxel that is seen, large ones between them.

        Args:
            field: read at the centers of its voxels.
            degree: of the harmonics, by default the field's; higher ones start as 0.
            opacity: voxels that are less opaque than this, along their edge, become empty.

        Raises:
            RangeError: the field's activations are not softplus and sigmoid.
        """
        leaves = leaves_of_voxels(field, degree=degree, opacity=opacity)
        return cls._of_leaves(leaves, field.params["sh"].dtype, field.policy.density_scale)

    @classmethod
    def _of_leaves(cls, leaves: Leaves, kind: np.dtype[Any], density_scale: float) -> Self:
        return cls(
            leaves.tree,
            leaves.row,
            leaves.density.astype(kind),
            leaves.sh.astype(kind),
            density_scale=density_scale,
        )

    @classmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """The leaves of a grid that was fitted before.

        Raises RangeError for a field that is no grid.
        """
        degree, field = start.options.degree, start.field
        if isinstance(field, DenseGrid):
            tree = cls.from_dense_grid(field, degree=degree)
        elif isinstance(field, SparseSh):
            tree = cls.from_sparse_sh(field, degree=degree)
        else:
            expected = f"a model of {' or '.join(cls.first_model_kinds)}"
            got = "none" if field is None else repr(field.name)
            raise RangeError(message("Fit.start", "start_from", expected, got))
        return tree, tree._sentence()

    def _sentence(self) -> str:
        leaves, side = len(self.tree.values), self.resolution
        return f"{self.shape[0]:,} of {leaves:,} leaves hold matter, in a tree of {side}³ cells"

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int:
        """From the start: the tree is cut from another model."""
        del options
        return 0

    @classmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """A row of parameters for each leaf with matter; which cube of cells has which."""
        return harmonic_rows(options), {
            "lower": (("int32",), ("L", 3)),
            "side": (("int32",), ("L",)),
            "row": (("int32",), ("L",)),
        }

    @classmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The tree of a checkpoint. Raises ShapeError, RangeError for leaves that fill no cube."""
        del options
        told = from_plain("checkpoint", TreePolicy, policy)
        tree = tree_of_leaves(state["lower"], state["side"], told.box, told.cells)
        row = state["row"]
        if row.shape == (len(tree.values),):  # else refused below
            row = row[tree.values[:, 0].astype(np.int64)]
        return cls(tree, row, params["density"], params["sh"], density_scale=told.density_scale)

    @classmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Self:
        """Leaves of three sizes in 8 x 8 x 8 cells, a third of them empty, degree 2."""
        u = uniform(seed, step=0, pixel=np.arange(8**3), sample=0, dimension=0).reshape(8, 8, 8)
        coarse = u[:2, :2, :2].repeat(4, axis=0).repeat(4, axis=1).repeat(4, axis=2)
        middle = u[2:6, 2:6, 2:6].repeat(2, axis=0).repeat(2, axis=1).repeat(2, axis=2)
        mixed = np.where(coarse < 0.3, coarse, np.where(middle < 0.5, middle, u))
        tree = Octree.from_dense(mixed[..., None], [[-1.0, -0.8, -1.2], [1.0, 1.2, 0.8]])
        chance = uniform(seed, step=1, pixel=np.arange(len(tree.values)), sample=0, dimension=0)
        occupied = chance > 1 / 3
        row = np.where(occupied, np.cumsum(occupied) - 1, -1).astype(np.int32)
        rows = int(occupied.sum())
        numbers = uniform(seed, step=2, pixel=np.arange(rows * 28), sample=0, dimension=0)
        values = (2.0 * numbers - 1.0).reshape(rows, 28).astype(dtype)
        return cls(
            tree,
            row,
            values[:, 0].copy(),
            values[:, 1:].reshape(rows, 9, 3).copy(),
            density_scale=2.0,
        )

    def example_batch(self, *, seed: int) -> RayBatch:
        """24 rays from a sphere of radius 3 m towards points inside of the box."""
        return DenseGrid.example(seed=seed).example_batch(seed=seed)

    @property
    def policy(self) -> TreePolicy:
        """Where the tree stands, and the unit of its densities."""
        low, high = self.tree.bounds.tolist()
        x, y, z = self.tree.shape
        return TreePolicy((tuple(low), tuple(high)), (x, y, z), self.density_scale)

    @property
    def box(self) -> Array:
        """(2, 3) corners of the box in world meters."""
        return self.tree.bounds

    @property
    def shape(self) -> tuple[int, int]:
        """Leaves that are not empty, and the numbers of each."""
        return len(self.params["density"]), 1 + self.params["sh"][0].size

    @property
    def resolution(self) -> int:
        """Cells along the longest edge."""
        return max(self.tree.shape)

    @property
    def voxel_shape(self) -> tuple[int, int, int]:
        """The smallest cells along X, Y and Z."""
        x, y, z = self.tree.shape
        return x, y, z

    def density_rows(self, groups: Mapping[str, Array]) -> Array:
        """(N,) density."""
        return groups["density"]

    def to_voxels(self, rows: Array) -> Array:
        """Rows (N,) as (X, Y, Z): all cells of a leaf have its number, 0 where it has none."""
        of_leaf = np.append(rows, np.zeros(1, rows.dtype))[self.row]  # row -1 is the last
        return self.tree.expand(of_leaf[:, None])[..., 0]

    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Two groups with a row a leaf."""
        shape = {name: array.shape for name, array in self.params.items()}
        return {
            "density": ParamSpec(shape["density"], "1", (-10.0, 1e4), 0.2, "none"),
            "sh": ParamSpec(shape["sh"], "1", (-1e3, 1e3), 0.05, "none"),
        }

    def render(
        self, batch: RayBatch, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, OctreeContext]:
        """Color (R, 3) linear, premultiplied, without background; opacity (R,); depth (R,) m."""
        del seed, step  # nothing random here: no lattice that could be jittered
        rays, parameters = self._rays(batch), self._arrays()
        image = _core.march_octree_sh(self.tree.core, parameters, *self._about(rays, options.stop))
        color, transmittance, depth = image
        outputs = Outputs(color, 1 - transmittance, depth).checked("OctreeSh.render", batch)
        context = OctreeContext(parameters, rays, options.stop, image, options.camera_adjoint)
        return outputs, context

    def render_backward(self, context: OctreeContext, d_outputs: Outputs) -> dict[str, Array]:
        """{"density": (N,), "sh": (N, K, 3)}, and "origins", "directions" (R, 3) if asked.

        Every row adds up its contributions in the order of the rays, in double precision.
        """
        c = context
        _, density, coefficients = c.parameters
        rays, dtype = len(c.rays[0]), density.dtype
        cotangents = cotangent_arrays("OctreeSh.render_backward", d_outputs, rays, dtype)
        gradients = {"density": np.zeros_like(density), "sh": np.zeros_like(coefficients)}
        d_rays = tuple(np.zeros((rays, 3), dtype) for _ in range(2)) if c.camera_adjoint else None
        of_field = self.tree.core, c.parameters, *self._about(c.rays, c.stop)
        d_parameters = gradients["density"], gradients["sh"]
        _core.march_octree_sh_backward(*of_field, c.image, cotangents, d_parameters, d_rays)
        if d_rays is not None:
            gradients["origins"], gradients["directions"] = d_rays
        return gradients

    def greatest_weights(self, batches: Iterable[RayBatch]) -> Array:
        """(N,) the greatest weight that each row has in any of these rays, 0 to 1.

        Args:
            batches: of rays; give all views, as one may see what this one does not.
        """
        weight = np.zeros_like(self.params["density"])
        for batch in batches:
            about = self._about(self._rays(batch), 0.0)
            _core.octree_sh_weights(self.tree.core, self._arrays(), *about, weight)
        return weight

    def _arrays(self) -> tuple[Array, Array, Array]:
        return self.row, self.params["density"], self.params["sh"]

    def _rays(self, batch: RayBatch) -> tuple[Array, Array, Array]:
        """Origins and directions in cells, directions in the world."""
        dtype = self.params["density"].dtype
        origins = np.ascontiguousarray(batch.origins, dtype)
        directions = np.ascontiguousarray(batch.directions, dtype)
        return (*self.tree.rays_in_cells(origins, directions), directions)

    def _about(
        self, rays: tuple[Array, Array, Array], stop: float
    ) -> tuple[float, Any, Any, float]:
        return self.density_scale, rays, self.tree.cell_size.tolist(), stop

    def state(self) -> dict[str, Array]:
        """{"lower" (L, 3), "side" (L,), "row" (L,)}: which cube of cells has which row."""
        lower, side = self.tree.leaf_boxes()
        return {"lower": lower, "side": side, "row": self.row}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Topology is fixed: raises RangeError unless `state` is that of the same tree."""
        own = self.state()
        if set(state) != set(own) or not all(np.array_equal(state[k], own[k]) for k in own):
            raise RangeError(
                message(
                    "OctreeSh.load_state",
                    "state",
                    f"this tree's {sorted(own)}",
                    f"{sorted(state)}",
                    "the topology of an octree_sh cannot change",
                )
            )
