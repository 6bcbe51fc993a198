"""Bodies of signed distances as shapes of a scene: no triangles, and smooth at any distance.

A ray meets them by steps of the distance (cpp/photograd/geometry/sdf_solid.h) [Hart1996]; the
normal is the gradient of the distance.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from photograd.errors import SceneError, message
from photograd.geometry.sdf import Body
from photograd.geometry.sdf import Shape as SdfNode
from photograd.transport.shape_checks import checked_color
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class SdfShape:
    """What `photograd.geometry.sdf` builds, with a surface.

    Attributes:
        name: unique in its scene.
        body: a tree of spheres, boxes, tori, ... and of what combines them, in metres of the world.
            It is closed, so that it may be of glass, or filled with a medium. It must end on all
            sides: planes only cut.
        material, interior: as for `MeshShape`. Materials with textures need coordinates, which a
            body has none of.
        emission: 0. Where on such a surface a light sample would go is not known in closed form.

    Raises:
        SceneError: a body that is none, is empty, has no end or nests too deeply; one that shines.
        RangeError: negative emission.
    """

    name: str
    body: SdfNode
    material: str
    emission: Array = field(default_factory=lambda: np.zeros(3))
    interior: str | None = None
    ready: Body = field(init=False, repr=False)
    box: Array = field(init=False, repr=False)
    """(2, 3) lower and upper corner of a box around the body, metres."""

    def __post_init__(self) -> None:
        if not isinstance(self.body, SdfNode):
            expected = "a shape of photograd.geometry.sdf"
            got = type(self.body).__name__
            raise SceneError(message("SdfShape", f"{self.name}.body", expected, got))
        emission = checked_color(self.name, "emission", self.emission)
        if emission.any():
            expected, remedy = "0", "let a mesh or a sphere shine"
            raise SceneError(
                message("SdfShape", f"{self.name}.emission", expected, emission, remedy)
            )
        object.__setattr__(self, "emission", emission)
        object.__setattr__(self, "ready", Body(self.body))
        object.__setattr__(self, "box", self.ready.box)
