"""Which command draws which kind of file, so that a wrong choice is answered with the right one."""

from __future__ import annotations

from pathlib import Path

from photograd_course.input_files import read_file

from photograd._checkpoint import FILE_NAME
from photograd.errors import IoError, message
from photograd.grids.volumes import SUFFIXES as DENSITIES
from photograd.splats.files import SUFFIXES as GAUSSIANS
from photograd.transport.builtin import BUILTIN
from photograd.transport.mesh_files import SUFFIXES as MESHES

VOLUMES = (".vdb", *DENSITIES)
TRACED = (".toml", *MESHES)
_SPLATS = tuple(suffix for suffix in GAUSSIANS if suffix != ".npz")  # models are .npz, too
_ZIP = b"PK"


def is_volume(path: Path) -> bool:
    """Whether the name is one of a volume or scan."""
    return path.name.lower().endswith(VOLUMES)


def check_rendered(model: Path) -> None:
    """Refuse what `photograd render` cannot draw: no folder, no archive, no other file it knows.

    Raises:
        IoError: says which command draws it, or which kinds of file there are.
    """
    suffix, builtin = model.suffix.lower(), f"{model}" in BUILTIN
    if is_volume(model) or suffix in _SPLATS or not (model.is_file() or builtin):
        return  # its reader says what is wrong, if something is
    if suffix == ".npz" and read_file("render", model, len(_ZIP)) == _ZIP:
        return
    kinds = f"volumes ({', '.join(VOLUMES)}) and Gaussians ({', '.join(GAUSSIANS)})"
    remedy = f"'photograd trace {model}' draws it" if builtin or suffix in TRACED else None
    expected = f"a model, the folder that 'photograd fit' wrote; or {kinds}"
    raise IoError(message("render", "MODEL", expected, f"{model}", remedy))


def check_traced(scene: str) -> None:
    """Refuse as a scene what `photograd render` draws; .ply files are told apart by their reader.

    Raises:
        IoError: a model, a volume or a file of Gaussians.
    """
    path = Path(scene)
    if scene in BUILTIN or scene.lower().endswith(TRACED) or not path.exists():
        return
    kinds = {"Gaussians": (".splat", ".spz"), "a volume": VOLUMES, "a model": (".npz",)}
    found = [kind for kind, ends in kinds.items() if scene.lower().endswith(ends)]
    if not found and (path / FILE_NAME).exists():
        found = ["a model"]
    if found:
        expected = f"a scene or mesh file ({', '.join(TRACED)}) or the name of a built-in scene"
        remedy = f"'photograd render {scene}' draws it"
        raise IoError(message("trace", "SCENE", expected, f"{scene}, {found[0]}", remedy))
