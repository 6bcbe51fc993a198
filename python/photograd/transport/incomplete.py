"""Derivatives that are known to be incomplete, which nothing hands out: of what, why, what to do.

Paths are held fixed while a parameter changes. That gives the whole derivative of how much light
each path carries, but not of where paths go or which of them exist:

    smooth refraction    Snell's direction turns with the index of refraction, and what is seen
                         through the glass moves with it. A rough surface has no such term: its
                         lobe's value at a held direction changes instead.
    masks                alpha and its texture say where a surface ends: edges would move.

What is refused is refused in every scene, although the missing term happens to vanish in some, such
as a pane of glass in front of a uniform environment.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from photograd.errors import RangeError, message
from photograd.transport.material import ALPHA
from photograd.transport.scene import Scene
from photograd.types import Array

TURNING = {
    "glass": (("eta",), "rough_dielectric"),
    "dispersive_glass": (("eta", "dispersion"), "dispersive_dielectric"),
}
"""Of specular models: the parameters that turn their lobes, and the rough model of the same
surface; a test finds both for every registered model."""
EXPECTED = "a parameter whose derivative is whole"


class Missing(NamedTuple):
    """What a derivative lacks, and how to get a whole one."""

    why: str
    remedy: str


class WholeGradients(dict[str, Array]):
    """{parameter: dL/dparameter}, without the incomplete ones: asking for one raises, and says why.

    Raises:
        RangeError: on access to a parameter whose derivative is incomplete.
        KeyError: on access to anything else that is not there.
    """

    def __init__(
        self,
        function: str,
        found: Mapping[str, Array],
        names: Iterable[str],
        incomplete: Mapping[str, Missing],
    ) -> None:
        """Keep what is whole of `names`, in their order; errors name the `function`.

        Args:
            function: that returns them.
            found: {name: derivative}.
            names: of the parameters that are asked for.
            incomplete: {name: what its derivative lacks}.
        """
        super().__init__({name: found[name] for name in names if name not in incomplete})
        self._function, self._incomplete = function, dict(incomplete)

    def __missing__(self, name: str) -> Array:
        require_whole(self._function, "gradient", [name], self._incomplete)
        raise KeyError(name)


def incomplete_derivatives(scene: Scene) -> dict[str, Missing]:
    """{parameter: what its derivative lacks}, by the names in `PathTracer.params`.

    A texture counts as soon as one of the parameters that it scales does.

    Args:
        scene: whose materials and media are asked.
    """
    found: dict[str, Missing] = {}
    for name, material in scene.materials.items():
        parameters, rough = TURNING.get(material.model, ((), ""))
        reasons = {
            parameter: Missing(
                f"it turns the refracted rays of smooth {material.model}, and paths are held fixed",
                f"model {rough} has the whole derivative; against its noise, take a roughness of "
                "0.3 or more and many samples",
            )
            for parameter in parameters
        }
        if material.alpha_cutoff is not None:
            reasons[ALPHA.name] = Missing(
                "it moves the edges of a mask, and paths are held fixed",
                "without alpha_cutoff, alpha is an opacity and has the whole derivative",
            )
        for parameter, reason in reasons.items():
            found[f"materials.{name}.{parameter}"] = reason
            if parameter in material.textures:
                found[f"textures.{material.textures[parameter].texture}"] = reason
    return found


def require_whole(
    function: str, argument: str, names: Iterable[str], incomplete: Mapping[str, Missing]
) -> None:
    """Refuse the first of `names` that is among the incomplete.

    Args:
        function: that was called, for errors.
        argument: with the names, for errors.
        names: of parameters.
        incomplete: {name: what its derivative lacks}.

    Raises:
        RangeError: with what is missing and the remedy.
    """
    for name in names:
        if name in incomplete:
            why, remedy = incomplete[name]
            raise RangeError(message(function, argument, EXPECTED, f"'{name}': {why}", remedy))


def changed_names(step: Mapping[str, Array]) -> list[str]:
    """Parameters that a direction {name: change} moves at all.

    Args:
        step: {name: change}.
    """
    return [name for name, change in step.items() if np.any(change)]
