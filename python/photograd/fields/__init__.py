"""Scene representations, one a file. Importing this package registers them all."""

from __future__ import annotations

from photograd_course.suggest import nearest

from photograd.errors import RangeError, message
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.dense_sh import DenseSh
from photograd.fields.gaussian_codes import GaussianCodes
from photograd.fields.gaussians_2d import Gaussians2D
from photograd.fields.hash_grid import HashGrid
from photograd.fields.leaf_codes import LeafCodes
from photograd.fields.leaf_mlps import LeafMlps
from photograd.fields.mesh_surface import MeshSurface
from photograd.fields.nerf import Nerf
from photograd.fields.neural_image import ImagePolicy, NeuralImage
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.plenoctree import PlenOctree
from photograd.fields.points import Points
from photograd.fields.sparse_sh import SparseSh
from photograd.fields.sunlit_medium import SunlitMedium
from photograd.fields.texture_2d import Texture2D
from photograd.fields.textured_mesh import TexturedMesh
from photograd.fields.textured_surface import TexturedSurface
from photograd.fields.tiny_network import TinyNetwork
from photograd.fields.toy_blobs import ToyBlobs
from photograd.representation import REGISTERED, Fittable, Representation, fittable
from photograd.splats.model import GaussianScene

__all__ = [
    "DenseGrid",
    "DenseSh",
    "Fittable",
    "GaussianCodes",
    "GaussianScene",
    "Gaussians2D",
    "HashGrid",
    "ImagePolicy",
    "LeafCodes",
    "LeafMlps",
    "MeshSurface",
    "Nerf",
    "NeuralImage",
    "OctreeSh",
    "PlenOctree",
    "Points",
    "SparseSh",
    "SunlitMedium",
    "Texture2D",
    "TexturedMesh",
    "TexturedSurface",
    "TinyNetwork",
    "ToyBlobs",
    "fittable",
    "representation",
    "representations",
]


def representations() -> dict[str, type[Representation]]:
    """All registered representations by name.

    Example:
        >>> photograd.representations()["dense_grid"]
        <class 'photograd.fields.dense_grid.DenseGrid'>
    """
    return dict(REGISTERED)


def representation(name: str) -> type[Representation]:
    """The representation called `name`; an unknown name is answered with the nearest known one."""
    known = representations()
    if name in known:
        return known[name]
    near = nearest(name, known)
    remedy = f"did you mean {near!r}?" if near else "choose one of these"
    raise RangeError(
        message("representation", "name", f"one of {sorted(known)}", repr(name), remedy)
    )
