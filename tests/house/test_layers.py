"""Who may include whom, in both languages."""

from __future__ import annotations

import re
import sys
import tomllib
from importlib import import_module
from itertools import chain

import pytest

from support.layers import cpp_breaches, python_breaches
from support.tree import ROOT, cpp_texts, python_texts

COURSE = "python/photograd_course/"
CORE = "python/photograd/"
BUILD_HOOK = COURSE + "hatch_build.py"  # runs inside of the build backend, and is in no wheel
# Where the name on the package index is not the name that is imported.
IMPORT_NAMES = {
    "markdown-it-py": "markdown_it",
    "pillow": "PIL",
    "pyyaml": "yaml",
    "scikit-image": "skimage",
}


def names(requirements: list[str]) -> set[str]:
    """What importing these requirements is called."""
    bare = [re.split(r"[^A-Za-z0-9_.-]", line)[0] for line in requirements]
    return {IMPORT_NAMES.get(name.lower(), name.replace("-", "_")) for name in bare}


def allowed_imports() -> dict[str, set[str]]:
    course = tomllib.loads((ROOT / COURSE / "pyproject.toml").read_text(encoding="utf-8"))
    core = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    extras = core["project"]["optional-dependencies"]
    sys.path.insert(0, str(ROOT / "python"))
    try:
        declared: list[str] = import_module("dependencies").dynamic_metadata("dependencies")
    finally:
        sys.path.pop(0)
    optional = [line for name in ("sfm", "data") for line in extras[name]]
    extras_of_course = course["project"].get("optional-dependencies", {})
    of_course = [*course["project"]["dependencies"], *chain(*extras_of_course.values())]
    standard = set(sys.stdlib_module_names)
    return {
        COURSE: standard | names(of_course) | {"photograd_course"},
        CORE: standard | names(declared + optional) | {"photograd"},
    }


def test_cpp_keeps_the_include_order() -> None:
    texts = cpp_texts()
    assert texts, "no C++ sources found"
    assert cpp_breaches(texts) == []


def test_python_imports_what_it_declares_and_the_course_knows_no_core() -> None:
    allowed = allowed_imports()
    texts = {path: text for path, text in python_texts().items() if path != BUILD_HOOK}
    assert all(any(path.startswith(folder) for path in texts) for folder in allowed)
    assert "photograd" not in allowed[COURSE]
    assert python_breaches(texts, allowed) == []


def test_array_types_are_defined_once() -> None:
    """Floors among packages of photograd are import-linter's (`./run lint`)."""
    shared = re.compile(r"^(?:Array|FloatArray)\b[^=\n]*=", re.MULTILINE)
    found = [path for path, text in python_texts().items() if shared.search(text)]
    assert [path for path in found if path.startswith(CORE)] == [CORE + "types.py"]


@pytest.mark.parametrize(
    ("path", "include"),
    [
        ("photograd/core/real.h", '"photograd/ops/sh.h"'),  # upwards
        ("photograd/bsdf/ggx.h", '"photograd/medium/hg.h"'),  # sideways
        ("photograd/render/march/march.cpp", '"bindings/module.h"'),
        ("photograd/field/dense.cpp", '"kernels/march_dense.h"'),
        ("kernels/march_dense.inl", '"photograd/field/samples.h"'),
        ("photograd/ops/sh.h", "<glm/vec3.hpp>"),  # beside the door
        ("photograd/core/scatter.h", "<tbb/parallel_for.h>"),
        ("photograd/geometry/mesh.h", "<embree4/rtcore.h>"),
        ("photograd/grid/dense_grid.h", "<openvdb/openvdb.h>"),
        ("photograd/core/errors.h", "<pybind11/pybind11.h>"),
        ("photograd/ops/sh.h", '"real.h"'),  # not from cpp/
        ("photograd/shader/x.h", '"photograd/core/real.h"'),  # a folder without a place
    ],
)
def test_a_breach_is_seen(path: str, include: str) -> None:
    assert len(cpp_breaches({path: f"#pragma once\n#include {include}\n"})) == 1


@pytest.mark.parametrize(
    ("path", "include"),
    [
        ("photograd/render/march/march.cpp", '"kernels/kernels.h"'),
        ("photograd/field/dense.h", '"photograd/grid/brick.h"'),
        ("photograd/geometry/bvh.cpp", "<embree3/rtcore.h>"),
        ("bindings/bind_ops.cpp", '"module.h"'),
        ("tests/test_bvh.cpp", '"photograd/geometry/bvh.h"'),
    ],
)
def test_what_is_in_order_passes(path: str, include: str) -> None:
    assert cpp_breaches({path: f"#include {include}\n"}) == []


def test_an_import_of_the_core_by_the_course_is_seen() -> None:
    text = "def late():\n    from photograd import _core\n"
    path = COURSE + "src/photograd_course/x.py"
    assert python_breaches({path: text}, allowed_imports()) == [f"{path} imports photograd"]
