"""tools/fingerprints.py: what it hashes, what it reports, and that nothing is left uncrossed."""

from __future__ import annotations

import ast
import dataclasses
import importlib
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd import lights
from photograd._compiled import _core
from photograd.bsdf import phase
from photograd.transport import (
    DensityGrid,
    Environment,
    Lens,
    Material,
    Medium,
    MeshShape,
    NormalMap,
    ParticleOptions,
    PathOptions,
    PathTracer,
    Scene,
    SdfShape,
    Shutter,
    SphereShape,
    Texture,
    TextureUse,
)
from photograd.transport.material import MODELS
from photograd.transport.path_options import HEURISTICS, SAMPLERS, STRATEGIES
from photograd.transport.texture import FILTERS, WRAPS

from support.tree import ROOT

pytestmark = pytest.mark.usefixtures("core")
SMALL = "path/fog/default/"
KINDS = (
    Scene,
    MeshShape,
    SphereShape,
    SdfShape,
    Material,
    NormalMap,
    Texture,
    TextureUse,
    Medium,
    DensityGrid,
    Environment,
    Lens,
    Shutter,
)
FUNCTIONS = (
    "trace_paths",
    "trace_paths_backward",
    "dual_buffer_backward",
    "trace_paths_tangent",
    "trace_path",
    "emit_particles",
    "trace_light",
    "trace_photons",
    "ambient_occlusion",
    "point_occlusion",
)


@pytest.fixture
def tool(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The modules of the tool, by name."""
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    names = ("case", "catalog", "compare", "paths", "scenes", "run")
    found = {name: importlib.import_module(f"fingerprint_cases.{name}") for name in names}
    found["main"] = importlib.import_module("fingerprints").main
    yield found
    found["paths"].tracer_of.cache_clear()


def parts(value: Any) -> Iterator[Any]:
    """A scene, and all dataclasses in it."""
    if dataclasses.is_dataclass(value):
        yield value
        value = vars(value)
    if isinstance(value, Mapping):
        value = tuple(value.values())
    if isinstance(value, list | tuple):
        for part in value:
            yield from parts(part)


def differs(value: Any, field: dataclasses.Field[Any]) -> bool:
    """Whether a field has another value than its default."""
    if field.default is not dataclasses.MISSING:
        default = field.default
    elif field.default_factory is not dataclasses.MISSING:
        default = field.default_factory()
    else:
        return True
    if default is None or value is None:
        return value is not default
    if isinstance(value, np.ndarray):
        return not np.array_equal(value, default)
    return bool(value != default)


def test_every_part_of_a_scene_is_crossed(tool: Any) -> None:
    crossed = defaultdict(set)
    used = defaultdict(set)
    for make in tool["paths"].SCENES.values():
        for part in parts(tool["scenes"].without_unused(make())):
            used[type(part)].add(getattr(part, "model", getattr(part, "phase", "")))
            used["wraps"].update(getattr(part, "wrap", ()))
            used["filters"].add(getattr(part, "filter", "bilinear"))
            for field in dataclasses.fields(part):
                if differs(getattr(part, field.name), field):
                    crossed[type(part)].add(field.name)
    crossed[SdfShape].add("emission")  # refused: signed distance fields do not emit
    crossed[Material].add("occlusion")  # of ambient light: no path looks at it
    for kind in KINDS:
        assert crossed[kind] == {field.name for field in dataclasses.fields(kind)}, kind
    assert used[Material] == set(MODELS)
    assert used[Medium] == set(phase.registry())
    assert used["wraps"] == set(WRAPS)
    assert used["filters"] == set(FILTERS)
    listed = {getattr(lights, name) for name in lights.__all__ if name.endswith(("Light", "Map"))}
    assert listed - {lights.Light, lights.RegisteredLight} <= set(used)


METHODS = (
    "PathGeometry",
    "PathGeometry.choose_lights",
    "PathGeometry.set_media",
    "PathGeometry.set_textures",
    "PhotonMap",
    "PhotonMap.irradiance",
)
GROUPS = ("path", "call", "irradiance", "emitted", "photons", "occlusion", "occlusion-baked")
CALLED = (*FUNCTIONS, *METHODS)
ONE = np.ones(1)
RETURNED = {"trace_path": [], "emit_particles": [ONE] * 4, "PathGeometry.choose_lights": [ONE] * 2}


class Recorder:
    """Stands for a function or a class of the core: notes its arguments and computes nothing."""

    def __init__(self, name: str, given: dict[str, list[Any]]) -> None:
        self.name, self.given = name, given

    def __call__(self, *args: Any, **named: Any) -> Any:
        order = arguments_of(self.name)
        for name, value in (*zip(order, args, strict=False), *named.items()):
            self.given[f"{self.name}.{name}"].append(value)
        for name in ("radiance", "squares"):  # a pilot picture that varies
            if name in named:
                named[name] += np.random.default_rng(1).random(named[name].shape) + (name[0] == "s")
        return RETURNED.get(self.name, self)

    def __getattr__(self, name: str) -> Any:
        return Recorder(f"{self.name}.{name}", self.given)

    def __len__(self) -> int:
        return 1


@cache
def arguments_of(name: str) -> list[str]:
    """Names of the arguments of a function or a method of the core, as its stub has them."""
    body = ast.parse((ROOT / "python/photograd/_core.pyi").read_text(encoding="utf-8")).body
    owner, _, method = name.rpartition(".")
    if owner or name[0].isupper():
        owner, method = owner or name, method if owner else "__init__"
        body = next(n.body for n in body if isinstance(n, ast.ClassDef) and n.name == owner)
    found = next(
        (n for n in body if isinstance(n, ast.FunctionDef) and n.name == (method or name)), None
    )
    return [a.arg for a in found.args.args if a.arg != "self"] if found else []


def test_every_argument_and_option_of_the_core_is_crossed(
    tool: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: dict[str, list[Any]] = defaultdict(list)
    options: dict[type, set[Any]] = defaultdict(set)
    for kind in (PathOptions, ParticleOptions):
        numbers = kind.numbers

        def noted(self: Any, seed: int, numbers: Any = numbers) -> Any:
            options[type(self)].add(self)
            return numbers(self, seed)

        monkeypatch.setattr(kind, "numbers", noted)
    for name in (*FUNCTIONS, "PathGeometry", "PhotonMap"):
        monkeypatch.setattr(_core, name, Recorder(name, given))
    tool["paths"].tracer_of.cache_clear()
    for name, case in tool["catalog"].all_cases().items():
        twice = "/f64" in name and "/tangent" not in name and "/vertices" not in name
        if name.split("/")[0] in GROUPS and not twice and "/model-" not in name:
            case.run(1)
    missing = [
        f"{name}.{argument}"
        for name in CALLED
        for argument in arguments_of(name)
        if not any(says_something(value) for value in given[f"{name}.{argument}"])
    ]
    assert missing == []
    for kind, found in options.items():
        for field in dataclasses.fields(kind):
            assert len({getattr(it, field.name) for it in found}) > 1, field.name
    paths = options[PathOptions]
    assert {it.strategy for it in paths} == set(STRATEGIES)
    assert {it.heuristic for it in paths} == set(HEURISTICS)
    assert {it.sampler for it in paths} == set(SAMPLERS)


def says_something(value: Any) -> bool:
    """Whether an argument is there: not None, and not an empty list or array."""
    return value is not None and (not hasattr(value, "__len__") or len(value) > 0)


def test_names_are_unique_and_lines_can_be_split(tool: Any) -> None:
    names = list(tool["catalog"].all_cases())  # raises for two of one name
    assert len(names) > 1500
    assert not any(" " in name for name in names)
    files = {tool["run"].file_of(Path(), case) for case in tool["catalog"].all_cases().values()}
    assert len(files) == len(names)


def test_two_runs_agree_and_changes_are_reported(
    tool: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    main = tool["main"]
    first, arrays = tmp_path / "a", tmp_path / "arrays"
    only = ("--only", SMALL)
    assert main(["write", str(first), *only, "--save", str(arrays), "--seeds", "4"]) == 0
    assert len(first.read_text().splitlines()) == 8
    threads = _core.thread_count()
    assert main(["compare", str(first), *only, "--threads", "3"]) == 0
    assert _core.thread_count() == threads
    assert "8 same, 0 different" in capsys.readouterr().out

    render = PathTracer.render

    def nudged(self: PathTracer, **given: Any) -> Any:
        sums = render(self, **given)
        if self.dtype == np.float64:
            sums.radiance[3, 4, 1] = np.nextafter(sums.radiance[3, 4, 1], np.inf)
        return sums

    monkeypatch.setattr(PathTracer, "render", nudged)
    lines = first.read_text().splitlines()
    first.write_text("\n".join(["gone 0", *lines[1:]]))
    assert main(["compare", str(first), "--against", str(arrays), *only]) == 1
    said = capsys.readouterr().out
    assert f"different: {SMALL}f64/picture" in said
    assert f"new: {lines[0].split()[0]}" in said
    assert "6 same, 1 different, 0 failed, 0 missing, 1 new" in said
    assert "radiance: 1 of 576 numbers differ, by at most" in said
    assert "means of 4 seeds" in said
    assert main(["compare", str(first), "--only", "nothing of this name"]) == 2

    def broken(self: PathTracer, **_: Any) -> Any:
        raise ValueError(f"{self.dtype} is broken")

    monkeypatch.setattr(PathTracer, "render", broken)
    assert main(["compare", str(first), *only]) == 1
    said = capsys.readouterr().out
    assert f"failed: {SMALL}f32/picture: ValueError: float32 is broken" in said
    assert "6 same, 0 different, 2 failed, 0 missing, 0 new" in said
    assert main(["write", str(tmp_path / "b"), *only]) == 1
    assert not (tmp_path / "b").exists()


def test_zeros_and_shifted_means_are_found(tool: Any) -> None:
    case = tool["case"]
    for arrays in ({"a": np.zeros(3)}, {"a": np.ones(3), "b": np.zeros(3)}, {}):
        with pytest.raises(case.ZeroResultError):
            case.computed(case.Case("c", lambda _, found=arrays: found))
    with pytest.raises(case.ZeroResultError, match="not finite: a"):
        case.computed(case.Case("c", lambda _: {"a": np.array([1.0, np.nan])}))

    def said(shift: float) -> str:
        def draw(seed: int) -> Any:
            return {"a": 1 + shift * (seed >= 2000) + np.random.default_rng(seed).random((30, 3))}

        made = case.Case("c", draw, ("a",))
        before, after = (tool["run"].estimates(made, first, 8)["a"] for first in (1000, 2000))
        return str(tool["compare"].z_test(before, after))

    z = [abs(float(said(shift).split("z = ")[1].split(",")[0])) for shift in (0.0, 0.3)]
    assert z[0] < 4 < z[1]
