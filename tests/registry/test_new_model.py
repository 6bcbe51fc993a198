"""Adding a reflectance model is one header and its name in the registry; six things follow.

A copy of the core gets a made-up model. Only the table of reflectance models and its bindings are
compiled, into a small module and in one piece, since pybind11's headers take longer than what
follows them; then the model's binding, stub, gradient proof, physics proofs, benchmark row and
picture are asserted, none of which the copy mentions.
"""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from types import ModuleType

import pybind11
import pytest
from photograd.bsdf import BsdfModel, registry
from photograd.bsdf.gallery import benchmark_row, gallery_picture

from support.bsdf_proofs import PROOFS
from support.missing import missing
from support.tree import ROOT

HEADER = """#pragma once

#include "photograd/bsdf/bsdf.h"
#include "photograd/sampling/warp.h"

namespace photograd {

/// Lambert under dust that swallows a part of the light.
template <class R>
struct Dusty {
    Vec3<R> albedo{R(0.5)};
    R dust{R(0)};

    static constexpr const char* name = "dusty";
    static constexpr EnergyClaim energy{Energy::lossy, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(p("albedo", &Dusty::albedo, 0.0, 1.0),
                                            p("dust", &Dusty::dust, 0.0, 0.9));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const bool lit = wo.z > R(0) && wi.z > R(0);
        return albedo * ((R(1) - dust) * (lit ? R(1 / pi) : R(0)));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f, Dusty& d_self) const {
        const R part = wo.z > R(0) && wi.z > R(0) ? R(1 / pi) : R(0);
        d_self.albedo += d_f * ((R(1) - dust) * part);
        d_self.dust -= dot(d_f, albedo) * part;
    }
    Vec3<R> sample(const Vec3<R>&, const Vec2<R>& u2) const {
        return square_to_cosine_hemisphere(u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return wo.z > R(0) ? cosine_hemisphere_pdf(wi) : R(0);
    }
};

static_assert(Bsdf<Dusty>);

}  // namespace photograd
"""
MODULE = """#include "bindings/module.h"

PYBIND11_MODULE(_with_dusty, m) {
    photograd::bind_errors(m);
    photograd::bind_bsdf(m);
}
"""
SOURCES = (
    "bindings/bind_bsdf.cpp",
    "bindings/array_args.cpp",
    "bindings/errors.cpp",
    "photograd/bsdf/bsdf_table_float.cpp",
    "photograd/bsdf/bsdf_table_double.cpp",
    "photograd/core/parallel.cpp",
)


def add_model(cpp: Path) -> None:
    """The whole change: a header, and its include and name in the registry.

    The copy keeps one of the other models; all of them would only compile for longer.
    """
    (cpp / "photograd/bsdf/dusty.h").write_text(HEADER)
    path = cpp / "photograd/bsdf/registry.h"
    text = path.read_text()
    include = '#include "photograd/bsdf/lambert.h"\n'
    assert include in text
    assert "ModelList<Lambert" in text
    text = text.replace(include, '#include "photograd/bsdf/dusty.h"\n' + include)
    path.write_text(re.sub(r"ModelList<Lambert[^>]*>", "ModelList<Dusty, Lambert>", text))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the module with the new model has been built."""
    compiler = shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        missing("a C++ compiler is not here")
    build = tmp_path_factory.mktemp("new_model")
    cpp = build / "cpp"
    shutil.copytree(ROOT / "cpp", cpp)
    add_model(cpp)
    whole = cpp / "module_with_dusty.cpp"
    whole.write_text("".join(f'#include "{source}"\n' for source in SOURCES) + MODULE)
    python = sysconfig.get_paths()["include"]
    target = build / f"_with_dusty{sysconfig.get_config_var('EXT_SUFFIX')}"
    # std::thread instead of TBB: nothing else is to be found and linked. Paths are relative: so
    # ccache, where it is installed, knows an unchanged core again.
    flags = [
        "-std=c++20",
        "-O1",
        "-fPIC",
        "-fvisibility=hidden",
        "-ffp-contract=off",
        "-pthread",
        "-DPHOTOGRAD_STD_THREADS",
        "-Icpp",
        "-Icpp/bindings",
        f"-I{pybind11.get_include()}",
        f"-I{python}",
    ]
    cached = [shutil.which("ccache") or "env", compiler]
    for command in (
        [*cached, *flags, "-c", f"cpp/{whole.name}", "-o", "module.o"],
        [compiler, "-shared", "-pthread", "module.o", "-o", target.name],
    ):
        run = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            cwd=build,
            env={**os.environ, "CCACHE_BASEDIR": str(build), "CCACHE_NOHASHDIR": "1"},
        )
        assert run.returncode == 0, run.stderr
    return build


@pytest.fixture(scope="module")
def model(folder: Path) -> BsdfModel:
    """1. The binding."""
    path = next(folder.glob("_with_dusty*"))
    spec = importlib.util.spec_from_file_location("_with_dusty", path)
    assert spec is not None
    assert spec.loader is not None
    module: ModuleType = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    models = registry(module)
    assert sorted(models) == ["dusty", "lambert"]
    names = [(p.name, p.size, p.hi) for p in models["dusty"].parameters]
    assert names == [("albedo", 3, 1.0), ("dust", 1, 0.9)]
    return models["dusty"]


@pytest.mark.slow
def test_all_six_follow(folder: Path, model: BsdfModel, tmp_path: Path) -> None:
    # 2. The stub, which is the same for all models.
    command = [sys.executable, "-m", "pybind11_stubgen", "_with_dusty", "-o", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    assert run.returncode == 0, run.stderr
    stub = (tmp_path / "_with_dusty.pyi").read_text()
    assert "class Bsdf:" in stub
    assert "bsdfs: dict" in stub
    # 3. and 4. Gradient and physics.
    for proof in PROOFS:
        proof(model)
    # 5. The benchmark row.
    row = benchmark_row(model, count=2000)
    assert row["model"] == "dusty"
    assert row["mean"] > 0
    # 6. The picture.
    gallery_picture(model, tmp_path / "dusty.png")
    assert (tmp_path / "dusty.png").stat().st_size > 10_000
