"""Reflectance models and phase functions: the core's registries, with parameters by name.

`registry` has the models that are functions of two directions; `specular` mirrors and panes,
`phase` what particles do, `principled` one model at millions of pairs, `gallery` pictures of all.
"""

from __future__ import annotations

from photograd._registry import ModelParameter
from photograd.bsdf.models import METALS, BsdfModel, registry

__all__ = ["METALS", "BsdfModel", "ModelParameter", "registry"]
