"""Which camera of a mesh file `photograd trace` looks through."""

from __future__ import annotations

from typing import Annotated

import typer

from photograd.errors import SceneError, message
from photograd.transport.mesh_files import STUDIO, SUFFIXES

CameraOption = Annotated[
    str | None,
    typer.Option(
        "--camera",
        help=f"Of a mesh file: its camera of this name, by default its first, or '{STUDIO}'.",
    ),
]


def check_has_cameras(scene: str, camera: str | None) -> None:
    """Only mesh files have cameras of several names.

    Raises:
        SceneError: a camera of another scene.
    """
    if camera is not None and not scene.lower().endswith(SUFFIXES):
        expected = f"a mesh file ({', '.join(SUFFIXES)}) with --camera"
        raise SceneError(message("trace", "SCENE", expected, scene, "leave the option out"))
