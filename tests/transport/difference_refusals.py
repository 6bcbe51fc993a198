"""What has no derivative, or an incomplete one, and what is said when somebody asks for it."""

from __future__ import annotations

from collections.abc import Iterator

from photograd.errors import Error
from photograd.lights import RegisteredLight
from photograd.transport import PathTracer, derivative_image

from tests.transport.difference_rows import OTHERS, Case
from tests.transport.light_scenes import LIGHTS, lit_by

MORE = {"map": ("world_from_map",)}


def said(tracer: PathTracer, key: str) -> str:
    """The error of asking for the derivative with respect to `key`."""
    try:
        derivative_image(tracer, key, spp=1, seed=0)
    except Error as error:
        return str(error)
    raise AssertionError(key)


def refused(cases: list[Case]) -> Iterator[tuple[str, str, str]]:
    """(thing, what is refused, message for the first of it): of refused cases, of all lights."""
    for case in cases:
        tracer = PathTracer(case.scene())
        for row in case.rows:
            yield case.thing, row.parameter, said(tracer, row.key)
    for name, (light, *_) in LIGHTS.items():
        if name in ("all", "turned map"):
            continue
        known = isinstance(light, RegisteredLight)
        names = [p.name for p in light.constants()] if known else MORE[name]
        tracer = PathTracer(lit_by(light, size=2))
        answers = [said(tracer, f"lights.0.{constant}") for constant in names]
        if answers:
            thing = light.core_name if known else OTHERS[name]
            yield thing, ", ".join(names), answers[0].partition(" (")[0]
