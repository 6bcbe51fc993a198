"""The course's own wheel, made from what is installed here: for a Gradescope zip.

A wheel is a zip with three files about itself. Kits in it are stripped, as in every wheel.
"""

from __future__ import annotations

import base64
import hashlib
from importlib import metadata
from pathlib import Path

from ..errors import IoError, message
from .archive import zip_bytes
from .kits import PACKAGE, PLAN, source_folders
from .public import wheel_kits

DISTRIBUTION = "photograd-course"


def course_wheel() -> tuple[str, bytes]:
    """File name and content.

    Raises:
        IoError: the distribution is not installed, not even as an editable checkout.
    """
    try:
        about = metadata.distribution(DISTRIBUTION)
    except metadata.PackageNotFoundError as error:
        remedy = "pip install it"
        raise IoError(message("course_wheel", DISTRIBUTION, "it", "nothing", remedy)) from error
    stem = f"photograd_course-{about.version}"
    files = package_files()
    files[f"{stem}.dist-info/METADATA"] = (about.read_text("METADATA") or "").encode()
    entry_points = about.read_text("entry_points.txt") or ""
    files[f"{stem}.dist-info/entry_points.txt"] = entry_points.encode()
    head = "Wheel-Version: 1.0\nGenerator: photograd-course\nRoot-Is-Purelib: true\n"
    files[f"{stem}.dist-info/WHEEL"] = f"{head}Tag: py3-none-any\n".encode()
    lines = [f"{path},sha256={_digest(data)},{len(data)}\n" for path, data in sorted(files.items())]
    record = f"{stem}.dist-info/RECORD"
    files[record] = ("".join(lines) + f"{record},,\n").encode()
    return f"{stem}-py3-none-any.whl", zip_bytes(files)


def package_files() -> dict[str, bytes]:
    """The package and its kits, by path in the wheel."""
    sources = source_folders()
    files = {
        f"photograd_course/{path.relative_to(PACKAGE).as_posix()}": path.read_bytes()
        for path in sorted(PACKAGE.rglob("*"))
        if _belongs(path, has_sources=bool(sources))
    }
    for folder in list(sources.values())[:1]:
        if (plan := folder.parent / PLAN).exists():
            files[f"photograd_course/kits/{PLAN}"] = plan.read_bytes()
    for name, folder in sources.items():
        for inside, data in wheel_kits(folder).items():
            files[f"photograd_course/kits/{name}/{inside}"] = data
    return files


def _belongs(path: Path, *, has_sources: bool) -> bool:
    inside = path.relative_to(PACKAGE).parts
    made = "__pycache__" in inside or (has_sources and inside[0] == "kits")
    return path.is_file() and not made


def _digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
