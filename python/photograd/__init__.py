"""Recover scenes from photographs by gradient descent: forward and adjoint renderers, proved.

Importing the package needs the compiled core; `photograd.capture` and `photograd.errors` do not use
it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from photograd import fields as fields
    from photograd.fields import representations
    from photograd.representation import Gradients, Outputs, ParamSpec, RayBatch, Representation

__version__ = "0.1.0"

_WHERE = {
    "Gradients": "photograd.representation",
    "Outputs": "photograd.representation",
    "ParamSpec": "photograd.representation",
    "RayBatch": "photograd.representation",
    "Representation": "photograd.representation",
    "representations": "photograd.representation",
}

__all__ = [
    "Gradients", "Outputs", "ParamSpec", "RayBatch", "Representation", "fields", "representations",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    if name == "fields":
        return import_module("photograd.fields")
    if name in _WHERE:
        return getattr(import_module(_WHERE[name]), name)
    raise AttributeError(f"module 'photograd' has no attribute {name!r}")
