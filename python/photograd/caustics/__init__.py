"""Lenses whose caustic is a picture, and chains of specular surfaces with attached derivatives.

    lens = Lens(corner, edge_x, edge_y, thickness=0.02, heights=np.zeros((129, 129)))
    found = design_caustic(lens, light, receiver, picture)
    write_stl("lens.stl", *found.lenses[0].closed_mesh())

`trace_chains` follows rays through glass and off mirrors, and its adjoint moves what is behind a
surface with it: derivatives with respect to vertices, normals, spheres and eta, which path
tracing with paths held fixed does not have. All calculate in float64 and give the same bits on any
number of threads.
"""

from __future__ import annotations

from photograd.caustics.chains import Chains, SpecularScene, trace_chains, trace_chains_backward
from photograd.caustics.design import CausticDesign, CausticResult, design_caustic
from photograd.caustics.lens import Lens
from photograd.caustics.measure import Caustic, measure
from photograd.caustics.options import CausticOptions
from photograd.caustics.picture import discontinuities, specular_picture, specular_picture_backward
from photograd.caustics.start import transport_lens
from photograd.caustics.surfaces import SpecularMesh, SpecularSphere, SurfaceGradient
from photograd.caustics.transport_map import Axes, transport_map

__all__ = [
    "Axes",
    "Caustic",
    "CausticDesign",
    "CausticOptions",
    "CausticResult",
    "Chains",
    "Lens",
    "SpecularMesh",
    "SpecularScene",
    "SpecularSphere",
    "SurfaceGradient",
    "design_caustic",
    "discontinuities",
    "measure",
    "specular_picture",
    "specular_picture_backward",
    "trace_chains",
    "trace_chains_backward",
    "transport_lens",
    "transport_map",
]
