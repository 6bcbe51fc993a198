"""Sparse lattices, bricks, octrees and hash tables of voxels, and files of grids and volumes."""

from __future__ import annotations

from photograd.grids.bricks import BrickField
from photograd.grids.octree import Octree, Quadtree
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import VdbFile, read_vdb, write_vdb
from photograd.grids.volumes import Volume, read_volume
from photograd.grids.voxel_hash import VoxelHash

__all__ = [
    "BrickField",
    "Octree",
    "Quadtree",
    "SparseGrid",
    "VdbFile",
    "Volume",
    "VoxelHash",
    "read_vdb",
    "read_volume",
    "write_vdb",
]
