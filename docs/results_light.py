"""Recovers materials and light through the path tracer: `python docs/results_light.py DATA`.

Image-based light is compared with it. DATA is a folder with meshes/spot, textures, envmaps and
materials. Rewrites what stands between two markers of docs/results.md, and pictures in docs/images.
`--only NAME` measures one section anew and leaves the others.
"""

from __future__ import annotations

import argparse
import re
import time
from pathlib import Path
from types import ModuleType

import image_based_light
import numpy as np
import recover_environment
import recover_materials
import recover_measured
import recover_walls
from matplotlib.figure import Figure
from photograd_course.viz import save_figure
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "results.md"
IMAGES = ROOT / "docs" / "images"
LARGEST = 150_000  # bytes of a picture

SECTIONS: dict[str, tuple[str, ModuleType]] = {
    "walls": ("Wall colors from one picture", recover_walls),
    "materials": ("Textures, roughness and metalness", recover_materials),
    "environment": ("The light around a ball", recover_environment),
    "measured": ("Measured reflectance, by four models", recover_measured),
    "image": ("Image-based light, by three tables", image_based_light),
}
"""Name: (title, module with `measure(data) -> (lines, figure)` and the name of its `IMAGE`)."""


def marked(name: str) -> tuple[str, str]:
    """The markers around a section."""
    return f"<!-- light: {name} -->", f"<!-- end of light: {name} -->"


def rewritten(page: str, name: str, lines: list[str]) -> str:
    """The page with a section replaced; raises SystemExit if it has no markers for it."""
    begin, end = marked(name)
    if page.count(begin) != 1 or page.count(end) != 1:
        raise SystemExit(f"docs/results.md needs one line {begin} and one {end}")
    pattern = re.compile(re.escape(begin) + r".*?" + re.escape(end), re.DOTALL)
    return pattern.sub(lambda _: "\n".join([begin, *lines, end]), page)


def save_small(figure: Figure, path: Path) -> None:
    """Write a figure with 64 levels a channel, and if it is large still, with 256 colors.

    Raises:
        SystemExit: it is larger than `LARGEST`.
    """
    save_figure(figure, path)
    with Image.open(path) as image:
        pixels = np.asarray(image.convert("RGB"), np.float64)
    levels = np.rint(np.rint(pixels * (63 / 255)) * (255 / 63)).astype(np.uint8)
    small = Image.fromarray(levels)
    small.save(path, optimize=True)
    if path.stat().st_size > LARGEST:
        palette = small.quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        palette.save(path, optimize=True)
    if path.stat().st_size > LARGEST:
        raise SystemExit(f"{path.name} has {path.stat().st_size} bytes")


def main() -> None:
    """Measure, and rewrite what stands between the markers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--only", choices=SECTIONS, action="append")
    given = parser.parse_args()
    for name in given.only or SECTIONS:
        title, module = SECTIONS[name]
        image: str = module.IMAGE
        began = time.perf_counter()
        lines, figure = module.measure(given.data)
        whole = [f"### {title}", "", f"![{title}](images/{image})", "", *lines]
        page = rewritten(RESULTS.read_text(encoding="utf-8"), name, whole)
        RESULTS.write_text(page, encoding="utf-8")
        save_small(figure, IMAGES / image)
        print(f"{name}: {time.perf_counter() - began:.0f} s", *lines, sep="\n")  # noqa: T201


if __name__ == "__main__":
    main()
