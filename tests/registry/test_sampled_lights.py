"""Every light of the registry behind the interface of a tracer: derivatives, bits, bad numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.lights import RegisteredLight, cap_height, registry
from photograd_course.gradcheck import check_accumulation, check_gradient, dot_product_error
from photograd_course.mutants import check_overwriting_mutants
from photograd_course.random import uniform

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants

CLASSES = registry()
AT_INFINITY = ("constant", "sky", "sun")
COUNT = 24
UNIT = np.array([2.0, 3.0, -6.0]) / 7.0
CONSTANTS: dict[str, dict[str, Any]] = {
    "point": {"position": [0.1, 2.0, -0.3]},
    "directional": {"direction": UNIT},
    "spot": {"position": [0.1, 2.0, -0.3], "axis": np.array([1.0, -12.0, 0.0]) / np.sqrt(145.0)},
    "quad": {"corner": [-1.0, 2.0, -1.0], "edge_x": [2.0, 0, 0.5], "edge_y": [-0.5, 0, 2.0]},
    "sphere": {"center": [0.1, 2.0, -0.3], "radius": 0.8},
    "triangle": {"a": [-1.0, 2.0, -1.0], "b": [2.0, 2.2, 0], "c": [0, 1.8, 2.0]},
    "constant": {},
    "sky": {},
    "sun": {"direction": UNIT, "height": cap_height(0.3)},
}
SPOT = {"cos_outer": np.float64(0.7), "softness": np.float64(0.9)}


def light_of(name: str) -> RegisteredLight:
    values = dict(CONSTANTS[name])
    for number, parameter in enumerate(CLASSES[name].parameters()):
        u = uniform(3, step=number, pixel=np.arange(parameter.size))
        values[parameter.name] = parameter.lo + (parameter.hi - parameter.lo) * (0.1 + 0.8 * u)
    if name == "spot":
        values.update(SPOT)
    return CLASSES[name](**values)


def points() -> Any:
    """Around the origin: below the lights, inside of the spot's fading rim."""
    u = uniform(4, pixel=np.arange(COUNT)[:, None], dimension=np.arange(3))
    return (2.0 * u - 1.0) * [0.9, 0.2, 0.9]


def u2() -> Any:
    return uniform(5, pixel=np.arange(COUNT)[:, None], dimension=np.arange(2))


def d_radiance() -> Any:
    return 0.5 + uniform(6, pixel=np.arange(COUNT)[:, None], dimension=np.arange(3))


def test_each_light_is_tested_here_and_has_a_class() -> None:
    assert set(CONSTANTS) == set(_core.sampled_lights) == set(CLASSES)


class Proof:
    """One of a light's two adjoints as a function of named groups."""

    def __init__(self, light: RegisteredLight, function: str) -> None:
        self.light, self.function = light, function
        self.core, (parameters, self.constants) = light.core_call(np.float64)
        self.place = {k: np.atleast_1d(v) for k, v in light.named(parameters).items()}
        self.points = points()
        self.w = self.core.sample(parameters, self.constants, self.points, u2())[0]
        if function == "radiance":  # and some that miss
            self.w[::5] *= -1.0

    def flat(self, groups: dict[str, Any]) -> Any:
        return np.concatenate([groups[name] for name in self.place])

    def forward(self, groups: dict[str, Any]) -> Any:
        if self.function == "radiance":
            return self.core.radiance(self.flat(groups), self.constants, self.points, self.w)
        return self.core.sample(self.flat(groups), self.constants, self.points, u2())[2]

    def accumulate(self, groups: dict[str, Any], d: Any, d_groups: dict[str, Any]) -> None:
        buffer = self.flat(d_groups)
        backward = getattr(self.core, f"{self.function}_backward")
        d = np.ascontiguousarray(d)
        backward(self.flat(groups), self.constants, self.points, self.w, d, buffer)
        for name, part in self.light.named(buffer).items():
            d_groups[name][...] = part

    def backward(self, groups: dict[str, Any], d: Any) -> dict[str, Any]:
        d_groups = {name: np.zeros_like(value) for name, value in groups.items()}
        self.accumulate(groups, d, d_groups)
        return d_groups

    def jvp(self, groups: dict[str, Any], directions: dict[str, Any]) -> Any:
        v = self.flat(directions)
        return self.core.jvp(self.flat(groups), self.constants, v, self.points, self.w)


@pytest.mark.parametrize("function", ["sample", "radiance"])
@pytest.mark.parametrize("name", sorted(CONSTANTS))
def test_gradients(name: str, function: str) -> None:
    light = light_of(name)
    if light.is_delta and function == "radiance":
        w = np.tile(UNIT, (COUNT, 1))
        assert (light.L(points(), w) == 0).all(), "no direction meets a delta light"
        assert (light.pdf(points(), w) == 0).all()
        d = light.L_backward(points(), w, d_radiance())
        assert all((np.asarray(value) == 0).all() for value in d.values())
        return
    proof = Proof(light, function)
    report: Any = check_gradient(proof.forward, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = dot_product_error(proof.jvp, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = check_accumulation(proof.accumulate, proof.place, d_radiance())
    assert report, str(report)
    report = check_gradient_mutants(
        proof.forward,
        proof.backward,
        proof.place,
        d_radiance(),
        seed=1,
        directions=3,
        coordinates=4,
        steps=(1e-4, 1e-5),
    )
    assert report, str(report)
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, proof.place, d_radiance()),
        proof.accumulate,
        proof.place,
        d_radiance(),
    )
    assert report, str(report)


@pytest.mark.parametrize("name", AT_INFINITY)
def test_lights_at_infinity_look_the_same_from_everywhere(name: str) -> None:
    light, nowhere = light_of(name), np.zeros((COUNT, 3))
    samples, others = light.sample(points(), u2()), light.sample(nowhere, u2())
    assert np.isinf(samples.distance).all()
    np.testing.assert_array_equal(samples.direction, others.direction)
    for function in (light.L, light.pdf):
        here = function(points(), samples.direction)
        np.testing.assert_array_equal(here, function(nowhere, samples.direction))


@same_bits("sampled light", each=sorted(CONSTANTS))
def samples_and_gradients(name: str) -> list[Any]:
    # More rows than one block of 4096.
    many = np.ascontiguousarray(np.tile(points(), (500, 1)), "f4")
    u = uniform(7, pixel=np.arange(len(many))[:, None], dimension=np.arange(2)).astype("f4")
    light = light_of(name)
    samples = light.sample(many, u)
    d_samples = samples.radiance * (samples.pdf > 0)[:, None]
    d = light.sample_backward(many, samples, d_samples)
    return [samples.direction, samples.distance, samples.pdf, *d.values()]


@pytest.mark.parametrize(
    ("name", "values", "error", "text"),
    [
        (
            "point",
            {"intensity": [1.0, -1.0, 1.0]},
            RangeError,
            "^PointLight: intensity.*not negative",
        ),
        ("point", {"position": [0.0, np.nan, 0.0]}, RangeError, "position.*finite"),
        ("point", {"position": [0.0, 1.0]}, ShapeError, "position"),
        ("directional", {"direction": [0.0, 0.0, 0.0]}, RangeError, "direction"),
        ("spot", {"softness": 0.0}, RangeError, r"softness.*\(0, 1\]"),
        ("spot", {"cos_outer": 1.0}, RangeError, "cos_outer"),
        ("quad", {"edge_x": [0.0, 0.0, 0.0]}, RangeError, "edges of some length"),
        ("quad", {"edge_x": [1.0, 0.0, 1.0]}, RangeError, "perpendicular"),
        ("sphere", {"radius": 0.0}, RangeError, "radius.*positive"),
        ("sphere", {"radius": [1.0]}, ShapeError, "radius"),
        ("triangle", {"b": [-1.0, 2.0, -1.0]}, RangeError, "span an area"),
        ("constant", {"radiance": [np.inf, 0, 0]}, RangeError, "radiance.*finite"),
    ],
)
def test_bad_numbers_are_named(
    name: str, values: dict[str, Any], error: type[Error], text: str
) -> None:
    good = light_of(name)
    with pytest.raises(error, match=text):
        CLASSES[name](**{**vars(good), **values})


def test_bad_arguments_are_named() -> None:
    light = light_of("sphere")
    with pytest.raises(RangeError, match=r"light: name: expected one of .*did you mean 'sphere'"):
        CLASSES["spheer"]
    with pytest.raises(DtypeError, match=r"^SphereLight\.sample: points"):
        light.sample(np.zeros((2, 3), int), np.zeros((2, 2)))
    with pytest.raises(ShapeError, match=r"u2.*N = 2"):
        light.sample(np.zeros((2, 3)), np.zeros((3, 2)))
    with pytest.raises(RangeError, match=r"u2.*\[0, 1\)"):
        light.sample(np.zeros((1, 3)), np.ones((1, 2)))
    with pytest.raises(DtypeError, match="u2"):
        light.sample(np.zeros((1, 3)), np.zeros((1, 2), "f4"))
    with pytest.raises(RangeError, match=r"points.*row 1"):
        light.pdf(np.array([[0.0, 0, 0], [np.inf, 0, 0]]), np.tile(UNIT, (2, 1)))
    with pytest.raises(RangeError, match="unit length"):
        light.L(np.zeros((1, 3)), np.ones((1, 3)))
