"""Geometry that is written to be read, beside what is written to be fast (`mesh`).

A hierarchy of boxes that counts what a ray costs, a partition of space that puts polygons in an
order, octrees that drop what a camera cannot see, coarser meshes with a bound on what they get
wrong, and signed distance functions, whose hits have derivatives.
"""

from __future__ import annotations

from photograd.geometry.bsp import BspTree, order_by_distance
from photograd.geometry.culling import CullingTree, Frustum
from photograd.geometry.detail import Level, LevelsOfDetail, clustered
from photograd.geometry.mesh import nearest_on_mesh
from photograd.geometry.reference_bvh import BvhHits, ReferenceBvh
from photograd.geometry.sdf import Body, SdfHits
from photograd.geometry.sdf_picture import BodyPicture, draw_body

__all__ = [
    "Body",
    "BodyPicture",
    "BspTree",
    "BvhHits",
    "CullingTree",
    "Frustum",
    "Level",
    "LevelsOfDetail",
    "ReferenceBvh",
    "SdfHits",
    "clustered",
    "draw_body",
    "nearest_on_mesh",
    "order_by_distance",
]
