# Generated from the compiled module by tools/stubs.py. Do not edit.
"""
photograd's C++ core. Use the typed faces in the package photograd instead.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "BrickTopology",
    "Bsdf",
    "BspTree",
    "Bvh",
    "CellTable",
    "DeltaBsdf",
    "EnvironmentSampler",
    "HashSettings",
    "MarchSettings",
    "NeuralSamples",
    "NeuralSettings",
    "Octree",
    "Op",
    "PathGeometry",
    "PerceptronShape",
    "PerceptronValues",
    "PhaseFunction",
    "PhotonMap",
    "PreparedRays32",
    "PreparedRays64",
    "PreparedSplats32",
    "PreparedSplats64",
    "PreparedTriangles",
    "Quadtree",
    "RayOptions",
    "ReferenceBvh",
    "SampledLight",
    "Sdf",
    "SparseGrid",
    "SparseStatistics",
    "SplatImage",
    "SplatOptions",
    "TexturePlan",
    "VectorShapes",
    "VectorStrokes",
    "VoxelHash",
    "ambient_occlusion",
    "blend_samples",
    "bloom",
    "bloom_backward",
    "bsdfs",
    "build_mips",
    "build_mips_backward",
    "cap_to_square",
    "cosine_hemisphere_to_square",
    "cover_texels",
    "delta_bsdfs",
    "diffusion_cdf",
    "diffusion_cdf_backward",
    "dipole",
    "dipole_albedo",
    "dipole_albedo_backward",
    "dipole_backward",
    "disk_occlusion",
    "disk_to_square",
    "dual_buffer_backward",
    "emit_particles",
    "exp",
    "expm1",
    "fields",
    "fill_gbuffer",
    "follow_screen_rays",
    "frequency_encode",
    "frequency_encode_backward",
    "gbuffer_pdf",
    "hash_encode",
    "hash_encode_backward",
    "horizon_occlusion",
    "instruction_set",
    "interpolate",
    "interpolate_backward",
    "light_gbuffer",
    "light_gbuffer_parallel",
    "lights",
    "log1p_unit",
    "march",
    "march_backward",
    "march_neural",
    "march_neural_backward",
    "march_octree_sh",
    "march_octree_sh_backward",
    "march_sparse_sh",
    "march_sparse_sh_backward",
    "max_samples",
    "mip_level",
    "mip_shapes",
    "neural_densities",
    "neural_direction_numbers",
    "normalized_diffusion",
    "normalized_diffusion_backward",
    "octree_sh_weights",
    "one_blob_encode",
    "one_blob_encode_backward",
    "ops",
    "order_by_depth",
    "perceptron_backward",
    "perceptron_forward",
    "perceptrons_backward",
    "perceptrons_forward",
    "phases",
    "philox4x32",
    "place_samples",
    "point_occlusion",
    "prepare_splat_rays",
    "prepare_splats",
    "principled_values",
    "principled_values_backward",
    "project",
    "rasterize",
    "rasterize_backward",
    "rasterize_depth",
    "read_vdb",
    "sample",
    "sample_backward",
    "sample_bricks",
    "sample_bricks_backward",
    "sample_diffusion_radius",
    "sample_diffusion_radius_backward",
    "sample_gbuffer",
    "sample_mips",
    "sample_mips_backward",
    "sample_weights",
    "sample_weights_backward",
    "sampled_lights",
    "set_thread_count",
    "sh_colors",
    "sh_colors_backward",
    "shadow_lookup",
    "silhouettes",
    "sobol_words",
    "sparse_adam",
    "sparse_sh_weights",
    "square_to_cap",
    "square_to_cosine_hemisphere",
    "square_to_disk",
    "ssao",
    "ssao_backward",
    "ssim",
    "ssim_backward",
    "thread_count",
    "tiny_network_parameters",
    "tone_map",
    "tone_map_backward",
    "total_variation",
    "total_variation_backward",
    "trace_light",
    "trace_path",
    "trace_paths",
    "trace_paths_backward",
    "trace_paths_tangent",
    "trace_photons",
    "trace_reference",
    "turn_vectors",
    "uniform",
    "view_directions",
    "visible_samples",
    "write_vdb",
]

class Op:
    """
    A differentiable op as a flat function, for the proofs.
    """
    def backward(self, x: numpy.ndarray, d_y: numpy.ndarray, d_x: numpy.ndarray) -> numpy.ndarray:
        """
        Adds J^T d_y to d_x and returns it.
        """
    def forward(self, x: numpy.ndarray) -> numpy.ndarray:
        """
        y of the flat inputs x, in float32 or float64.
        """
    def jvp(self, x: numpy.ndarray, v: numpy.ndarray) -> numpy.ndarray:
        """
        J v, exactly, by dual numbers (float64).
        """
    @property
    def inputs(self) -> list[tuple[str, int, float, float]]:
        """
        Differentiable groups: (name, size, lo, hi).
        """
    @property
    def name(self) -> str: ...
    @property
    def outputs(self) -> int: ...

class MarchSettings:
    """
    Box, step and policies of a march.
    """
    def __init__(
        self,
        box: typing.Annotated[
            collections.abc.Sequence[
                typing.Annotated[
                    collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
                    "FixedSize(3)",
                ]
            ],
            "FixedSize(2)",
        ],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        stop: typing.SupportsFloat | typing.SupportsIndex,
        lattice: typing.SupportsInt | typing.SupportsIndex,
        quadrature: typing.SupportsInt | typing.SupportsIndex,
        border: typing.SupportsInt | typing.SupportsIndex,
        density_activation: typing.SupportsInt | typing.SupportsIndex,
        color_activation: typing.SupportsInt | typing.SupportsIndex,
        density_scale: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class Bvh:
    """
    Meshes and their instances, ready to be traced.
    """
    def __init__(
        self,
        meshes: collections.abc.Sequence[tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray | None]],
        mesh_index: numpy.ndarray,
        world_from_object: numpy.ndarray,
    ) -> None:
        """
        Meshes as (vertices (V, 3) float32, faces (F, 3) uint32, uv (V, 2) float32 or None);
        instances as mesh_index (N,) int32 and world_from_object (N, 3, 4) float64.
        """
    def occluded(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: numpy.ndarray,
        t_max: numpy.ndarray,
    ) -> numpy.typing.NDArray[numpy.bool]:
        """
        Whether anything lies within [t_min, t_max] of each ray: (R,) bool.
        """
    def surface_points(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        primitive: numpy.ndarray,
        instance: numpy.ndarray,
    ) -> tuple[typing.Any, ...]:
        """
        t (R,), barycentrics (R, 2), uv (R, 2), position (R, 3), normal (R, 3) of known hits.
        """
    def trace(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: numpy.ndarray,
        t_max: numpy.ndarray,
        t: numpy.ndarray,
        primitive: numpy.ndarray,
        instance: numpy.ndarray,
        barycentrics: numpy.ndarray,
    ) -> None:
        """
        Fills t (R,), primitive (R,), instance (R,) int32 and barycentrics (R, 2).
        """
    @property
    def bounds(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        Lower and upper corner (2, 3) of everything.
        """

class ReferenceBvh:
    """
    A hierarchy of boxes, written to be read.
    """
    def __init__(
        self,
        vertices: numpy.ndarray,
        faces: numpy.ndarray,
        leaf_size: typing.SupportsInt | typing.SupportsIndex,
        bins: typing.SupportsInt | typing.SupportsIndex,
        max_depth: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def nodes(self) -> tuple[typing.Any, ...]:
        """
        Boxes (N, 2, 3); first, count, right and depth (N, 4); order (F,) of triangles.
        """
    def trace(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: typing.SupportsFloat | typing.SupportsIndex,
        t_max: typing.SupportsFloat | typing.SupportsIndex,
        any: bool,
        t: numpy.ndarray,
        primitive: numpy.ndarray,
        barycentrics: numpy.ndarray,
        visits: numpy.ndarray,
    ) -> None:
        """
        Fills t (R,), primitive (R,) int32, barycentrics (R, 2) and visits (2, R) int32.
        """
    def trace_all(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: typing.SupportsFloat | typing.SupportsIndex,
        t_max: typing.SupportsFloat | typing.SupportsIndex,
        t: numpy.ndarray,
        primitive: numpy.ndarray,
        barycentrics: numpy.ndarray,
        visits: numpy.ndarray,
    ) -> None:
        """
        The same, by a test of every triangle.
        """

class BspTree:
    """
    A binary space partition of triangles.
    """
    def __init__(
        self,
        vertices: numpy.ndarray,
        faces: numpy.ndarray,
        candidates: typing.SupportsInt | typing.SupportsIndex,
        max_polygons: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def back_to_front(self, eyes: numpy.ndarray) -> numpy.typing.NDArray[numpy.uint32]:
        """
        Numbers (E, P) of all polygons, for each eye (E, 3), hidden ones first.
        """
    def nodes(self) -> tuple[typing.Any, ...]:
        """
        Planes (N, 4); front, back, first, count and depth (N, 5).
        """
    def polygons(self) -> tuple[typing.Any, ...]:
        """
        Points (Q, 3), where each begins (P + 1,), triangles (P,).
        """

class PreparedTriangles:
    """
    Triangles of one view, by tile.
    """
    def __init__(
        self,
        positions: numpy.ndarray,
        faces: numpy.ndarray,
        height: typing.SupportsInt | typing.SupportsIndex,
        width: typing.SupportsInt | typing.SupportsIndex,
        near: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def count(
        self,
        points: numpy.ndarray,
        depth: numpy.ndarray,
        near: typing.SupportsFloat | typing.SupportsIndex,
    ) -> numpy.ndarray:
        """
        How many faces (N,) from near to depth (N,) lie at points (x, y) of the image.
        """
    def nearest(
        self,
        points: numpy.ndarray,
        near: typing.SupportsFloat | typing.SupportsIndex,
        far: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[typing.Any, ...]:
        """
        Face (N,) and depth (N,) at points (x, y) of the image.
        """

class VectorShapes:
    """
    Filled contours and what they cover of each pixel.
    """
    def __init__(
        self,
        vertices: numpy.ndarray,
        contour_begin: numpy.ndarray,
        shape_begin: numpy.ndarray,
        rule: numpy.ndarray,
        height: typing.SupportsInt | typing.SupportsIndex,
        width: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def area(self, shape: typing.SupportsInt | typing.SupportsIndex, out: numpy.ndarray) -> None:
        """
        Writes the pixels that one shape may cover.
        """
    def area_backward(
        self,
        shape: typing.SupportsInt | typing.SupportsIndex,
        d_out: numpy.ndarray,
        d_vertices: numpy.ndarray,
    ) -> None:
        """
        Adds to d_vertices.
        """
    def draw(
        self,
        kind: numpy.ndarray,
        stop_begin: numpy.ndarray,
        opacity: numpy.ndarray,
        geometry: numpy.ndarray,
        offsets: numpy.ndarray,
        colors: numpy.ndarray,
        background: numpy.ndarray,
        out: numpy.ndarray,
    ) -> None: ...
    def draw_backward(
        self,
        kind: numpy.ndarray,
        stop_begin: numpy.ndarray,
        opacity: numpy.ndarray,
        geometry: numpy.ndarray,
        offsets: numpy.ndarray,
        colors: numpy.ndarray,
        background: numpy.ndarray,
        d_out: numpy.ndarray,
        d_vertices: numpy.ndarray,
        d_opacity: numpy.ndarray,
        d_geometry: numpy.ndarray,
        d_offsets: numpy.ndarray,
        d_colors: numpy.ndarray,
        d_background: numpy.ndarray,
    ) -> None:
        """
        Adds to all that begin with d_ but d_out.
        """

class VectorStrokes:
    """
    Polylines and the outlines of their strokes.
    """
    def __init__(
        self,
        points: numpy.ndarray,
        corner: numpy.ndarray,
        line_begin: numpy.ndarray,
        closed: numpy.ndarray,
        half_width: numpy.ndarray,
        cap: numpy.ndarray,
        join: numpy.ndarray,
        miter_limit: numpy.ndarray,
        arc: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def backward(
        self, d_vertices: numpy.ndarray, d_points: numpy.ndarray, d_half_width: numpy.ndarray
    ) -> None:
        """
        Adds to d_points and d_half_width.
        """
    def outlines(self) -> tuple[typing.Any, ...]:
        """
        Vertices (K, 2), number of vertices of each contour, line of each contour.
        """

class Sdf:
    """
    A body as a tree of signed distances.
    """
    def __init__(self, nodes: numpy.ndarray) -> None:
        """
        Nodes (N, 4) int32: kind, two children or -1, where its numbers begin.
        """
    def bounds(self, numbers: numpy.ndarray) -> numpy.typing.NDArray[numpy.float64]:
        """
        A box (2, 3) around the body; SceneError if it is empty or has no end.
        """
    def distance(
        self, numbers: numpy.ndarray, points: numpy.ndarray
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        f (N,) of points (N, 3).
        """
    def distance_backward(
        self,
        numbers: numpy.ndarray,
        points: numpy.ndarray,
        d_f: numpy.ndarray,
        d_points: numpy.ndarray,
        d_numbers: numpy.ndarray,
    ) -> None:
        """
        Adds the derivatives to d_points (N, 3) and d_numbers (P,).
        """
    def trace(
        self,
        numbers: numpy.ndarray,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        march: tuple[
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsInt | typing.SupportsIndex,
        ],
    ) -> tuple[typing.Any, ...]:
        """
        t (R,), steps (R,) int32, end (R,) int8: missed, hit, gave up.
        """
    def trace_backward(
        self,
        numbers: numpy.ndarray,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        march: tuple[
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsInt | typing.SupportsIndex,
        ],
        t: numpy.ndarray,
        end: numpy.ndarray,
        d_t: numpy.ndarray,
        d_numbers: numpy.ndarray,
        d_origins: numpy.ndarray,
        d_directions: numpy.ndarray,
    ) -> None:
        """
        Adds the derivatives of t to d_numbers (P,), d_origins and d_directions (R, 3).
        """
    @property
    def number_count(self) -> int: ...

class Bsdf:
    """
    A reflectance model. Parameters (N, P), or (1, P) for all rows; directions (N, 3) in the shading frame, normal +Z.
    """
    def __repr__(self) -> str: ...
    def energy(self) -> tuple[str, float]:
        """
        What is claimed of the directional albedo: (conserving, lossy or gains; its bound).
        """
    def f(self, parameters: numpy.ndarray, wo: numpy.ndarray, wi: numpy.ndarray) -> numpy.ndarray:
        """
        Value without the cosine, (N, 3).
        """
    def f_backward(
        self,
        parameters: numpy.ndarray,
        wo: numpy.ndarray,
        wi: numpy.ndarray,
        d_f: numpy.ndarray,
        d_parameters: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Adds dL/dparameters to d_parameters, shaped like parameters; returns it.
        """
    def index_inside(self, parameters: numpy.ndarray) -> numpy.ndarray:
        """
        Refractive index below the surface over that above, per channel (N, 3), of parameters (N, P) float64.
        """
    def jvp(
        self, parameters: numpy.ndarray, v: numpy.ndarray, wo: numpy.ndarray, wi: numpy.ndarray
    ) -> numpy.ndarray:
        """
        Exact derivative of f along v, (N, 3), float64.
        """
    def parameters(self) -> list[tuple[str, int, float, float, str]]:
        """
        (name, scalars, lo, hi, unit) of each parameter, in the order of a row.
        """
    def pdf(self, parameters: numpy.ndarray, wo: numpy.ndarray, wi: numpy.ndarray) -> numpy.ndarray:
        """
        Density of `sample` over solid angle, (N,).
        """
    def reciprocal(self) -> bool:
        """
        Whether f(wo, wi) / index(wo)^2 = f(wi, wo) / index(wi)^2; outside the index is 1.
        """
    def sample(
        self, parameters: numpy.ndarray, wo: numpy.ndarray, u2: numpy.ndarray
    ) -> numpy.ndarray:
        """
        wi (N, 3) from uniform u2 (N, 2).
        """
    def transmits(self) -> bool:
        """
        Whether light may pass the surface.
        """

class DeltaBsdf:
    """
    A specular surface. Parameters (N, P), or (1, P) for all rows; wo (N, 3) in the shading frame, normal +Z, on either side.
    """
    def __repr__(self) -> str: ...
    def jvp(
        self, parameters: numpy.ndarray, v: numpy.ndarray, wo: numpy.ndarray
    ) -> tuple[typing.Any, ...]:
        """
        Exact derivatives of (wi, weight) along v, float64.
        """
    def lobe_count(self) -> int:
        """
        L.
        """
    def lobes(self, parameters: numpy.ndarray, wo: numpy.ndarray) -> tuple[typing.Any, ...]:
        """
        (wi, weight), (N, L, 3) each: L(wo) is the sum of weight L(wi).
        """
    def lobes_backward(
        self,
        parameters: numpy.ndarray,
        wo: numpy.ndarray,
        d_wi: numpy.ndarray,
        d_weight: numpy.ndarray,
        d_parameters: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Adds dL/dparameters to d_parameters, shaped like parameters; returns it.
        """
    def parameters(self) -> list[tuple[str, int, float, float, str]]:
        """
        (name, scalars, lo, hi, unit) of each parameter, in the order of a row.
        """

class SampledLight:
    """
    A light. parameters (P,), constants (C,); points (N, 3) in the world, directions w (N, 3) of unit length, from the points.
    """
    def __repr__(self) -> str: ...
    def constants(self) -> list[tuple[str, int, float, float, str]]:
        """
        The same of what is not differentiated.
        """
    def jvp(
        self,
        parameters: numpy.ndarray,
        constants: numpy.ndarray,
        v: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Exact derivative of samples' radiance along v (P,), (N, 3), float64.
        """
    def parameters(self) -> list[tuple[str, int, float, float, str]]:
        """
        (name, scalars, lo, hi, unit) of each differentiated parameter.
        """
    def pdf(
        self,
        parameters: numpy.ndarray,
        constants: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Density of `sample` over solid angle, (N,); 0 of delta lights.
        """
    def radiance(
        self,
        parameters: numpy.ndarray,
        constants: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        What arrives at the points from w, (N, 3); 0 of delta lights.
        """
    def radiance_backward(
        self,
        parameters: numpy.ndarray,
        constants: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
        d_radiance: numpy.ndarray,
        d_parameters: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Adds dL/dparameters to d_parameters (P,) and returns it.
        """
    def sample(
        self,
        parameters: numpy.ndarray,
        constants: numpy.ndarray,
        points: numpy.ndarray,
        u2: numpy.ndarray,
    ) -> tuple[typing.Any, ...]:
        """
        (direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)).
        """
    def sample_backward(
        self,
        parameters: numpy.ndarray,
        constants: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
        d_radiance: numpy.ndarray,
        d_parameters: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        As radiance_backward, of the radiance of samples whose directions are w.
        """

class EnvironmentSampler:
    """
    Samples directions towards the bright parts of a map.
    """
    def __init__(
        self, texels: numpy.ndarray, uniform_share: typing.SupportsFloat | typing.SupportsIndex
    ) -> None:
        """
        Texels (H, 2 H, 3); uniform_share of the samples go everywhere alike.
        """
    def pdf(
        self,
        texels: numpy.ndarray,
        world_from_map: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Density of `sample` over solid angle, (N,).
        """
    def radiance(
        self,
        texels: numpy.ndarray,
        world_from_map: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        What arrives from w, (N, 3).
        """
    def radiance_backward(
        self,
        texels: numpy.ndarray,
        world_from_map: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
        d_radiance: numpy.ndarray,
        d_texels: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Adds dL/dtexels to d_texels (H, 2 H, 3) and returns it.
        """
    def sample(
        self,
        texels: numpy.ndarray,
        world_from_map: numpy.ndarray,
        points: numpy.ndarray,
        u2: numpy.ndarray,
    ) -> tuple[typing.Any, ...]:
        """
        (direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)).
        """
    def sample_backward(
        self,
        texels: numpy.ndarray,
        world_from_map: numpy.ndarray,
        points: numpy.ndarray,
        w: numpy.ndarray,
        d_radiance: numpy.ndarray,
        d_texels: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        The same for the radiance of samples whose directions are w.
        """

class PhaseFunction:
    """
    A phase function. parameters (P,); cos_theta (N,) of the angle by which light turns.
    """
    def __repr__(self) -> str: ...
    def jvp(
        self,
        parameters: numpy.ndarray,
        cos_theta: numpy.ndarray,
        v_parameters: numpy.ndarray,
        v_cos_theta: numpy.ndarray,
    ) -> numpy.ndarray:
        """
        Exact derivative of p along v_parameters (P,) and v_cos_theta (N,).
        """
    def p(self, parameters: numpy.ndarray, cos_theta: numpy.ndarray) -> numpy.ndarray:
        """
        Density over solid angle, (N,) in 1/sr.
        """
    def p_backward(
        self,
        parameters: numpy.ndarray,
        cos_theta: numpy.ndarray,
        d_p: numpy.ndarray,
        d_parameters: numpy.ndarray,
        d_cos_theta: numpy.ndarray,
    ) -> None:
        """
        Adds the derivatives to d_parameters (P,) and d_cos_theta (N,).
        """
    def parameters(self) -> list[tuple[str, int, float, float, str]]:
        """
        (name, scalars, lo, hi, unit) of each parameter.
        """

class PathGeometry:
    """
    Shapes of a scene: instances of meshes first, then spheres, then signed distance fields.
    """
    def __init__(
        self,
        meshes: collections.abc.Sequence[
            tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray | None, numpy.ndarray | None]
        ],
        instances: numpy.ndarray,
        matrices: numpy.ndarray,
        spheres: numpy.ndarray,
        material: numpy.ndarray,
        emission: numpy.ndarray,
        lights: collections.abc.Sequence[tuple[typing.Any, ...]],
        sdfs: collections.abc.Sequence[tuple[Sdf, numpy.ndarray]] = [],
        closing_matrices: numpy.ndarray | None = None,
        closing_spheres: numpy.ndarray | None = None,
    ) -> None:
        """
        Meshes as (vertices (V, 3) float32, faces (F, 3) uint32, normals (V, 3) float32 or None,
        uv (V, 2) float32 or None); instances (I,) int32, mesh numbers, and matrices (I, 3, 4) float64;
        spheres (K, 4) float32; material (S,) int32 and emission (S, 3) float64 of each shape,
        which are the instances, then the spheres, then sdfs, (body, numbers (P,)). Lights of the list: (name, parameters, constants) or
        ("environment", texels, world_from_map, sampler), float64. closing_matrices and
        closing_spheres are those when the shutter closes, None where nothing moves.
        """
    def choose_lights(self, u: numpy.ndarray) -> tuple[typing.Any, ...]:
        """
        (entries (N,) int64, their probabilities (N,)) by uniform u (N,): first lights of the list, then what emits of the shapes.
        """
    def set_media(
        self,
        interior: numpy.ndarray,
        boundary: numpy.ndarray,
        world: typing.SupportsInt | typing.SupportsIndex,
        grids: collections.abc.Sequence[
            tuple[
                typing.Annotated[
                    collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
                    "FixedSize(3)",
                ],
                numpy.ndarray,
            ]
            | None
        ],
    ) -> None:
        """
        interior (S,) int32: the number of a medium, -1 for nothing, -2 for what is around; boundary (S,) bool;
        world: the number of a medium or -1; for each medium ((X, Y, Z), box_from_world (3, 4) float64) or None.
        """
    def set_textures(
        self,
        layouts: collections.abc.Sequence[
            tuple[
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
                bool,
            ]
        ],
        uses: collections.abc.Sequence[
            collections.abc.Sequence[
                tuple[
                    typing.SupportsInt | typing.SupportsIndex,
                    typing.SupportsInt | typing.SupportsIndex,
                    typing.SupportsInt | typing.SupportsIndex,
                    typing.SupportsInt | typing.SupportsIndex,
                    typing.SupportsFloat | typing.SupportsIndex,
                    typing.SupportsFloat | typing.SupportsIndex,
                ]
            ]
        ],
        normal_maps: collections.abc.Sequence[
            tuple[
                numpy.ndarray,
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
            ]
            | None
        ],
        directed: collections.abc.Sequence[bool],
        cutoffs: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        emission: collections.abc.Sequence[
            tuple[
                typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex
            ]
        ],
    ) -> None:
        """
        Layouts (H, W, C, wrap_u, wrap_v, mips) of textures; for each material uses (texture, channel, first,
        count, lo, hi), and a normal map (values (H, W, 3) float32, wrap_u, wrap_v) or None;
        directed (M,), whether its frame follows u; cutoffs (M,), of masks, others below 0; emission,
        for each shape (texture or -1, first of its three channels).
        """
    @property
    def bvh(self) -> Bvh:
        """
        The hierarchy of all shapes, to be traced.
        """

class PhotonMap:
    """
    Particles where they have hit surfaces.
    """
    def __init__(
        self,
        geometry: PathGeometry,
        models: collections.abc.Sequence[str],
        parameters: numpy.ndarray,
        emission: numpy.ndarray,
        lights: collections.abc.Sequence[tuple[typing.Any, ...]],
        textures: collections.abc.Sequence[numpy.ndarray],
        media: collections.abc.Sequence[
            tuple[
                str,
                numpy.ndarray,
                numpy.ndarray | None,
                typing.SupportsFloat | typing.SupportsIndex,
            ]
        ],
        options: tuple[
            typing.SupportsInt | typing.SupportsIndex,
            typing.SupportsInt | typing.SupportsIndex,
            typing.SupportsInt | typing.SupportsIndex,
        ],
        count: typing.SupportsInt | typing.SupportsIndex,
        radius: typing.SupportsFloat | typing.SupportsIndex,
        direct: bool,
    ) -> None: ...
    def __len__(self) -> int: ...
    def irradiance(self, points: numpy.ndarray, normals: numpy.ndarray) -> numpy.ndarray:
        """
        (N, 3) W/m^2 at points (N, 3) with geometric normals (N, 3), float64.
        """

class PerceptronShape:
    def __init__(
        self,
        inputs: typing.SupportsInt | typing.SupportsIndex,
        widths: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        hidden: typing.SupportsInt | typing.SupportsIndex,
        output: typing.SupportsInt | typing.SupportsIndex,
        skip: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    @property
    def parameters(self) -> int: ...

class PerceptronValues:
    def __init__(self) -> None: ...

class HashSettings:
    def __init__(
        self,
        dimensions: typing.SupportsInt | typing.SupportsIndex,
        resolutions: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        log2_rows: typing.SupportsInt | typing.SupportsIndex,
        features: typing.SupportsInt | typing.SupportsIndex,
        smoothstep: bool,
    ) -> None: ...
    @property
    def levels(self) -> list[tuple[int, int, int, bool]]: ...
    @property
    def rows(self) -> int: ...

class NeuralSettings:
    def __init__(
        self,
        hash: HashSettings | None,
        octaves: typing.SupportsInt | typing.SupportsIndex,
        density: PerceptronShape,
        color: PerceptronShape,
    ) -> None: ...

class NeuralSamples:
    """
    What march_neural keeps of its samples for march_neural_backward.
    """
    def __init__(self) -> None: ...

class TexturePlan:
    """
    Points sorted by tile, with their colors.
    """
    def __init__(
        self,
        height: typing.SupportsInt | typing.SupportsIndex,
        width: typing.SupportsInt | typing.SupportsIndex,
        uv: numpy.ndarray,
        colors: numpy.ndarray,
    ) -> None: ...
    def loss_and_gradient(self, texture: numpy.ndarray, d_texture: numpy.ndarray) -> float:
        """
        The loss; adds to d_texture (H, W, C).
        """

class Octree:
    """
    Which cube of space is a leaf.
    """
    @staticmethod
    def from_dense(
        values: numpy.ndarray,
        background: numpy.ndarray,
        tolerance: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[typing.Any, ...]:
        """
        The tree of an array, and its payloads (L, C).
        """
    @staticmethod
    def from_function(
        depth: typing.SupportsInt | typing.SupportsIndex,
        classify: collections.abc.Callable[..., typing.Any],
        channels: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[typing.Any, ...]:
        """
        The tree of classify(lower, side) -> None or channels; payloads (L, C).
        """
    def leaf_boxes(self) -> tuple[typing.Any, ...]:
        """
        Lower corners (L, D) and sides (L,) in cells.
        """
    def locate(self, points: numpy.ndarray, leaf: numpy.ndarray) -> None:
        """
        Fills leaf (N,) int32 for points (N, D) in cells; -1 is outside of the root.
        """
    def statistics(self) -> tuple[int, int, int, list[int]]:
        """
        nodes, leaves, bytes, and a list of leaves by level, that of the root first.
        """
    def traverse(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: numpy.ndarray,
        t_max: numpy.ndarray,
    ) -> tuple[typing.Any, ...]:
        """
        Visits of rays (R, D) in cells: ray_offset (R + 1,), leaf (M,), t0 (M,), t1 (M,).
        """
    @property
    def depth(self) -> int:
        """
        Levels below the root.
        """

class Quadtree:
    """
    Which square of a plane is a leaf.
    """
    @staticmethod
    def from_dense(
        values: numpy.ndarray,
        background: numpy.ndarray,
        tolerance: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[typing.Any, ...]:
        """
        The tree of an array, and its payloads (L, C).
        """
    @staticmethod
    def from_function(
        depth: typing.SupportsInt | typing.SupportsIndex,
        classify: collections.abc.Callable[..., typing.Any],
        channels: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[typing.Any, ...]:
        """
        The tree of classify(lower, side) -> None or channels; payloads (L, C).
        """
    def leaf_boxes(self) -> tuple[typing.Any, ...]:
        """
        Lower corners (L, D) and sides (L,) in cells.
        """
    def locate(self, points: numpy.ndarray, leaf: numpy.ndarray) -> None:
        """
        Fills leaf (N,) int32 for points (N, D) in cells; -1 is outside of the root.
        """
    def statistics(self) -> tuple[int, int, int, list[int]]:
        """
        nodes, leaves, bytes, and a list of leaves by level, that of the root first.
        """
    def traverse(
        self,
        origins: numpy.ndarray,
        directions: numpy.ndarray,
        t_min: numpy.ndarray,
        t_max: numpy.ndarray,
    ) -> tuple[typing.Any, ...]:
        """
        Visits of rays (R, D) in cells: ray_offset (R + 1,), leaf (M,), t0 (M,), t1 (M,).
        """
    @property
    def depth(self) -> int:
        """
        Levels below the root.
        """

class VoxelHash:
    """
    Which row of a payload array belongs to a voxel.
    """
    def __init__(self) -> None: ...
    def erase(self, voxels: numpy.ndarray, rows: numpy.ndarray) -> None:
        """
        Fills rows (N,) with those that are free now.
        """
    def find(self, voxels: numpy.ndarray, rows: numpy.ndarray) -> None:
        """
        Fills rows (N,), -1 where there is none.
        """
    def insert(self, voxels: numpy.ndarray, rows: numpy.ndarray) -> None:
        """
        Fills rows (N,); new voxels (N, 3) are given one.
        """
    def items(self) -> tuple[typing.Any, ...]:
        """
        Voxels (M, 3) and their rows (M,), by ascending row.
        """
    def statistics(self) -> tuple[int, int, int, int, int, float]:
        """
        count, row_limit, slots, bytes, longest_probe, mean_probe.
        """

class SparseStatistics:
    """
    What a sparse grid holds.
    """
    @property
    def active_tiles(self) -> int: ...
    @property
    def active_voxels(self) -> int: ...
    @property
    def box(
        self,
    ) -> typing.Annotated[list[typing.Annotated[list[int], "FixedSize(3)"]], "FixedSize(2)"]: ...
    @property
    def leaves(self) -> int: ...
    @property
    def max(self) -> float: ...
    @property
    def memory(self) -> int: ...
    @property
    def min(self) -> float: ...

class SparseGrid:
    """
    A grid of OpenVDB, float or vec3s.
    """

    name: str
    @staticmethod
    def from_dense(
        values: numpy.ndarray,
        origin: typing.Annotated[
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"
        ],
        background: numpy.ndarray,
        tolerance: typing.SupportsFloat | typing.SupportsIndex,
    ) -> SparseGrid: ...
    def activate(self, voxels: numpy.ndarray, values: numpy.ndarray) -> None: ...
    def copy(self) -> SparseGrid: ...
    def dilate(self, steps: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def keep(self, keep: numpy.ndarray) -> None: ...
    def leaf_values(self) -> numpy.typing.NDArray[numpy.float32]: ...
    def leaves(self) -> tuple[typing.Any, ...]: ...
    def metadata(self) -> dict[str, bool | int | float | str]: ...
    def prune(self, tolerance: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    def sample(self, points: numpy.ndarray) -> numpy.typing.NDArray[numpy.float32]: ...
    def set_leaf_values(self, values: numpy.ndarray) -> None: ...
    def set_metadata(
        self,
        key: str,
        value: bool
        | typing.SupportsInt
        | typing.SupportsIndex
        | typing.SupportsFloat
        | typing.SupportsIndex
        | str,
    ) -> None: ...
    def set_world_from_index(
        self,
        matrix: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(16)"
        ],
    ) -> None: ...
    def statistics(self) -> SparseStatistics: ...
    def to_dense(
        self,
        origin: typing.Annotated[
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"
        ],
        out: numpy.ndarray,
    ) -> None: ...
    def values_at(self, voxels: numpy.ndarray) -> tuple[typing.Any, ...]: ...
    def voxelize(self) -> None: ...
    def world_from_index(self) -> typing.Annotated[list[float], "FixedSize(16)"]: ...
    @property
    def background(self) -> list[float]: ...
    @property
    def channels(self) -> int: ...

class BrickTopology:
    """
    Where a sparse grid keeps its values.
    """
    def __init__(
        self,
        origins: numpy.ndarray,
        active: numpy.ndarray,
        memory_limit: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    @property
    def bricks(self) -> int: ...
    @property
    def memory(self) -> int: ...
    @property
    def voxels(self) -> int: ...

class SplatImage:
    """
    Size and focal lengths of a picture, in pixels.
    """
    def __init__(
        self,
        width: typing.SupportsInt | typing.SupportsIndex,
        height: typing.SupportsInt | typing.SupportsIndex,
        fx: typing.SupportsFloat | typing.SupportsIndex,
        fy: typing.SupportsFloat | typing.SupportsIndex,
        cx: typing.SupportsFloat | typing.SupportsIndex,
        cy: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class SplatOptions:
    """
    Policies of splatting.
    """
    def __init__(
        self,
        low_pass: typing.SupportsFloat | typing.SupportsIndex,
        antialiased: bool,
        alpha_min: typing.SupportsFloat | typing.SupportsIndex,
        alpha_max: typing.SupportsFloat | typing.SupportsIndex,
        pass_clamped: bool,
        extent_sigmas: typing.SupportsFloat | typing.SupportsIndex,
        stop: typing.SupportsFloat | typing.SupportsIndex,
        near: typing.SupportsFloat | typing.SupportsIndex,
        frustum_margin: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class PreparedSplats32:
    """
    Splats of one view, sorted and in tiles.
    """
    def backward(
        self,
        gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        d_camera_from_world: numpy.ndarray,
        d_background: numpy.ndarray,
        d_screen: numpy.ndarray,
    ) -> None:
        """
        Adds to d_gaussians and what follows; image is what render returned.
        """
    def render(self) -> tuple[typing.Any, ...]:
        """
        Color (H, W, 3), opacity (H, W), depth (H, W).
        """
    @property
    def boxes(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Pixels [x0, x1) x [y0, y1) of each Gaussian, (N, 4) int32.
        """
    @property
    def pairs(self) -> int:
        """
        Number of pairs of splat and tile.
        """

class PreparedSplats64:
    """
    Splats of one view, sorted and in tiles.
    """
    def backward(
        self,
        gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        d_camera_from_world: numpy.ndarray,
        d_background: numpy.ndarray,
        d_screen: numpy.ndarray,
    ) -> None:
        """
        Adds to d_gaussians and what follows; image is what render returned.
        """
    def render(self) -> tuple[typing.Any, ...]:
        """
        Color (H, W, 3), opacity (H, W), depth (H, W).
        """
    @property
    def boxes(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Pixels [x0, x1) x [y0, y1) of each Gaussian, (N, 4) int32.
        """
    @property
    def pairs(self) -> int:
        """
        Number of pairs of splat and tile.
        """

class RayOptions:
    """
    Policies of casting rays at Gaussians.
    """
    def __init__(
        self,
        alpha_min: typing.SupportsFloat | typing.SupportsIndex,
        alpha_max: typing.SupportsFloat | typing.SupportsIndex,
        stop: typing.SupportsFloat | typing.SupportsIndex,
        t_min: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class PreparedRays32:
    """
    Rays, and Gaussians in a tree of boxes.
    """
    def backward(
        self,
        gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        d_background: numpy.ndarray,
        d_rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"]
        | None = None,
    ) -> None:
        """
        Adds to d_gaussians, d_background and, where given, d_rays: d_origins, d_directions.
        """
    def render(
        self, gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"]
    ) -> tuple[typing.Any, ...]:
        """
        Color (R, 3), opacity (R,), depth (R,); the Gaussians are those prepared.
        """
    @property
    def crossings(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        How many Gaussians each ray blended, (R,) uint32, a copy.
        """

class PreparedRays64:
    """
    Rays, and Gaussians in a tree of boxes.
    """
    def backward(
        self,
        gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_image: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
        d_gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
        d_background: numpy.ndarray,
        d_rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"]
        | None = None,
    ) -> None:
        """
        Adds to d_gaussians, d_background and, where given, d_rays: d_origins, d_directions.
        """
    def render(
        self, gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"]
    ) -> tuple[typing.Any, ...]:
        """
        Color (R, 3), opacity (R,), depth (R,); the Gaussians are those prepared.
        """
    @property
    def crossings(self) -> numpy.typing.NDArray[numpy.uint32]:
        """
        How many Gaussians each ray blended, (R,) uint32, a copy.
        """

class CellTable:
    """
    The cells of a sparse grid, for marching.
    """
    def __init__(
        self,
        topology: BrickTopology,
        shape: typing.Annotated[
            collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"
        ],
        memory_limit: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    @property
    def memory(self) -> int: ...
    @property
    def tiles(self) -> int: ...

def ambient_occlusion(
    geometry: PathGeometry,
    camera: tuple[typing.Any, ...],
    radius: typing.SupportsFloat | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    sums: numpy.ndarray,
) -> None:
    """
    Adds the free part of each sample to sums (H, W), float64.
    """

def blend_samples(
    offset: numpy.ndarray, weight: numpy.ndarray, values: numpy.ndarray
) -> numpy.ndarray:
    """
    (R, C): the sum of weight times values (M, C) over the samples of each ray.
    """

def bloom(
    color: numpy.ndarray,
    threshold: typing.SupportsFloat | typing.SupportsIndex,
    weights: numpy.ndarray,
    out: numpy.ndarray,
) -> None: ...
def bloom_backward(
    color: numpy.ndarray,
    threshold: typing.SupportsFloat | typing.SupportsIndex,
    weights: numpy.ndarray,
    d_out: numpy.ndarray,
    d_color: numpy.ndarray,
    d_weights: numpy.ndarray,
    d_threshold: numpy.ndarray,
) -> None:
    """
    Adds to d_color, d_weights and d_threshold (1,).
    """

def build_mips(mips: collections.abc.Sequence[numpy.ndarray]) -> None:
    """
    Fills level 1 and all after it from level 0.
    """

def build_mips_backward(d_mips: collections.abc.Sequence[numpy.ndarray]) -> None:
    """
    Adds the adjoint of every level to the one before; level 0 ends as the texture's.
    """

def cap_to_square(
    w: numpy.ndarray, height: typing.SupportsFloat | typing.SupportsIndex
) -> numpy.ndarray:
    """
    The inverse of square_to_cap.
    """

def cosine_hemisphere_to_square(w: numpy.ndarray) -> numpy.ndarray:
    """
    The inverse of square_to_cosine_hemisphere.
    """

def cover_texels(
    uv: numpy.ndarray,
    faces: numpy.ndarray,
    height: typing.SupportsInt | typing.SupportsIndex,
    width: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[typing.Any, ...]:
    """
    (face (H, W) int32 or -1, weights (H, W, 2) of its second and third corner, number of texels
    inside of more than one face) of a mesh with coordinates (V, 2) float32 and faces (F, 3) uint32.
    """

def diffusion_cdf(rows: numpy.ndarray, fit: str) -> numpy.ndarray:
    """
    Part of the light within the radius, (N,) of rows (N, 3).
    """

def diffusion_cdf_backward(
    rows: numpy.ndarray, fit: str, d_values: numpy.ndarray, d_rows: numpy.ndarray
) -> None:
    """
    Adds to d_rows (N, 3) for d_values (N,).
    """

def dipole(rows: numpy.ndarray) -> numpy.ndarray:
    """
    R_d (N,) in 1/m^2 of rows (N, 4): radius, sigma_s', sigma_a, eta.
    """

def dipole_albedo(rows: numpy.ndarray) -> numpy.ndarray:
    """
    Integrals (N,) of R_d over the plane; rows (N, 3) without the radius.
    """

def dipole_albedo_backward(
    rows: numpy.ndarray, d_values: numpy.ndarray, d_rows: numpy.ndarray
) -> None:
    """
    Adds to d_rows (N, 3) for d_values (N,).
    """

def dipole_backward(rows: numpy.ndarray, d_values: numpy.ndarray, d_rows: numpy.ndarray) -> None:
    """
    Adds to d_rows (N, 4) for d_values (N,).
    """

def disk_occlusion(
    centers: numpy.ndarray,
    disk_normals: numpy.ndarray,
    areas: numpy.ndarray,
    parts: numpy.ndarray,
    opening: typing.SupportsFloat | typing.SupportsIndex,
    radius: typing.SupportsFloat | typing.SupportsIndex,
    points: numpy.ndarray,
    normals: numpy.ndarray,
    visible: numpy.ndarray,
) -> None: ...
def disk_to_square(p: numpy.ndarray) -> numpy.ndarray:
    """
    The inverse of square_to_disk.
    """

def dual_buffer_backward(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    other_seed: typing.SupportsInt | typing.SupportsIndex,
    spp: typing.SupportsInt | typing.SupportsIndex,
    counts: numpy.ndarray | None,
    target: numpy.ndarray,
    weight: numpy.ndarray,
    pictures: numpy.ndarray,
    gradient: collections.abc.Mapping[str, numpy.ndarray],
) -> None:
    """
    As trace_paths_backward, for the loss sum weight (mean radiance - target)^2, both (H, W, 3) float64,
    by two pictures with independent paths, of the seed in options and of other_seed, written to
    pictures (2, H, W, 3) float64.
    """

def emit_particles(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    seed: typing.SupportsInt | typing.SupportsIndex,
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[typing.Any, ...]:
    """
    (origins (N, 3), directions (N, 3), flux (N, 3) W, entries (N,) of the table of lights) of particles
    as they leave their lights.
    """

def exp(x: numpy.ndarray) -> numpy.ndarray:
    """
    The portable exp on a flat array.
    """

def expm1(x: numpy.ndarray) -> numpy.ndarray:
    """
    The portable exp(x) - 1 on a flat array.
    """

def fill_gbuffer(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    camera: tuple[typing.Any, ...],
    face: numpy.ndarray,
    shape: numpy.ndarray,
    primitive: numpy.ndarray,
    gbuffer: collections.abc.Mapping[str, numpy.ndarray],
) -> None:
    """
    Writes the arrays of gbuffer; face (N,) is negative where nothing is seen; shape (F,) of each face counts instances of meshes, then spheres.
    """

def follow_screen_rays(
    inverse_depth: numpy.ndarray,
    normals: numpy.ndarray,
    intrinsics: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
    ],
    length: typing.SupportsFloat | typing.SupportsIndex,
    thickness: typing.SupportsFloat | typing.SupportsIndex,
    steps: typing.SupportsInt | typing.SupportsIndex,
    wi: numpy.ndarray,
    hit: numpy.ndarray,
) -> None:
    """
    hit (H, W) int32: a pixel, -1 for a ray that meets nothing, -2 for one that leaves.
    """

def frequency_encode(
    points: numpy.ndarray,
    octaves: typing.SupportsInt | typing.SupportsIndex,
    features: numpy.ndarray,
) -> None: ...
def frequency_encode_backward(
    points: numpy.ndarray,
    octaves: typing.SupportsInt | typing.SupportsIndex,
    d_features: numpy.ndarray,
    d_points: numpy.ndarray,
) -> None: ...
def gbuffer_pdf(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    eye: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    gbuffer: collections.abc.Mapping[str, numpy.ndarray],
    wi: numpy.ndarray,
    pdf: numpy.ndarray,
) -> None: ...
def hash_encode(
    settings: HashSettings, table: numpy.ndarray, points: numpy.ndarray, features: numpy.ndarray
) -> None:
    """
    Writes features (N, levels F) of points (N, D) in the unit cube.
    """

def hash_encode_backward(
    settings: HashSettings,
    table: numpy.ndarray,
    points: numpy.ndarray,
    d_features: numpy.ndarray,
    d_table: numpy.ndarray,
    d_points: numpy.ndarray | None,
) -> None:
    """
    Adds to d_table, and to d_points unless None.
    """

def horizon_occlusion(
    inverse_depth: numpy.ndarray,
    normals: numpy.ndarray,
    intrinsics: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
    ],
    radius: typing.SupportsFloat | typing.SupportsIndex,
    falloff: typing.SupportsFloat | typing.SupportsIndex,
    slices: typing.SupportsInt | typing.SupportsIndex,
    steps: typing.SupportsInt | typing.SupportsIndex,
    out: numpy.ndarray,
) -> None: ...
def instruction_set() -> str:
    """
    Name of the kernels in use: baseline, v3 or v4.
    """

def interpolate(
    attributes: numpy.ndarray,
    faces: numpy.ndarray,
    face: numpy.ndarray,
    barycentrics: numpy.ndarray,
    out: numpy.ndarray,
) -> None:
    """
    Writes the pixels that see a face.
    """

def interpolate_backward(
    attributes: numpy.ndarray,
    faces: numpy.ndarray,
    face: numpy.ndarray,
    barycentrics: numpy.ndarray,
    d_out: numpy.ndarray,
    d_attributes: numpy.ndarray,
    d_barycentrics: numpy.ndarray,
) -> None:
    """
    Adds to d_attributes, writes d_barycentrics where a face is seen.
    """

def light_gbuffer(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    eye: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    gbuffer: collections.abc.Mapping[str, numpy.ndarray],
    wi: numpy.ndarray,
    irradiance: numpy.ndarray,
    out: numpy.ndarray,
) -> None:
    """
    Adds to out (N, 3).
    """

def light_gbuffer_parallel(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    eye: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    gbuffer: collections.abc.Mapping[str, numpy.ndarray],
    wi: numpy.ndarray,
    irradiance: numpy.ndarray,
    visible: numpy.ndarray,
    out: numpy.ndarray,
) -> None:
    """
    Adds to out (N, 3).
    """

def log1p_unit(x: numpy.ndarray) -> numpy.ndarray:
    """
    The portable ln(1 + x) for x in [0, 1] on a flat array.
    """

def march(
    field: str,
    parameters: numpy.ndarray,
    settings: MarchSettings,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    fused: bool = True,
) -> tuple[typing.Any, ...]:
    """
    Color without background (R, 3), transmittance (R,) and depth (R,). rays: origins (R, 3), directions (R, 3), t0 (R,), samples (R,) int32.
    """

def march_backward(
    field: str,
    parameters: numpy.ndarray,
    settings: MarchSettings,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_parameters: numpy.ndarray,
    d_rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"] | None = None,
    fused: bool = True,
) -> None:
    """
    Adds to d_parameters and, where given, to d_rays: d_origins and d_directions.
    """

def march_neural(
    settings: NeuralSettings,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    occupancy: numpy.ndarray | None,
    march: MarchSettings,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    keep: NeuralSamples | None = None,
    placed: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"] | None = None,
) -> tuple[typing.Any, ...]:
    """
    (color, transmittance, depth) of rays through a field of networks. parameters: table, density network, color network; occupancy (K, K, K) uint8, z y x, or None. Samples are written to keep unless None; placed: their t and width (R, N), or None.
    """

def march_neural_backward(
    settings: NeuralSettings,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    occupancy: numpy.ndarray | None,
    march: MarchSettings,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"] | None,
    kept: NeuralSamples | None = None,
    placed: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"] | None = None,
) -> None:
    """
    Adds to d_parameters, and to d_rays unless None. kept: of the forward pass, or None.
    """

def march_octree_sh(
    tree: Octree,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    density_scale: typing.SupportsFloat | typing.SupportsIndex,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    cell: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    stop: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[typing.Any, ...]:
    """
    (color, transmittance, depth) of rays through the leaves of an octree. parameters: row (L,), density (N,), sh (N, K, 3); rays: origins and directions in cells, directions in the world, (R, 3) each; cell (3,): sides of a cell in meters.
    """

def march_octree_sh_backward(
    tree: Octree,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    density_scale: typing.SupportsFloat | typing.SupportsIndex,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    cell: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    stop: typing.SupportsFloat | typing.SupportsIndex,
    outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"],
    d_rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"] | None,
) -> None:
    """
    Adds to d_parameters, d_density and d_sh, and to d_rays unless None.
    """

def march_sparse_sh(
    table: CellTable,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    settings: MarchSettings,
    color_offset: typing.SupportsFloat | typing.SupportsIndex,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    fused: bool = True,
    skip: bool = True,
) -> tuple[typing.Any, ...]:
    """
    Color without background (R, 3), transmittance (R,), depth (R,), samples looked up. parameters: density (N,), sh (N, K, 3), background (1 + 3 K,).
    """

def march_sparse_sh_backward(
    table: CellTable,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    settings: MarchSettings,
    color_offset: typing.SupportsFloat | typing.SupportsIndex,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_outputs: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    d_rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"] | None = None,
    fused: bool = True,
) -> None:
    """
    Adds to d_parameters and, where given, to d_rays: d_origins and d_directions.
    """

def mip_level(
    height: typing.SupportsInt | typing.SupportsIndex,
    width: typing.SupportsInt | typing.SupportsIndex,
    footprint: numpy.ndarray,
) -> numpy.ndarray:
    """
    Level (N,) of footprints (N, 2, 2): du/dx, dv/dx; du/dy, dv/dy.
    """

def mip_shapes(
    height: typing.SupportsInt | typing.SupportsIndex,
    width: typing.SupportsInt | typing.SupportsIndex,
) -> list[tuple[int, int]]:
    """
    Height and width of every level of a mip map.
    """

def neural_densities(
    settings: NeuralSettings,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    march: MarchSettings,
    points: numpy.ndarray,
    sigma_t: numpy.ndarray,
) -> None:
    """
    Writes extinctions (N,), 1/m, at points (N, 3) of the unit cube.
    """

def normalized_diffusion(rows: numpy.ndarray, fit: str) -> numpy.ndarray:
    """
    R (N,) in 1/m^2 of rows (N, 3): radius, albedo, mean free path.
    """

def normalized_diffusion_backward(
    rows: numpy.ndarray, fit: str, d_values: numpy.ndarray, d_rows: numpy.ndarray
) -> None:
    """
    Adds to d_rows (N, 3) for d_values (N,).
    """

def octree_sh_weights(
    tree: Octree,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    density_scale: typing.SupportsFloat | typing.SupportsIndex,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    cell: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    stop: typing.SupportsFloat | typing.SupportsIndex,
    max_weight: numpy.ndarray,
) -> None:
    """
    Raises max_weight (N,) to the largest weight of each row in one of these rays.
    """

def one_blob_encode(
    points: numpy.ndarray, bins: typing.SupportsInt | typing.SupportsIndex, features: numpy.ndarray
) -> None: ...
def one_blob_encode_backward(
    points: numpy.ndarray,
    bins: typing.SupportsInt | typing.SupportsIndex,
    d_features: numpy.ndarray,
    d_points: numpy.ndarray,
) -> None: ...
def order_by_depth(depth: numpy.ndarray, far_first: bool) -> numpy.typing.NDArray[numpy.uint32]:
    """
    Rows (N,) uint32 by depth (N,) float64, none below 0; equals keep their order.
    """

def perceptron_backward(
    shape: PerceptronShape,
    parameters: numpy.ndarray,
    inputs: numpy.ndarray,
    d_outputs: numpy.ndarray,
    d_parameters: numpy.ndarray,
    d_inputs: numpy.ndarray | None,
    fused: bool = True,
    values: PerceptronValues | None = None,
) -> None:
    """
    Adds to d_parameters; writes d_inputs unless None. values: of forward, or None.
    """

def perceptron_forward(
    shape: PerceptronShape,
    parameters: numpy.ndarray,
    inputs: numpy.ndarray,
    outputs: numpy.ndarray,
    fused: bool = True,
    values: PerceptronValues | None = None,
) -> None:
    """
    Writes outputs of inputs (N, shape's). fused: by the kernel, for float32. Fills values.
    """

def perceptrons_backward(
    shape: PerceptronShape,
    parameters: numpy.ndarray,
    offset: numpy.ndarray,
    inputs: numpy.ndarray,
    d_outputs: numpy.ndarray,
    d_parameters: numpy.ndarray,
    d_inputs: numpy.ndarray,
) -> None:
    """
    Adds to d_parameters (rows of parameters); writes d_inputs.
    """

def perceptrons_forward(
    shape: PerceptronShape,
    parameters: numpy.ndarray,
    offset: numpy.ndarray,
    inputs: numpy.ndarray,
    outputs: numpy.ndarray,
) -> None:
    """
    Writes outputs of inputs (M, shape's): those from offset[n] on by row n of parameters.
    """

def philox4x32(counter: numpy.ndarray, key: numpy.ndarray) -> numpy.typing.NDArray[numpy.uint32]:
    """
    Philox4x32-10 words (N, 4) uint32 of counters (N, 4) under keys (N, 2).
    """

def place_samples(
    settings: MarchSettings,
    origins: numpy.ndarray,
    directions: numpy.ndarray,
    jitter: numpy.ndarray | None = None,
) -> tuple[typing.Any, ...]:
    """
    Per ray: t0 (R,) and the number of samples (R,) int32.
    """

def point_occlusion(
    geometry: PathGeometry,
    points: numpy.ndarray,
    normals: numpy.ndarray,
    radius: typing.SupportsFloat | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    sums: numpy.ndarray,
) -> None:
    """
    Adds to sums (N,) how many samples are free at points (N, 3) with unit normals (N, 3), float64.
    """

def prepare_splat_rays(
    gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
    options: RayOptions,
    origins: numpy.ndarray,
    directions: numpy.ndarray,
    background: numpy.ndarray,
) -> typing.Any:
    """
    Whitens and boxes the Gaussians; PreparedRays32 or PreparedRays64.
    """

def prepare_splats(
    gaussians: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(5)"],
    image: SplatImage,
    options: SplatOptions,
    camera_from_world: numpy.ndarray,
    background: numpy.ndarray,
) -> typing.Any:
    """
    Projects, sorts and bins; PreparedSplats32 or PreparedSplats64. gaussians: means (N, 3), log_scales (N, 3), quats (N, 4), opacity_logits (N,), sh (N, K, 3).
    """

def principled_values(
    parameters: numpy.ndarray,
    wo: numpy.ndarray,
    wi: numpy.ndarray,
    cosine: bool,
    values: numpy.ndarray,
) -> None:
    """
    Writes values (N, 3), times the cosine of wi on request. parameters (T, 5): base color, metalness, roughness; evaluation n takes row n mod T. float32.
    """

def principled_values_backward(
    parameters: numpy.ndarray,
    wo: numpy.ndarray,
    wi: numpy.ndarray,
    cosine: bool,
    d_values: numpy.ndarray,
    d_parameters: numpy.ndarray,
) -> None:
    """
    Adds to d_parameters (T, 5) for d_values (N, 3).
    """

def project(
    vertices: numpy.ndarray,
    camera_from_world: numpy.ndarray,
    intrinsics: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
    ],
    positions: numpy.ndarray,
) -> None:
    """
    positions (V, 3) in homogeneous pixels; camera_from_world (3, 4), (fx, fy, cx, cy).
    """

def rasterize(
    positions: numpy.ndarray,
    faces: numpy.ndarray,
    near: typing.SupportsFloat | typing.SupportsIndex,
    far: typing.SupportsFloat | typing.SupportsIndex,
    cull: typing.SupportsInt | typing.SupportsIndex,
    depth_test: typing.SupportsInt | typing.SupportsIndex,
    depth_write: bool,
    stencil_rules: typing.Annotated[
        collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(7)"
    ],
    first_face: typing.SupportsInt | typing.SupportsIndex,
    face: numpy.ndarray,
    barycentrics: numpy.ndarray,
    depth: numpy.ndarray,
    stencil: typing.Any,
    overdraw: typing.Any,
    behind: numpy.ndarray | None = None,
    face_mask: numpy.ndarray | None = None,
) -> None:
    """
    Draws onto face, barycentrics and depth, and onto stencil and overdraw unless None; only what lies behind `behind` (H, W), and only faces of face_mask (F,), unless None.
    """

def rasterize_backward(
    positions: numpy.ndarray,
    faces: numpy.ndarray,
    face: numpy.ndarray,
    d_barycentrics: numpy.ndarray,
    d_depth: numpy.ndarray,
    d_positions: numpy.ndarray,
) -> None:
    """
    Adds to d_positions.
    """

def rasterize_depth(
    positions: numpy.ndarray,
    faces: numpy.ndarray,
    near: typing.SupportsFloat | typing.SupportsIndex,
    far: typing.SupportsFloat | typing.SupportsIndex,
    depth: numpy.ndarray,
    face_mask: numpy.ndarray | None = None,
) -> None:
    """
    Writes depth (H, W) alone, infinite where nothing is seen; of faces of face_mask (F,) unless None.
    """

def read_vdb(
    path: str, memory_limit: typing.SupportsInt | typing.SupportsIndex
) -> tuple[list[SparseGrid], dict[str, bool | int | float | str]]:
    """
    The grids of a file and its metadata.
    """

def sample(texture: numpy.ndarray, uv: numpy.ndarray, out: numpy.ndarray) -> None:
    """
    Writes the colors (N, C) of a texture (H, W, C) at uv (N, 2) to out.
    """

def sample_backward(
    texture: numpy.ndarray,
    uv: numpy.ndarray,
    d_color: numpy.ndarray,
    d_texture: numpy.ndarray | None = None,
    d_uv: numpy.ndarray | None = None,
) -> None:
    """
    Adds to d_texture (H, W, C) and d_uv (N, 2), where given.
    """

def sample_bricks(
    topology: BrickTopology,
    values: numpy.ndarray,
    background: numpy.ndarray,
    points: numpy.ndarray,
    out: numpy.ndarray,
) -> None:
    """
    Writes the values at index-space points (P, 3).
    """

def sample_bricks_backward(
    topology: BrickTopology,
    values: numpy.ndarray,
    background: numpy.ndarray,
    points: numpy.ndarray,
    d_out: numpy.ndarray,
    d_values: numpy.ndarray,
    d_background: numpy.ndarray,
    d_points: numpy.ndarray,
) -> None:
    """
    Adds the derivatives to the last three.
    """

def sample_diffusion_radius(rows: numpy.ndarray, fit: str) -> numpy.ndarray:
    """
    Radii (N,) of rows (N, 3): u, albedo, mean free path.
    """

def sample_diffusion_radius_backward(
    rows: numpy.ndarray, fit: str, d_values: numpy.ndarray, d_rows: numpy.ndarray
) -> None:
    """
    Adds to d_rows (N, 3) for d_values (N,).
    """

def sample_gbuffer(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    eye: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
    ],
    gbuffer: collections.abc.Mapping[str, numpy.ndarray],
    u: numpy.ndarray,
    wi: numpy.ndarray,
    weight: numpy.ndarray,
    pdf: numpy.ndarray,
) -> None:
    """
    weight (N, 3) is f cos / pdf; pdf (N,) is 0 of specular surfaces.
    """

def sample_mips(
    mips: collections.abc.Sequence[numpy.ndarray],
    uv: numpy.ndarray,
    level: numpy.ndarray,
    out: numpy.ndarray,
) -> None:
    """
    Writes the colors (N, C) at uv (N, 2) and level (N,) to out.
    """

def sample_mips_backward(
    mips: collections.abc.Sequence[numpy.ndarray],
    uv: numpy.ndarray,
    level: numpy.ndarray,
    d_color: numpy.ndarray,
    d_mips: collections.abc.Sequence[numpy.ndarray],
    d_uv: numpy.ndarray,
    d_level: numpy.ndarray,
) -> None:
    """
    Adds to all levels of d_mips, d_uv (N, 2) and d_level (N,).
    """

def sample_weights(
    offset: numpy.ndarray, sigma_t: numpy.ndarray, dt: typing.SupportsFloat | typing.SupportsIndex
) -> tuple[typing.Any, ...]:
    """
    weight (M,), transmittance behind each sample (M,), and of each ray (R,).
    """

def sample_weights_backward(
    offset: numpy.ndarray,
    weights: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"],
    dt: typing.SupportsFloat | typing.SupportsIndex,
    d_weights: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(2)"],
) -> numpy.ndarray:
    """
    d_sigma_t (M,). weights: weight and behind; d_weights: d_weight, d_transmittance (R,).
    """

def set_thread_count(threads: typing.SupportsInt | typing.SupportsIndex) -> None:
    """
    Upper limit on threads; 0 restores the default, all cores.
    """

def sh_colors(
    directions: numpy.ndarray,
    coefficients: numpy.ndarray,
    colors: numpy.ndarray,
    fused: bool = True,
) -> None:
    """
    Writes sum_k Y_k(directions) coefficients[:, k] to colors (N, C). fused=False forces the scalar form, the oracle of the kernel.
    """

def sh_colors_backward(
    directions: numpy.ndarray,
    coefficients: numpy.ndarray,
    d_colors: numpy.ndarray,
    d_directions: numpy.ndarray,
    d_coefficients: numpy.ndarray,
    add: bool = True,
    fused: bool = True,
) -> None:
    """
    Adds the derivatives to d_directions (N, 3) and d_coefficients (N, K, C); with add=False overwrites what stands there, without reading it.
    """

def shadow_lookup(
    depths: numpy.ndarray,
    pixels_from_world: numpy.ndarray,
    radius: typing.SupportsInt | typing.SupportsIndex,
    depth_bias: typing.SupportsFloat | typing.SupportsIndex,
    normal_bias: typing.SupportsFloat | typing.SupportsIndex,
    texel: typing.SupportsFloat | typing.SupportsIndex,
    points: numpy.ndarray,
    normals: numpy.ndarray,
    visibility: numpy.ndarray,
) -> None: ...
def silhouettes(
    positions: numpy.ndarray, ends: numpy.ndarray, opposite: numpy.ndarray, out: numpy.ndarray
) -> None: ...
def sobol_words(
    seed: typing.SupportsInt | typing.SupportsIndex,
    step: typing.SupportsInt | typing.SupportsIndex,
    block: typing.SupportsInt | typing.SupportsIndex,
    pixel: numpy.ndarray,
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
) -> numpy.typing.NDArray[numpy.uint32]:
    """
    Words (N, count, 4) uint32 of scrambled Sobol' points first, first + 1, ... of pixels (N,).
    """

def sparse_adam(
    parameter: numpy.ndarray,
    gradient: numpy.ndarray,
    mean: numpy.ndarray,
    mean_square: numpy.ndarray,
    step: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
    ],
) -> None:
    """
    Adam on the rows with a gradient; step is beta_1, beta_2, length, epsilon.
    """

def sparse_sh_weights(
    table: CellTable,
    parameters: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(3)"],
    settings: MarchSettings,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
    max_weight: numpy.ndarray,
) -> None:
    """
    Raises max_weight (N,) to the largest weight of each voxel over these rays.
    """

def square_to_cap(
    u2: numpy.ndarray, height: typing.SupportsFloat | typing.SupportsIndex
) -> numpy.ndarray:
    """
    Uniform directions (N, 3) with z >= 1 - height, from uniform u2 (N, 2).
    """

def square_to_cosine_hemisphere(u2: numpy.ndarray) -> numpy.ndarray:
    """
    Directions (N, 3) around +Z, density cos / pi, from uniform u2 (N, 2).
    """

def square_to_disk(u2: numpy.ndarray) -> numpy.ndarray:
    """
    Uniform points (N, 2) of the unit disk from uniform u2 (N, 2).
    """

def ssao(
    inverse_depth: numpy.ndarray,
    normals: numpy.ndarray,
    intrinsics: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
    ],
    settings: numpy.ndarray,
    samples: typing.SupportsInt | typing.SupportsIndex,
    out: numpy.ndarray,
) -> None:
    """
    settings: (radius, falloff, bias, distribution, strength).
    """

def ssao_backward(
    inverse_depth: numpy.ndarray,
    normals: numpy.ndarray,
    intrinsics: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
    ],
    settings: numpy.ndarray,
    samples: typing.SupportsInt | typing.SupportsIndex,
    d_out: numpy.ndarray,
    d_settings: numpy.ndarray,
) -> None:
    """
    Adds to d_settings.
    """

def ssim(x: numpy.ndarray, y: numpy.ndarray) -> float:
    """
    Mean structural similarity of two pictures (H, W, C) in 0 .. 1.
    """

def ssim_backward(
    x: numpy.ndarray,
    y: numpy.ndarray,
    d_value: typing.SupportsFloat | typing.SupportsIndex,
    d_x: numpy.ndarray,
) -> float:
    """
    Adds d_value times its derivative to d_x (H, W, C); returns the value.
    """

def thread_count() -> int: ...
def tone_map(
    color: numpy.ndarray,
    curve: typing.SupportsInt | typing.SupportsIndex,
    params: numpy.ndarray,
    out: numpy.ndarray,
) -> None: ...
def tone_map_backward(
    color: numpy.ndarray,
    curve: typing.SupportsInt | typing.SupportsIndex,
    params: numpy.ndarray,
    d_out: numpy.ndarray,
    d_color: numpy.ndarray,
    d_params: numpy.ndarray,
) -> None:
    """
    Adds to d_color and d_params.
    """

def total_variation(topology: BrickTopology, values: numpy.ndarray) -> float:
    """
    Squared total variation of values (N, C) over pairs of active neighbors.
    """

def total_variation_backward(
    topology: BrickTopology,
    values: numpy.ndarray,
    d_value: typing.SupportsFloat | typing.SupportsIndex,
    first: typing.SupportsInt | typing.SupportsIndex,
    last: typing.SupportsInt | typing.SupportsIndex,
    d_values: numpy.ndarray,
) -> None:
    """
    Adds to the rows of d_values that belong to bricks first .. last - 1.
    """

def trace_light(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    rectangle: numpy.ndarray,
    irradiance: numpy.ndarray,
    squares: numpy.ndarray,
) -> None:
    """
    Adds what particles bring to a rectangle (corner, edge_x, edge_y) (3, 3) to irradiance (H, W, 3),
    and its squares, float64. options: (max_depth, roulette_from, seed).
    """

def trace_path(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    pixel: typing.SupportsInt | typing.SupportsIndex,
    sample: typing.SupportsInt | typing.SupportsIndex,
) -> list[typing.Any]:
    """
    One path, a dictionary a vertex.
    """

def trace_paths(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    sampling_parameters: numpy.ndarray | None,
    sampling_textures: collections.abc.Sequence[numpy.ndarray] | None,
    sampling_media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ]
    | None,
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    radiance: numpy.ndarray,
    squares: numpy.ndarray,
    hits: numpy.ndarray | None = None,
) -> None:
    """
    Adds samples to radiance (H, W, 3) and squares (H, W, 3), float64. options: (strategy, heuristic, max_depth, roulette_from, sampler, seed).
    media: (phase function or "", parameters (P,), densities (X, Y, Z) or None, sigma_maj). hits: None, or (H, W) float64,
    to which the number of samples is added that see more than the background; the others then add nothing.
    """

def trace_paths_backward(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    spp: typing.SupportsInt | typing.SupportsIndex,
    counts: numpy.ndarray | None,
    d_image: numpy.ndarray,
    gradient: collections.abc.Mapping[str, numpy.ndarray],
) -> None:
    """
    Adds derivatives for dL/d(mean radiance) to the arrays of gradient, {name: array}: parameters (P,),
    emission (S, 3), lights.I and textures.I, arrays like those of the scene, media.I (rows), densities.I
    (X, Y, Z) of media with a grid. counts (H, W) uint32, or None: spp samples of each pixel.
    """

def trace_paths_tangent(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    v_parameters: numpy.ndarray,
    v_emission: numpy.ndarray,
    v_lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    v_textures: collections.abc.Sequence[numpy.ndarray],
    v_media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    radiance: numpy.ndarray,
    squares: numpy.ndarray,
    d_radiance: numpy.ndarray,
    d_squares: numpy.ndarray,
) -> None:
    """
    As trace_paths, and adds to d_radiance (H, W, 3) and d_squares how the samples change along v,
    which has the shapes of what it moves. float64.
    """

def trace_photons(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    map: PhotonMap,
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    radiance: numpy.ndarray,
    squares: numpy.ndarray,
) -> None:
    """
    Adds samples of a picture, as trace_paths does.
    """

def trace_reference(
    geometry: PathGeometry,
    models: collections.abc.Sequence[str],
    parameters: numpy.ndarray,
    emission: numpy.ndarray,
    lights: collections.abc.Sequence[tuple[typing.Any, ...]],
    textures: collections.abc.Sequence[numpy.ndarray],
    media: collections.abc.Sequence[
        tuple[str, numpy.ndarray, numpy.ndarray | None, typing.SupportsFloat | typing.SupportsIndex]
    ],
    camera: tuple[typing.Any, ...],
    options: tuple[
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
        typing.SupportsInt | typing.SupportsIndex,
    ],
    first: typing.SupportsInt | typing.SupportsIndex,
    count: typing.SupportsInt | typing.SupportsIndex,
    radiance: numpy.ndarray,
    squares: numpy.ndarray,
) -> None:
    """
    As trace_paths, by a scalar tracer that is written to be read; float64.
    """

def turn_vectors(vectors: numpy.ndarray, rotation: numpy.ndarray, out: numpy.ndarray) -> None:
    """
    out (N, 3) = vectors (N, 3) times rotation (3, 3).
    """

def uniform(
    seed: typing.SupportsInt | typing.SupportsIndex,
    step: typing.SupportsInt | typing.SupportsIndex,
    pixel: numpy.ndarray,
    sample: typing.SupportsInt | typing.SupportsIndex,
    dimension: typing.SupportsInt | typing.SupportsIndex,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Uniform numbers (N,) in [0, 1) for pixels (N,), as photograd_course.random defines them.
    """

def view_directions(
    camera: tuple[typing.Any, ...], pixels: numpy.ndarray, out: numpy.ndarray
) -> None:
    """
    Unit directions (N, 3) through the centers of pixels (N,) int64.
    """

def visible_samples(
    table: CellTable,
    settings: MarchSettings,
    rays: typing.Annotated[collections.abc.Sequence[numpy.ndarray], "FixedSize(4)"],
) -> tuple[typing.Any, ...]:
    """
    offset (R + 1,), t (M,) and points (M, 3) in voxels of the samples of rays that lie in cells with an active voxel.
    """

def write_vdb(
    path: str,
    grids: collections.abc.Sequence[SparseGrid],
    metadata: collections.abc.Mapping[
        str,
        bool
        | typing.SupportsInt
        | typing.SupportsIndex
        | typing.SupportsFloat
        | typing.SupportsIndex
        | str,
    ],
    half: bool | None,
) -> None: ...

__version__: str = "0.2.0"
bsdfs: dict[str, typing.Any]
delta_bsdfs: dict[str, typing.Any]
fields: tuple[typing.Any, ...] = ("dense_grid", "tiny_network")
lights: dict[str, typing.Any]
max_samples: int = 262144
neural_direction_numbers: int = 16
ops: dict[str, typing.Any]
phases: dict[str, typing.Any]
sampled_lights: dict[str, typing.Any]
tiny_network_parameters: int = 132
