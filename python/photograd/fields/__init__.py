"""Scene representations, one a file. Importing this package registers them all."""

from __future__ import annotations

from photograd.fields.dense_grid import DenseGrid
from photograd.fields.dense_sh import DenseSh
from photograd.fields.gaussians_2d import Gaussians2D
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.points import Points
from photograd.fields.sparse_sh import SparseSh
from photograd.fields.sunlit_medium import SunlitMedium
from photograd.fields.texture_2d import Texture2D
from photograd.fields.tiny_network import TinyNetwork
from photograd.fields.toy_blobs import ToyBlobs
from photograd.splats.model import GaussianScene

__all__ = [
    "DenseGrid",
    "DenseSh",
    "GaussianScene",
    "Gaussians2D",
    "OctreeSh",
    "Points",
    "SparseSh",
    "SunlitMedium",
    "Texture2D",
    "TinyNetwork",
    "ToyBlobs",
]
