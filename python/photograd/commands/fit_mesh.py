"""What `photograd fit` has for meshes alone: options, and the mesh files that a fit starts from."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from photograd.errors import RangeError, SceneError
from photograd.fields import MeshSurface, TexturedSurface
from photograd.fitting.options import users_of
from photograd.representation import Fittable
from photograd.transport.mesh_files import (
    read_mesh_surface,
    read_textured_mesh,
    read_textured_surface,
)


def _users(option: str) -> str:
    return ", ".join(users_of(option))


LaplacianOption: TypeAlias = Annotated[
    float,
    typer.Option(
        "--laplacian",
        min=0.0,
        help=f"Weight that keeps the vertices of {_users('laplacian')} near their neighbors' mean.",
    ),
]
NormalConsistencyOption: TypeAlias = Annotated[
    float,
    typer.Option(
        "--normal-consistency",
        min=0.0,
        help=f"Weight that keeps normals of neighboring faces of {_users('laplacian')} alike.",
    ),
]
OpacityOption: TypeAlias = Annotated[
    bool, typer.Option("--opacity", help=f"Recover the opacity of a {_users('opacity')}, too.")
]
RemeshOption: TypeAlias = Annotated[
    bool,
    typer.Option(
        "--remesh",
        help=f"New triangles of equal size for a {_users('remesh')}, at 15 and 40 % of the steps; "
        "needs gpytoolbox.",
    ),
]


def read_mesh_for(representation: str, path: Path) -> Fittable:
    """What a fit starts from, of a mesh file.

    Args:
        representation: of the fit.
        path: of the file.

    Raises:
        IoError, RangeError, SceneError: what the readers of `photograd.transport.mesh_files` raise.
    """
    if representation == MeshSurface.name:
        return read_mesh_surface(path)
    return (
        _textured_or_plain(path)
        if representation == TexturedSurface.name
        else read_textured_mesh(path)
    )


def _textured_or_plain(path: Path) -> Fittable:
    """A mesh with its texture; without one, a mesh with texture coordinates; or without these."""
    try:
        return read_textured_surface(path)
    except (SceneError, RangeError):
        pass
    try:
        return read_textured_mesh(path)
    except (SceneError, RangeError):
        return read_mesh_surface(path)
