"""Recover scenes from photographs by gradient descent: forward and adjoint renderers, proved.

    capture = photograd.load_capture("photos")
    model = photograd.fit(capture, "dense_grid", resolution=64, bar=True)
    picture = photograd.render(model, capture.test[0].camera)  # (H, W, 3), to be shown

    room = photograd.builtin_scene("cornell-box")  # or read_scene("room.toml"), read_model("a.glb")
    found = photograd.recover(room, [photograph], ["materials.red.albedo"])

Gradients: of a fit with respect to the extinction in space, `photograd.fitting.density_gradient`,
and to any group of parameters, `Fit.mean_gradient`; of a path traced picture with respect to all
that is a number, `PathTracer.render_backward`. `photograd_course.viz` draws them.
docs/five_tasks.md does each of these in a few lines.

What most need is here; packages have the rest, and are imported when they are first asked for.
All but `photograd.errors`, `photograd.types`, `photograd.images` and `photograd.capture` need the
compiled core.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from photograd import (
        bsdf,
        capture,
        caustics,
        errors,
        fields,
        fitting,
        frame,
        geometry,
        grids,
        images,
        jax,
        lights,
        network,
        raster,
        representation,
        scenes,
        sh,
        splats,
        textures,
        torch,
        transport,
        types,
        vector,
    )
    from photograd._render import render
    from photograd.capture import Camera, Capture, View, estimate_bounds, load_capture
    from photograd.errors import Error
    from photograd.fields import DenseGrid, GaussianScene, OctreeSh, SparseSh, representations
    from photograd.fitting import Fit, FitOptions, Model, fit, load_model
    from photograd.fitting.evaluate import evaluate
    from photograd.geometry.mesh import Bvh, Mesh
    from photograd.images import read_image
    from photograd.representation import Representation, check_gradients
    from photograd.splats import Gaussians
    from photograd.transport import (
        Material,
        Parameter,
        PathOptions,
        PathTracer,
        RecoveryOptions,
        Scene,
        Target,
        builtin_scene,
        read_model,
        read_scene,
        recover,
    )

__version__ = "0.2.0"

_HOME = {
    "photograd._render": "render",
    "photograd.capture": "Camera Capture View estimate_bounds load_capture",
    "photograd.errors": "Error",
    "photograd.fields": "DenseGrid GaussianScene OctreeSh SparseSh representations",
    "photograd.fitting.evaluate": "evaluate",
    "photograd.fitting": "Fit FitOptions Model fit load_model",
    "photograd.geometry.mesh": "Bvh Mesh",
    "photograd.images": "read_image",
    "photograd.representation": "Representation check_gradients",
    "photograd.splats": "Gaussians",
    "photograd.transport": "Material PathOptions PathTracer Scene builtin_scene read_scene",
    "photograd.transport.inverse": "RecoveryOptions Target Parameter recover",
    "photograd.transport.mesh_files": "read_model",
}
"""Names at the door, by the module in which each is defined."""

__all__ = [
    "Bvh",
    "Camera",
    "Capture",
    "DenseGrid",
    "Error",
    "Fit",
    "FitOptions",
    "GaussianScene",
    "Gaussians",
    "Material",
    "Mesh",
    "Model",
    "OctreeSh",
    "Parameter",
    "PathOptions",
    "PathTracer",
    "RecoveryOptions",
    "Representation",
    "Scene",
    "SparseSh",
    "Target",
    "View",
    "bsdf",
    "builtin_scene",
    "capture",
    "caustics",
    "check_gradients",
    "errors",
    "estimate_bounds",
    "evaluate",
    "fields",
    "fit",
    "fitting",
    "frame",
    "geometry",
    "grids",
    "images",
    "jax",
    "lights",
    "load_capture",
    "load_model",
    "network",
    "raster",
    "read_image",
    "read_model",
    "read_scene",
    "recover",
    "render",
    "representation",
    "representations",
    "scenes",
    "sh",
    "splats",
    "textures",
    "torch",
    "transport",
    "types",
    "vector",
]

_MODULE_OF = {name: module for module, names in _HOME.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name in _MODULE_OF:
        globals()[name] = getattr(import_module(_MODULE_OF[name]), name)
    elif name in __all__:
        import_module(f"photograd.{name}")  # which becomes an attribute
    else:
        raise AttributeError(f"module 'photograd' has no attribute {name!r}")
    return globals()[name]


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
