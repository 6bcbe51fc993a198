"""Writing captures in the Blender convention, so that a reader sees all of it or nothing.

OUT/capture.json lists them under "files", relative to OUT. Files that are not listed there are not
ours: they stay, whatever is overwritten.
"""

from __future__ import annotations

import contextlib
import json
import math
import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

import numpy as np

from photograd._arrays import Arguments
from photograd._files import leads_outside
from photograd._typed import typed_call
from photograd.capture.assemble import box_from_source
from photograd.capture.camera import Camera
from photograd.capture.frames import OPENGL_FROM_OPENCV, Y_UP_FROM_Z_UP, invert_rigid
from photograd.errors import IoError, RangeError, SceneError, message
from photograd.images.read import ImageArray
from photograd.images.write import write_exr, write_png
from photograd.types import FloatArray

MANIFEST = "capture.json"
HIDDEN = (".photograd.lock", ".capture.partial", ".capture.replaced")
"""Ours without being listed: the lock of a run, and what a killed one was about to move."""


def written_files(folder: Path) -> set[str]:
    """Names, relative to `folder`, of the files and folders that its manifest lists, and its own.

    Empty without a manifest that can be read. Names that lead out of the folder do not count.
    """
    try:
        listed = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
        names = {str(name) for name in listed if name and not leads_outside(str(name))}
        home = folder.resolve()
        within = {
            parent: (folder / parent).resolve().is_relative_to(home)
            for parent in {Path(name).parent for name in names}
        }
    except (OSError, ValueError, KeyError, TypeError):
        return set()
    return {name for name in names if within[Path(name).parent]} | {MANIFEST}


def require_free(
    function: str, argument: str, folder: Path, new: Iterable[str], *, overwrite: bool
) -> None:
    """Refuse a folder that `new` must not be written to; nothing is changed.

    Args:
        function, argument: on whose behalf the error speaks.
        folder: where to write; it need not exist.
        new: names of files and folders to come, relative to `folder`.
        overwrite: what photograd wrote there may be replaced; else the folder has to be empty.

    Raises:
        IoError: it has content; with `overwrite`, a file in the way that is not ours.
    """
    if not overwrite:
        if folder.exists() and (not folder.is_dir() or set(_names(folder)) - set(HIDDEN)):
            remedy = "choose another, or overwrite it"
            raise IoError(message(function, argument, "a new folder", "one with content", remedy))
        return
    ours = written_files(folder)
    for name in new:
        if name not in ours and (folder / name).exists():
            expected = f"no {name} there that photograd did not write"
            remedy = "move it away, or choose another folder"
            raise IoError(message(function, argument, expected, f"{folder / name}", remedy))


def remove_written(folder: Path) -> None:
    """Remove what the manifest of `folder` lists, the manifest last, and folders left empty."""
    names = written_files(folder)
    for name in sorted(names, key=lambda name: name == MANIFEST):
        path = folder / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    remove_empty_folders(folder, names)


def remove_empty_folders(folder: Path, names: Iterable[str]) -> None:
    """Remove the folders of `names` below `folder` that hold nothing."""
    parents = {parent for name in names for parent in Path(name).parents} - {Path()}
    for parent in sorted(parents, key=lambda parent: -len(parent.parts)):
        path = folder / parent
        if path.is_dir() and not path.is_symlink() and not any(path.iterdir()):
            path.rmdir()


def left_alone(folder: Path) -> list[str]:
    """What `folder`, and its folders that we write to, hold besides our files."""
    ours = written_files(folder)
    folders = {parent for name in ours for parent in Path(name).parents}
    known = ours | {str(parent) for parent in folders} | set(HIDDEN)
    held = [str(parent / name) for parent in folders for name in _names(folder / parent)]
    return sorted(name for name in held if name not in known)


def _names(folder: Path) -> list[str]:
    return [entry.name for entry in folder.iterdir()] if folder.is_dir() else []


# Writing captures in the Blender convention, so that a reader sees all of it or nothing.


_NAME = "write_blender_capture"
_SPLITS = ("train", "test", "val")
_ALL_TRANSFORMS = tuple(f"transforms_{split}.json" for split in _SPLITS)
_LAST = _ALL_TRANSFORMS[0]

Frame: TypeAlias = tuple[str, Camera, ImageArray, ImageArray | None]
"""Name, camera, display-encoded (H, W, 4) image with straight alpha in 0..1, and linear radiance
(H, W, 4) premultiplied by alpha, or None."""


@typed_call
def write_blender_capture(
    path: Path,
    splits: Mapping[str, Sequence[Frame]],
    *,
    aabb: FloatArray | None = None,
    overwrite: bool = False,
) -> list[str]:
    """Write transforms_{split}.json with OpenGL cameras and +Z up, PNG images and EXR radiance.

    Everything is written to a hidden folder in `path` and moved to its places at the end, what
    makes it a capture last. capture.json lists the files.

    Args:
        path: folder to create.
        splits: frames of "train", and of "test" and "val" if any.
        aabb: (2, 3) box of the scene in our frame (+Y up); stored in the file's frame.
        overwrite: replace the capture that photograd wrote there, and leave other files as they
            are (else the folder must not exist, or be empty).

    Returns:
        Names of the other files and folders there.

    Raises:
        IoError: the folder has content, a file that is not ours is in the way, or it cannot be
            written.
        RangeError, SceneError, ShapeError: cameras or images that the format cannot express: it has
            one size, one focal length fx = fy and the principal point in the middle.
    """
    path = Path(path)
    _check_splits(splits)
    extra: dict[str, object] = {}
    if aabb is not None:
        box = Arguments(_NAME, np.float64).box("aabb", aabb)
        extra["aabb"] = box_from_source(invert_rigid(Y_UP_FROM_Z_UP), box).tolist()
    new = [*_file_names(splits), MANIFEST]
    partial, aside = (path / name for name in (".capture.partial", ".capture.replaced"))
    made = False
    try:
        require_free(_NAME, str(path), path, [*new, *_ALL_TRANSFORMS], overwrite=overwrite)
        made = not path.exists()
        shutil.rmtree(partial, ignore_errors=True)
        shutil.rmtree(aside, ignore_errors=True)
        partial.mkdir(parents=True)
        (partial / MANIFEST).write_text(json.dumps({"files": new}, indent=1), encoding="utf-8")
        for split, frames in splits.items():
            _write_split(partial, split, frames, extra)
        old = [name for name in written_files(path) if (path / name).exists()]
        # A reader looks for transforms_train.json: it goes first, and comes last.
        order = [*(name for name in new if name != _LAST), _LAST]
        _move_all(
            [(path / name, aside / name) for name in sorted(old, key=lambda name: name != _LAST)]
            + [(partial / name, path / name) for name in order]
        )
        remove_empty_folders(path, old)
        return left_alone(path)
    except IoError:
        raise
    except OSError as error:
        got = error.strerror or str(error)
        raise IoError(message(_NAME, str(path), "a writable folder", got)) from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)
        shutil.rmtree(aside, ignore_errors=True)
        with contextlib.suppress(OSError):  # not empty, unless it could not be written
            remove_empty_folders(path, new)
            if made:
                path.rmdir()


def require_free_folder(function: str, path: Path, *, overwrite: bool) -> None:
    """Refuse, before the work, a folder that a capture cannot be written to.

    Args:
        function: on whose behalf the error speaks.
        path: of the folder.
        overwrite: whether an earlier capture of ours may be replaced.

    Raises:
        IoError: it has content; with `overwrite` transforms of another hand.
    """
    new = [*_ALL_TRANSFORMS, MANIFEST]
    require_free(function, f"--out {path}", path, new, overwrite=overwrite)


def _move_all(moves: Sequence[tuple[Path, Path]]) -> None:
    """Rename all, or none."""
    done = []
    try:
        for source, target in moves:
            target.parent.mkdir(parents=True, exist_ok=True)
            source.replace(target)
            done.append((source, target))
    except OSError:
        for source, target in reversed(done):
            target.replace(source)
        raise


def _file_names(splits: Mapping[str, Sequence[Frame]]) -> list[str]:
    """All files to write, relative to the folder."""
    names = [f"transforms_{split}.json" for split in splits]
    for split, frames in splits.items():
        for name, _, _, radiance in frames:
            names.append(f"{split}/{name}.png")
            if radiance is not None:
                names.append(f"{split}/{name}.exr")
    return names


def _write_split(
    folder: Path, split: str, frames: Sequence[Frame], extra: Mapping[str, object]
) -> None:
    (folder / split).mkdir()
    camera = frames[0][1]
    listed = []
    for name, frame_camera, image, radiance in frames:
        write_png(folder / split / f"{name}.png", image)
        if radiance is not None:
            write_exr(folder / split / f"{name}.exr", radiance)
        turned = invert_rigid(Y_UP_FROM_Z_UP) @ frame_camera.world_from_camera
        matrix = turned @ OPENGL_FROM_OPENCV
        listed.append({"file_path": f"./{split}/{name}", "transform_matrix": matrix.tolist()})
    angle = 2.0 * math.atan(0.5 * camera.width / camera.fx)
    content = {"camera_angle_x": angle, **extra, "frames": listed}
    text = json.dumps(content, indent=1)
    (folder / f"transforms_{split}.json").write_text(text, encoding="utf-8")


def _check_splits(splits: Mapping[str, Sequence[Frame]]) -> None:
    unknown = sorted(set(splits) - set(_SPLITS))
    if unknown or not splits.get("train"):
        got = f"unknown {unknown}" if unknown else "no training frames"
        raise SceneError(message(_NAME, "splits", "'train', and 'test' and 'val' if any", got))
    first = splits["train"][0][1]
    for split, frames in splits.items():
        names = [frame[0] for frame in frames]
        if not frames or len(set(names)) != len(names):
            got = "none" if not frames else "a name twice"
            raise SceneError(message(_NAME, f"split '{split}'", "frames of different names", got))
        for name, camera, image, radiance in frames:
            _check_frame(f"{split} '{name}'", name, camera, first, (image, radiance))


def _check_frame(
    where: str,
    name: str,
    camera: Camera,
    first: Camera,
    images: tuple[ImageArray, ImageArray | None],
) -> None:
    if not name or name != Path(name).name or name.startswith("."):
        raise SceneError(message(_NAME, where, "a plain file name", repr(name)))
    same = (camera.width, camera.height, camera.fx) == (first.width, first.height, first.fx)
    centerd = np.allclose(
        [camera.cx, camera.cy, camera.fy],
        [0.5 * camera.width, 0.5 * camera.height, camera.fx],
        rtol=1e-12,
        atol=0.0,
    )
    if not (same and centerd):
        expected = "one size, one focal length fx = fy, principal point in the middle"
        listed = (camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy)
        raise RangeError(message(_NAME, f"{where}: camera", expected, listed))
    shape = (camera.height, camera.width, 4)
    for image in images:
        if image is not None:
            Arguments(_NAME).array(f"{where}: image", image, shape, finite=False)
