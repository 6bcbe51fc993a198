"""What a fit is asked to do; stored in every checkpoint, so that a run can be resumed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from photograd._checks import require_bounds, require_types
from photograd.errors import RangeError, message

Background = Literal["random", "white", "black", "learned"]
BackgroundOption = Literal["auto", "random", "white", "black", "learned"]
DensityControlOption = Literal["mcmc", "clone_split_prune", "none"]
"""Of Gaussians: a fixed number that wanders, a growing one, or none."""
Decode = Literal["sample", "ray"]
"""Where a network that decodes codes is evaluated: at each sample, or once a ray."""
BACKGROUNDS: tuple[Background, ...] = get_args(Background)
DECODES: tuple[Decode, ...] = get_args(Decode)
DENSITY_CONTROLS: tuple[DensityControlOption, ...] = get_args(DensityControlOption)

MAX_DEGREE = 3
"""Of spherical harmonics."""


@dataclass(frozen=True)
class FitOptions:
    """Options of a `Fit`; the defaults suit 128^3 voxels and a hundred 200 x 200 views.

    `options_for` has the defaults of each representation.

    Grids go from coarse to fine: the fit starts at `resolution` / 4, but not below 8 voxels, and is
    refined to / 2 and to the whole at the fractions `refine_at` of its steps.

    Attributes:
        representation: a name of `photograd.fields.fittable()`.
        resolution: voxels along the longest edge of the box.
        steps: of the optimizer.
        rays: in a step.
        seed: of all random numbers.
        learning_rate: factor on the representation's own rates.
        final_rate: fraction of the rate that is left at the end (exponential decay).
        total_variation: weight of the prior; 0 switches it off.
        background: "random", "white", "black", "learned", or "auto": random where the capture has
            alpha, else learned.
        stop: transmittance below which a ray ends; the discarded light is below this fraction.
        steps_per_voxel: of the march; docs/results.md says what more would change.
        refine_at: fractions of the steps at which a grid is refined.
        sigma_t: density of the start, 1/m.
        degree: of the spherical harmonics, 0 to `MAX_DEGREE`.
        prune: a sparse grid drops voxels that weigh less than this in every pixel; 0 drops none.
        gaussians: at most this many.
        density_control: of Gaussians: "mcmc", "clone_split_prune" or "none".
        decode: of codes: "sample" or "ray".
        importance: samples of a ray that a nerf places by importance; 0 places all evenly.
        final_mean_rate: `final_rate` of the Gaussians' means, which must come to rest.
        ssim_weight: share of 1 - SSIM in the loss of whole pictures.
        laplacian: weight that keeps the vertices of a mesh near the mean of their neighbors.
        normal_consistency: weight that keeps the normals of neighboring faces of a mesh alike.
        remesh: whether a mesh gets new triangles of equal size at `refine_at`.
        opacity: whether the opacity of a mesh's texels is recovered, too.
    """

    representation: str = "dense_grid"
    resolution: int = 128
    steps: int = 1500
    rays: int = 8192
    seed: int = 0
    learning_rate: float = 1.0
    final_rate: float = 0.1
    total_variation: float = 3e-5
    background: BackgroundOption = "auto"
    stop: float = 1e-4
    steps_per_voxel: float = 1.5
    refine_at: tuple[float, float] = (0.15, 0.4)
    sigma_t: float = 0.1
    degree: int = 2
    prune: float = 0.02
    gaussians: int = 30_000
    density_control: DensityControlOption = "mcmc"
    decode: Decode = "sample"
    importance: int = 0
    final_mean_rate: float = 0.01
    ssim_weight: float = 0.2
    laplacian: float = 0.0
    normal_consistency: float = 0.0
    opacity: bool = False
    remesh: bool = False

    def __post_init__(self) -> None:
        """Raises DtypeError or RangeError, naming the option."""
        require_types(self)
        require_bounds(self, "resolution", "steps", "rays", "gaussians", low=1, high=2**31 - 1)
        require_bounds(self, "learning_rate", "final_rate", "final_mean_rate", above=0)
        require_bounds(self, "steps_per_voxel", "sigma_t", above=0)
        require_bounds(self, "total_variation", "prune", low=0)
        require_bounds(self, "seed", low=0, high=2**64 - 1)
        require_bounds(self, "importance", low=0, high=4096)
        require_bounds(self, "stop", low=0, below=1)
        require_bounds(self, "degree", low=0, high=MAX_DEGREE)
        require_bounds(self, "laplacian", "normal_consistency", low=0)
        require_bounds(self, "ssim_weight", low=0, high=1)
        if not 0 <= self.refine_at[0] <= self.refine_at[1] < 1:
            raise RangeError(
                message(
                    "FitOptions", "refine_at", "two rising fractions below 1", f"{self.refine_at}"
                )
            )

    def active_degree(self, step: int) -> int:
        """Degree of a Gaussian's harmonics at a step: one more every tenth of the steps."""
        return min(self.degree, 10 * step // self.steps)

    def levels(self) -> dict[int, int]:
        """{first step: resolution} of the coarse-to-fine schedule; never below 8 voxels."""
        starts = (0, int(self.refine_at[0] * self.steps), int(self.refine_at[1] * self.steps))
        sizes = (self.resolution // 4, self.resolution // 2, self.resolution)
        levels: dict[int, int] = {}
        for start, size in zip(starts, sizes, strict=True):
            levels[start] = min(max(size, 8), self.resolution)
        return levels
