"""A folder of somebody's photographs, looked at and copied so that every program sees them alike.

Cameras note how they were held in a tag, which some programs obey and some do not. Here the pixels
themselves are turned, once; all later stages, and our readers, take pixels as stored.
"""

from __future__ import annotations

import shutil
import zlib
from dataclasses import dataclass
from pathlib import Path

from photograd_course.input_files import read_file
from PIL import Image, ImageOps

from photograd.errors import IoError, SceneError, message
from photograd.images.kind import (
    PILLOW_KINDS,
    allow_pixels,
    image_kind,
    require_pixels,
    too_many_pixels,
)

SUFFIXES = (".jpg", ".jpeg", ".png")
MIN_IMAGES = 3
PARTIAL = ".partial_"  # begins the name of a copy that is being made
_NAME = "capture"
_ORIENTATION, _EXIF = 0x0112, 0x8769
_MAKE, _MODEL, _FOCAL, _FOCAL_35 = 0x010F, 0x0110, 0x920A, 0xA405
_JPEG_QUALITY = 95


@dataclass(frozen=True)
class Photograph:
    """One photograph.

    Attributes:
        source: the file as it came.
        name: of the copy; without spaces, which lists of pairs could not hold.
        size: (width, height), upright.
        orientation: the tag's value; 1 is upright.
        optics: camera and focal length as the tags have them; photographs that agree in it and in
            size share one camera.
        checksum: of the file's bytes.
    """

    source: Path
    name: str
    size: tuple[int, int]
    orientation: int
    optics: tuple[str, ...]
    checksum: int

    @property
    def camera_key(self) -> tuple[tuple[int, int], tuple[str, ...]]:
        """What photographs of one camera share."""
        return self.size, self.optics


def find_photographs(folder: Path) -> tuple[list[Photograph], list[str]]:
    """The photographs of a folder in the order of their names, and sentences for the log.

    Raises:
        IoError: no folder, or a photograph that cannot be read.
        SceneError: fewer than three, or two whose names would be the same.
    """
    if not folder.is_dir():
        raise IoError(message(_NAME, f"--photos {folder}", "a folder", "none"))
    files = sorted(x for x in folder.iterdir() if x.is_file() and not x.name.startswith("."))
    chosen = [file for file in files if file.suffix.lower() in SUFFIXES]
    others = [file.name for file in files if file.suffix.lower() not in SUFFIXES]
    if len(chosen) < MIN_IMAGES:
        got = f"{len(chosen)}" + (f", and {_some(others)}" if others else "")
        expected = f"at least {MIN_IMAGES} photographs ({', '.join(SUFFIXES)})"
        remedy = "twenty to a hundred from around the scene; convert others, such as .heic, first"
        raise SceneError(message(_NAME, f"--photos {folder}", expected, got, remedy))
    found = [_look_at(file) for file in chosen]
    names = [photograph.name.lower() for photograph in found]
    for index, name in enumerate(names):
        if name in names[:index]:
            first, second = found[names.index(name)].source.name, found[index].source.name
            got = f"{first!r} and {second!r}"
            raise SceneError(message(_NAME, f"--photos {folder}", "different names", got))
    return found, _remarks(found, others)


def copy_photographs(photographs: list[Photograph], folder: Path) -> None:
    """Copy to `folder`, turned upright where the tag says so; what is there already stays.

    Args:
        photographs: to be copied.
        folder: for the copies.

    Raises:
        IoError: a file cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for photograph in photographs:
            target = folder / photograph.name
            if target.exists():
                continue
            partial = target.with_name(f"{PARTIAL}{target.name}")
            if photograph.orientation == 1:
                shutil.copyfile(photograph.source, partial)
            else:
                _save_upright(photograph.source, partial)
            partial.replace(target)
    except (OSError, ValueError) as failure:
        if isinstance(failure, IoError):
            raise
        raise IoError(message(_NAME, f"{folder}", "a folder to write to", failure)) from failure


def _look_at(file: Path) -> Photograph:
    image_kind(_NAME, file, PILLOW_KINDS)
    content = read_file(_NAME, file)
    allow_pixels()
    try:
        with Image.open(file, formats=PILLOW_KINDS) as opened:
            require_pixels(_NAME, f"{file}", *opened.size)
            tags = opened.getexif()
            inner = tags.get_ifd(_EXIF)
            orientation = int(tags.get(_ORIENTATION, 1) or 1)
            width, height = opened.size
            opened.load()
    except IoError:
        raise
    except Image.DecompressionBombError as failure:
        raise too_many_pixels(_NAME, f"{file}", failure) from failure
    except Exception as failure:  # damaged pictures raise a dozen kinds
        text = " ".join(str(failure).split())[:120] or type(failure).__name__
        raise IoError(message(_NAME, f"{file}", "a readable photograph", text)) from failure
    if orientation not in range(1, 9):
        orientation = 1
    values = [tags.get(_MAKE), tags.get(_MODEL), inner.get(_FOCAL), inner.get(_FOCAL_35)]
    return Photograph(
        source=file,
        name="_".join(file.name.split()),
        size=(height, width) if orientation >= 5 else (width, height),
        orientation=orientation,
        optics=tuple("" if value is None else str(value).strip("\0 ") for value in values),
        checksum=zlib.crc32(content),
    )


def _save_upright(source: Path, target: Path) -> None:
    """Pixels turned, tags kept but for the orientation, so that the focal length is still known."""
    with Image.open(source, formats=PILLOW_KINDS) as opened:
        tags = opened.getexif()
        tags.get_ifd(_EXIF)  # read now, or it would be lost
        turned = ImageOps.exif_transpose(opened)
        tags[_ORIENTATION] = 1
        kind = "PNG" if opened.format == "PNG" else "JPEG"  # of several pictures in one, the first
        options = {"quality": _JPEG_QUALITY, "subsampling": 0} if kind == "JPEG" else {}
        turned.save(target, format=kind, exif=tags.tobytes(), **options)


def _remarks(photographs: list[Photograph], others: list[str]) -> list[str]:
    lines = []
    if others:
        lines.append(f"{len(others)} files left aside: {_some(others)}")
    turned = sum(photograph.orientation != 1 for photograph in photographs)
    if turned:
        lines.append(f"{turned} photographs turned upright, as their orientation tag says")
    sizes = {photograph.size for photograph in photographs}
    cameras = {photograph.camera_key for photograph in photographs}
    if len(sizes) > 1:
        listed = ", ".join(f"{width} x {height}" for width, height in sorted(sizes))
        lines.append(f"photographs of {len(sizes)} sizes ({listed}): a camera for each")
    if len(cameras) > len(sizes):
        lines.append(f"{len(cameras)} cameras, as the tags differ in maker, model or focal length")
    if not any(photograph.optics[2] or photograph.optics[3] for photograph in photographs):
        lines.append("no focal length in the tags: it is estimated from 1.2 times the longer side")
    return lines


def _some(names: list[str]) -> str:
    return ", ".join(names[:4]) + (", ..." if len(names) > 4 else "")
