"""Scene files with numbers beyond what can be traced, and paths that scatter beyond it.

The tracer ends the process over such numbers, so that these cases run in one of their own.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from support.child import answers

BEGIN = """
import numpy as np
from photograd.transport import Medium, PathTracer, read_scene
from tests.transport.media_scenes import haze

def trace(path):
    tracer = PathTracer(read_scene(path))
    image = tracer.render(spp=4, seed=1).mean
    gradients = tracer.render_backward(image, spp=4, seed=1).values()
    return all(np.isfinite(array).all() for array in (image, *gradients)) and image.any()
"""
SCENE = """[camera]
position = [0, 1, 5]
look_at = [0, 0.5, 0]
field_of_view = 40
size = [8, 8]
{camera}
[environment]
radiance = 0.5
[materials.a]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
material = "a"
{shape}
"""
BALL = 'kind = "sphere"\ncenter = [0, {height}, 0]\nradius = {radius}'
CARD = 'kind = "triangles"\nvertices = [[-1, 0, -1], [1, 0, -1], [0, 0, 1]]\nfaces = [[0, 2, 1]]'
SMALL = BALL.format(height=0.5, radius=0.5)
REFUSED = {
    "sphere": ("", BALL.format(height=-1e18, radius=1e18), "shapes.0.center: expected"),
    "aperture": ("aperture = 1e20\nfocus = 1e20", CARD, "camera.aperture: expected"),
    "emission": ("", CARD + "\nemission = 1e16", "shapes.0.emission: expected"),
    "sum": ("", BALL.format(height=-9e14, radius=9e14), "got 1.8e+15 m in sphere 0"),
}
TRACED = {
    "large sphere": ("", BALL.format(height=-4e14, radius=4e14)),
    "wide lens": ("aperture = 9e14\nfocus = 9e14", SMALL),
    "wide lens, short focus": ("aperture = 9e14\nfocus = 1e-14", CARD),
}
# Light scatters after some 1e25 m, further than any ray is traced: what lies there meets nothing.
THIN = """
tracer = PathTracer(haze(Medium([1e-25] * 3, [0.9] * 3), size=8))
image = tracer.render(spp=16, seed=1).mean
gradients = tracer.render_backward(image, spp=16, seed=1).values()
answer = all(np.isfinite(array).all() for array in (image, *gradients)) and image.any()
"""


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """All that one process says to these scenes."""
    folder, cases = tmp_path_factory.mktemp("scenes"), {"thin": THIN}
    scenes = TRACED | {name: case[:2] for name, case in REFUSED.items()}
    for name, (camera, shape) in scenes.items():
        path: Path = folder / f"{name}.toml"
        path.write_text(SCENE.format(camera=camera, shape=shape), encoding="utf-8")
        cases[name] = f"from pathlib import Path\nanswer = trace(Path({str(path)!r}))"
    return answers(BEGIN, cases)


@pytest.mark.parametrize("name", REFUSED)
def test_numbers_out_of_range_are_refused(said: dict[str, str], name: str) -> None:
    assert said[name].startswith("SceneError: ")
    assert REFUSED[name][2] in said[name]
    limit = "all of the scene within 1e+15 m" if name == "sum" else "(numbers below 1e+15)"
    assert limit in said[name]


@pytest.mark.parametrize("name", [*TRACED, "thin"])
def test_numbers_within_range_are_traced(said: dict[str, str], name: str) -> None:
    assert said[name] == "True"
