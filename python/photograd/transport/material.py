"""Materials of a scene: a reflectance model, its parameters, and textures that scale them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from photograd_course.suggest import choose_from

from photograd import bsdf
from photograd._arrays import Arguments
from photograd._registry import ModelParameter, ModelParameters
from photograd._typed import typed_call
from photograd.bsdf import specular
from photograd.errors import SceneError, message
from photograd.transport.shape_checks import check_range
from photograd.transport.texture import NormalMap, OcclusionMap, TextureUse, checked_uses
from photograd.types import Array

MODELS: dict[str, bsdf.BsdfModel | specular.DeltaModel] = {**bsdf.registry(), **specular.registry()}
"""All reflectance models, rough and smooth, by name."""
ALPHA = ModelParameter("alpha", 1, 0.0, 1.0, "")
"""What any material may have besides the parameters of its model."""


@typed_call
@dataclass(frozen=True)
class Material:
    """A reflectance model and its parameters.

    Attributes:
        model: a name of `MODELS`.
        values: {parameter: number or (3,)}, all of them; and "alpha", if the surface covers only
            that part of what lies behind it (0 to 1): the rest of the light goes straight through.
        textures: {parameter: the texture that scales its value}; the product is brought into the
            parameter's range.
        normal_map: bends the shading normals, or None.
        alpha_cutoff: of a mask, or None: where alpha times its texture is at least this, the
            surface covers all, elsewhere nothing. A mask has no derivative with respect to alpha.
        occlusion: of ambient light, or None. Paths find what is occluded themselves.

    Raises:
        SceneError: no such model, or a cutoff without alpha.
        RangeError, ShapeError: parameters missing, unknown, not finite, outside of their range or
            of another shape.
    """

    model: str
    values: Mapping[str, Any]
    textures: Mapping[str, TextureUse] = field(default_factory=dict)
    normal_map: NormalMap | None = None
    alpha_cutoff: float | None = None
    occlusion: OcclusionMap | None = None

    def __post_init__(self) -> None:
        if self.model not in MODELS:
            known = choose_from(self.model, MODELS)
            raise SceneError(message("Material", "model", "a reflectance model", self.model, known))
        self.row()
        for parameter in self.parameters:
            check_range(self.model, parameter, self.values[parameter.name])
        if self.alpha_cutoff is not None and not (self.has_opacity and self.alpha_cutoff >= 0):
            expected, got = "at least 0, and a value of alpha", self.alpha_cutoff
            raise SceneError(message("Material", "alpha_cutoff", expected, got))
        sizes = {parameter.name: parameter.size for parameter in self.parameters}
        object.__setattr__(self, "textures", checked_uses(self.model, sizes, self.textures))

    @property
    def needs_uv(self) -> bool:
        """Whether surfaces of this material need texture coordinates."""
        return bool(self.textures) or self.normal_map is not None

    @property
    def has_opacity(self) -> bool:
        """Whether surfaces of this material cover only a part of what lies behind them."""
        return ALPHA.name in self.values

    @property
    def parameters(self) -> ModelParameters:
        """Descriptions of the parameters, in the order in which the core packs them."""
        return ModelParameters(
            (*MODELS[self.model].parameters, *([ALPHA] if self.has_opacity else []))
        )

    def row(self) -> Array:
        """All parameters as one row of numbers (P,), float64."""
        call = Arguments("Material", np.float64)
        return self.parameters.pack_one(call, self.model, self.values)
