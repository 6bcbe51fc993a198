"""One door for captures of every format: look at the folder and choose the reader."""

from __future__ import annotations

from pathlib import Path

from photograd._checks import require_path
from photograd._typed import typed_call
from photograd.capture.assemble import is_file
from photograd.capture.blender import load_blender
from photograd.capture.capture import Capture
from photograd.capture.colmap import find_model, load_colmap
from photograd.capture.llff import load_llff
from photograd.capture.nerfstudio import load_nerfstudio
from photograd.capture.opensfm import load_opensfm
from photograd.errors import IoError, message
from photograd.images.read import ColorSpace

_NAME = "load_capture"


@typed_call
def load_capture(
    path: str | Path,
    *,
    downscale: int | None = None,
    limit: int | None = None,
    color_space: ColorSpace = "display",
    trust_poses: bool = False,
    allow_outside: bool = False,
) -> Capture:
    """Read posed photographs in any supported format into our frame (+Y up, OpenCV cameras).

    A folder is searched for transforms_train.json (Blender), transforms.json (nerfstudio,
    instant-ngp), a COLMAP model, poses_bounds.npy (LLFF) and reconstruction*.json (OpenSfM), in
    this order. Naming one of these files itself chooses its reader.

    Args:
        path: folder or file.
        downscale: integer factor of a box average applied to all images.
        limit: largest number of views in each split, taken evenly.
        color_space: "linear" prefers .exr over .png where a Blender capture has both.
        trust_poses: do not ask whether the poses look like another convention.
        allow_outside: read also files outside of the capture's folder that it names, by an absolute
            path or through ".."; only for captures that you trust. Symbolic links are followed.

    Returns:
        The capture; `Capture.conversions` lists every conversion and assumption.

    Raises:
        DtypeError: neither a text nor a `Path`.
        IoError: nothing that we know there, or files missing, damaged or outside of the folder.
        RangeError, ShapeError, SceneError: files that contradict themselves.

    Example:
        >>> capture = photograd.load_capture("photos")
        >>> view = capture.train[0]
        >>> view.rgba().shape  # display values, straight alpha
        (16, 16, 4)
    """
    path = require_path(_NAME, "path", path)
    found = find_formats(path)
    if not found:
        expected = (
            "transforms_train.json, transforms.json, a COLMAP model, poses_bounds.npy "
            "or reconstruction.json"
        )
        got = "no such folder" if not _exists(path) else "none of them"
        raise IoError(message(_NAME, repr(str(path)), expected, got))
    kind, source = found[0]
    if kind == "blender":
        capture = load_blender(
            source, color_space=color_space, trust_poses=trust_poses, allow_outside=allow_outside
        )
    elif kind == "llff":  # names no files
        capture = load_llff(source, trust_poses=trust_poses)
    else:
        readers = {"nerfstudio": load_nerfstudio, "colmap": load_colmap, "opensfm": load_opensfm}
        capture = readers[kind](source, trust_poses=trust_poses, allow_outside=allow_outside)
    if len(found) > 1:
        others = ", ".join(other for other, _ in found[1:])
        line = f"read as {kind}; also there: {others} (name the file itself to choose it)"
        capture = capture.with_line(line)
    if limit is not None:
        capture = capture.subsample(limit)
    return capture if downscale is None else capture.downscaled(downscale)


def find_formats(path: Path) -> list[tuple[str, Path]]:
    """Formats found at `path`, best first, each with what its reader wants: a folder or a file."""
    if is_file(path):
        return _format_of_file(path)
    if not _exists(path):
        return []
    found: list[tuple[str, Path]] = []
    if (path / "transforms_train.json").exists():
        found.append(("blender", path))
    if (path / "transforms.json").exists():
        found.append(("nerfstudio", path / "transforms.json"))
    if find_model(path) is not None:
        found.append(("colmap", path))
    if (path / "poses_bounds.npy").exists():
        found.append(("llff", path))
    found.extend(("opensfm", file) for file in sorted(path.glob("reconstruction*.json")))
    return found


def _format_of_file(path: Path) -> list[tuple[str, Path]]:
    if path.name.startswith("transforms_") and path.suffix == ".json":
        return [("blender", path.parent)]
    if path.name == "poses_bounds.npy":
        return [("llff", path.parent)]
    if path.stem == "cameras" and path.suffix in (".txt", ".bin"):
        return [("colmap", path.parent)]
    if path.name.startswith("reconstruction") and path.suffix == ".json":
        return [("opensfm", path)]
    return [("nerfstudio", path)] if path.suffix == ".json" else []


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False
