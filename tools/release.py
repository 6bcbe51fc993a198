"""Lay kits and pages beside the wheels in dist/: what a course hands out.

Usage: release.py DIST [BOOK]

    DIST/*.whl                   the course's, for students; the core's, for machines like this one
    DIST/kits/NN_name.zip        the folder of an assignment
    DIST/site/                   BOOK, the built book, with the handouts as pages in handouts-read/
    DIST/START.md                the first commands
    DIST/SHA256SUMS              of every other file

Nothing of a solution, hidden check or answer is in any of them.
"""

from __future__ import annotations

import hashlib
import shutil
import sys
from html import escape
from pathlib import Path

from photograd_course.assignment.manifest import Manifest, read_manifest
from photograd_course.build.archive import zip_bytes
from photograd_course.build.kits import source_folders
from photograd_course.build.page.page import handout_page
from photograd_course.build.products import complete_kit

ROOT = Path(__file__).resolve().parent.parent
PAGES = "handouts-read"
START = """# Start here

You need Python 3.10 or newer: no compiler, no administrator, no network after the first line.

    pip install {wheel}
    photograd course start 00
    cd 00_setup
    photograd course read 00      # the handout, in your browser
    photograd course check 00     # red at first

The wheel holds every assignment; `kits/` holds the same folders as archives, for a course that
hands them out one by one. `site/{pages}/index.html` lists the handouts for reading.

No assignment needs the C++ core. Where it is installed, as `pip install photograd-*.whl` does from
the wheel for your Python and system if there is one here, the explorations use it: they compare
your results with it, and show more.
"""


def release(dist: Path, book: Path | None = None, assignments: Path | None = None) -> list[Path]:
    """Write everything but the wheels, and the list of checksums.

    Args:
        dist: a folder with the course's wheel.
        book: the built book, or None.
        assignments: their folder; by default that of the checkout.

    Returns:
        The files that were written.

    Raises:
        FileNotFoundError: the course's wheel is not there.
    """
    wheels = sorted(dist.glob("photograd_course-*.whl"))
    if not wheels:
        raise FileNotFoundError(f"release: {dist}: expected photograd_course-*.whl (./run wheel)")
    for name in ("kits", "site"):
        shutil.rmtree(dist / name, ignore_errors=True)
    if book is not None:
        shutil.copytree(
            book, dist / "site", ignore=shutil.ignore_patterns(".doctrees", ".buildinfo")
        )
    files = {"START.md": START.format(wheel=wheels[-1].name, pages=PAGES).encode()}
    manifests = []
    for name, folder in source_folders(assignments or ROOT / "assignments").items():
        kit = complete_kit(folder)
        files[f"kits/{name}.zip"] = zip_bytes({f"{name}/{path}": kit[path] for path in kit})
        if "handout.html" in kit:
            files[f"site/{PAGES}/{name}.html"] = kit["handout.html"]
            manifests.append(read_manifest(folder))
    files[f"site/{PAGES}/index.html"] = contents(manifests).encode()
    for path, data in files.items():
        (dist / path).parent.mkdir(parents=True, exist_ok=True)
        (dist / path).write_bytes(data)
    (dist / "SHA256SUMS").write_text(checksums(dist), encoding="utf-8")
    return [dist / path for path in files]


def contents(manifests: list[Manifest]) -> str:
    """The page that lists the handouts."""
    rows = "\n".join(
        f"| {m.id} | [{m.title}]({m.folder_name}.html) | {m.hours:g} |" for m in manifests
    )
    head = "# Handouts\n\n| | assignment | hours (estimated) |\n| --- | --- | --- |"
    page = handout_page(f"{head}\n{rows}\n")
    return page.replace("<title>Handouts", f"<title>{escape('Handouts of photograd')}")


def checksums(dist: Path) -> str:
    """A line for each file, as sha256sum reads it."""
    paths = sorted(path for path in dist.rglob("*") if path.is_file() and path.name != "SHA256SUMS")
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(dist).as_posix()}\n"
        for path in paths
    ]
    return "".join(lines)


if __name__ == "__main__":
    for written in release(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None):
        print(written)
