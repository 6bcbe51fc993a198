"""Large pictures without noise: `python docs/heroes.py NAME [--spp N]` draws one of SCENES.

Writes docs/images/hero_NAME.jpg (1280 x 720) after each pass, and what it took into
docs/images/heroes.toml, with the processor hours of all of them; `--size` tries a scene in another
size. Nothing is denoised: what noise is left is that of the samples.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import hero_scenes
import numpy as np
from numpy.typing import NDArray
from photograd.frame.tone_mapping import tone_map
from photograd.transport import Accumulation, PathOptions, PathTracer, PhotonMap, Scene
from photograd.transport.particles import ParticleOptions
from photograd_course.color import srgb_encode
from PIL import Image, ImageDraw, ImageFont

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
RECORD = IMAGES / "heroes.toml"
WIDTH, HEIGHT = 1280, 720
QUALITY = 92
PASS = 16  # samples a pixel between two times that the picture is written
PARTICLES = 1 << 22  # of each map of photons
NARROW = 0.004  # m, over which photons are counted


def shown(radiance: Array, exposure: float) -> Image.Image:
    """A picture of linear radiance, with highlights that roll off."""
    mapped = tone_map(np.maximum(radiance, 0.0), "reinhard", exposure=exposure)
    return Image.fromarray(np.round(255 * srgb_encode(mapped.clip(0, 1))).astype(np.uint8))


def label(picture: Image.Image, names: dict[str, tuple[float, float]]) -> None:
    """Write names below what they name; places are fractions of the picture."""
    draw = ImageDraw.Draw(picture)
    font = ImageFont.load_default(size=max(8, picture.height // 36))
    for name, (x, y) in names.items():
        place = x * picture.width, y * picture.height
        draw.text(place, name, fill=(30, 30, 34), font=font, anchor="mm")


def processor_seconds() -> float:
    """Of this process so far."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def caustics(scene: Scene, maps: int, spp: int) -> Array:
    """What lights without a surface add through or off glass, as particles find it, (H, W, 3).

    Paths from the camera find the sky behind glass themselves.
    """
    tracer = PathTracer(replace(scene, environment=None))
    options = ParticleOptions(max_depth=8)
    total = np.zeros((scene.camera.height, scene.camera.width, 3))
    for seed in range(maps):
        photons = PhotonMap(
            tracer, PARTICLES, radius=NARROW, seed=seed, options=options, direct=False
        )
        total += photons.render(spp=spp, seed=seed).mean
    return total / maps


def draw(name: str, size: tuple[int, int], spp: int, target: Path) -> Iterator[dict[str, Any]]:
    """Trace a scene in passes, and write its picture after each; yields what it took so far."""
    hero = hero_scenes.SCENES[name]
    before = processor_seconds()
    scene = hero.scene(*size)
    tracer = PathTracer(scene)
    options = PathOptions(max_depth=hero.max_depth)
    sums = Accumulation.empty(size[1], size[0])
    extra = caustics(scene, hero.photon_maps, 2) if hero.photon_maps else 0.0
    while sums.count < spp:
        tracer.add_samples(sums, min(PASS, spp - sums.count), seed=1, options=options)
        picture = shown(sums.mean + extra, hero.exposure)
        label(picture, hero.labels)
        picture.save(target, quality=QUALITY, optimize=True)
        yield {
            "width": size[0],
            "height": size[1],
            "spp": sums.count,
            "max_depth": hero.max_depth,
            "photons": hero.photon_maps * PARTICLES,
            "seed": 1,
            "processor_minutes": round((processor_seconds() - before) / 60, 2),
        }


def record(name: str, settings: dict[str, Any]) -> None:
    """Put the settings of one picture into the file of all."""
    known = tomllib.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}
    known[name] = settings
    hours = sum(each["processor_minutes"] for each in known.values()) / 60
    text = f"# Written by docs/heroes.py: how each picture was made; {hours:.2f} processor hours.\n"
    for each, values in sorted(known.items()):
        rows = "".join(f"{key} = {value}\n" for key, value in values.items())
        text += f"\n[{each}]\n{rows}"
    RECORD.write_text(text, encoding="utf-8")


def main() -> None:
    """Draw one picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", choices=sorted(hero_scenes.SCENES))
    parser.add_argument("--spp", type=int, help="samples a pixel; by default the scene's")
    parser.add_argument("--size", type=int, default=WIDTH, help="pixels across")
    parser.add_argument("--out", type=Path, help="by default docs/images/hero_NAME.jpg")
    asked = parser.parse_args()
    target = asked.out or IMAGES / f"hero_{asked.name}.jpg"
    size = asked.size, asked.size * HEIGHT // WIDTH
    spp = asked.spp or hero_scenes.SCENES[asked.name].spp
    for settings in draw(asked.name, size, spp, target):
        if asked.out is None:
            record(asked.name, settings)
        sys.stdout.write(f"{target} {settings}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
