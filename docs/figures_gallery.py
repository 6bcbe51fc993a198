"""The gallery of reflectance models: `python docs/figures_gallery.py` draws a row for each.

Writes docs/images/reflectance/NAME.jpg for every model of the registry, and docs/gallery.md.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from photograd.bsdf import BsdfModel, registry
from photograd.bsdf.gallery import gallery_picture
from PIL import Image

DOCS = Path(__file__).resolve().parent
FOLDER = DOCS / "images" / "reflectance"
WIDTH, QUALITY = 840, 80
HEAD = """# Gallery of reflectance models

All models of the registry (`cpp/photograd/bsdf/registry.h`), in its order;
`python docs/figures_gallery.py` draws them again.

Above, balls under one distant light, with parameters from a tenth to the whole of their ranges, and
below each what it reflects of light that arrives at 45 degrees (f cos). Then the part of the light
that leaves, by the cosine of the view, in the colors of the lobes: above 1 a model makes light,
and its *claim* says by how much at most. To the right, how the second ball changes with each
parameter: red where more of it brightens, blue where it darkens; the number is the end of the
scale.
"""


def draw(model: BsdfModel, path: Path) -> None:
    """A row as JPEG: a fifth of the bytes."""
    with TemporaryDirectory() as folder:
        whole = Path(folder) / "row.png"
        gallery_picture(model, whole)
        image = Image.open(whole).convert("RGB")
    height = round(image.height * WIDTH / image.width)
    small = image.resize((WIDTH, height), Image.Resampling.LANCZOS)
    small.save(path, quality=QUALITY, optimize=True)


def section(model: BsdfModel) -> str:
    """What the page says of a model."""
    kind, most = model.energy
    energy = f"not energy-conserving, at most {most:g} times" if kind == "gains" else kind
    parts = [energy, "reciprocal" if model.reciprocal else "not reciprocal"]
    parts += ["transmits"] * model.transmits
    ranges = ", ".join(f"`{p.name}` {p.lo:.3g} to {p.hi:.3g}" for p in model.parameters)
    image = f"![{model.name}](images/reflectance/{model.name}.jpg)"
    return f"\n## {model.name}\n\n{', '.join(parts)}. {ranges}.\n\n{image}\n"


def main() -> None:
    """Draw all, and write the page."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    models = registry()
    for model in models.values():
        draw(model, FOLDER / f"{model.name}.jpg")
    page = HEAD + "".join(section(model) for model in models.values())
    (DOCS / "gallery.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
