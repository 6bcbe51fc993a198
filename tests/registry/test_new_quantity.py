"""Adding a differentiable quantity to scenes takes five small changes.

A copy of the core's headers gets a made-up one: a gain of each shape's emission. Its derivative is
then checked against finite differences, on a path that is written down by hand: nothing is traced,
so that neither Embree nor the renderers are compiled.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from support.missing import missing
from support.tree import ROOT

CHANGES: dict[str, list[tuple[str, str]]] = {
    # 1. The numbers, and how they enter.
    "photograd/scene/path_scene.h": [
        (
            "    const R* emission;                                            // (S, 3)\n",
            "    const R* emission;                                            // (S, 3)\n"
            "    const R* gain = nullptr;                                      // (S,)\n",
        ),
        (
            "        return {L[0], L[1], L[2]};\n",
            "        return Vec3<R>(L[0], L[1], L[2]) * gain[shape];\n",
        ),
    ],
    # 2. Where the derivatives of some paths are added, 3. and the block that they are.
    "photograd/scene/gradient.h": [
        (
            "    std::vector<Vec3<R>> emission;\n",
            "    std::vector<Vec3<R>> emission;\n    std::vector<R> gain;\n",
        ),
        (
            "          texels(scene.texels.size()),\n",
            "          gain(scene.geometry->shape_count(), R(0)),\n"
            "          texels(scene.texels.size()),\n",
        ),
        (
            "        for (AnyLightGradient<R>& light : lights) for_each_number(light, visit);\n",
            "        for (const R x : gain) visit(x);\n"
            "        for (AnyLightGradient<R>& light : lights) for_each_number(light, visit);\n",
        ),
    ],
    "photograd/scene/gradient.cpp": [
        (
            "    for (std::size_t i = 0; i < scene.lights.size(); ++i) {\n",
            '    add("gain", BlockKind::dense, 0,\n'
            "        {static_cast<std::int64_t>(scene.geometry->shape_count())});\n"
            "    for (std::size_t i = 0; i < scene.lights.size(); ++i) {\n",
        )
    ],
    # 4. Its term in the adjoint.
    "photograd/render/path/adjoint.h": [
        (
            "        d_scene.emission[static_cast<std::size_t>(shape)] += d_L;\n",
            "        const auto s = static_cast<std::size_t>(shape);\n"
            "        const R* E = scene.emission + 3 * s;\n"
            "        d_scene.emission[s] += d_L * scene.gain[s];\n"
            "        d_scene.gain[s] += dot(d_L, Vec3<R>(E[0], E[1], E[2]));\n",
        )
    ],
    # 5. The array that Python hands over.
    "bindings/path_args.h": [
        (
            "        scene.media = media;\n",
            '        scene.gain = args.in<R>("gain", rows.gain, '
            "std::to_string(geometry.shape_count()));\n        scene.media = media;\n",
        )
    ],
}
PROGRAM = """
#include <cstdio>
#include <new>

#include "photograd/render/path/adjoint.h"
#include "photograd/scene/gradient.cpp"

using namespace photograd;

// Of the geometry only what a gradient asks for; a Bvh would need Embree.
struct Geometry {
    alignas(PathGeometry) std::byte bytes[sizeof(PathGeometry)] = {};
    PathGeometry& get() { return *std::launder(reinterpret_cast<PathGeometry*>(bytes)); }
    Geometry() {
        new (&get().material) std::vector<std::int32_t>(2, 0);
        new (&get().lights) SceneLights();
        new (&get().textures) SurfaceTextures();
        new (&get().media) MediaGeometry();
    }
};

Path<double> path_in(const PathScene<double>& scene) {
    Path<double> path;
    PathVertex<double> first, last;
    first.kind = VertexKind::medium;
    first.medium = 0;
    first.direction = {0, 0, 1};
    first.nee = {.shape = 1, .direction = {1, 0, 0}, .wi = {1, 0, 0},
                 .f = Vec3<double>(0.3), .Le = scene.emitted(1), .weight = 0.7};
    first.wi = {0, 0, 1};
    first.f = Vec3<double>(0.4);
    first.weight = 1.5;
    last.shape = 0;
    last.Le = scene.emitted(0);
    last.emission_weight = 0.6;
    path.vertices = {first, last};
    return path;
}

int main() {
    Geometry geometry;
    double gain[2] = {1.3, 0.8};
    const double emission[6] = {1, 2, 3, 0.5, 0.25, 4};
    Medium<double> medium;
    medium.phase = AnyPhase<double>::named("henyey_greenstein");
    PathScene<double> scene{&geometry.get(), {}, {}, emission};
    scene.gain = gain;
    scene.media = scene.sampling_media = std::span(&medium, 1);
    const Vec3<double> d_L(0.9, -0.4, 0.2);
    SceneGradient<double> gradient(scene);
    Vec3<double> Lo[2];
    const Path<double> path = path_in(scene);
    radiance(path, Lo);
    radiance_backward(scene, path, Lo, d_L, gradient);
    std::vector<double> row;
    gradient.for_each_dense([&](double x) { row.push_back(x); });
    std::size_t first = 0;
    for (const auto& block : gradient_blocks(scene)) {
        if (block.name == "gain") break;
        first += block.size();
    }
    for (int s = 0; s < 2; ++s) {
        const double at = gain[s], h = 1e-6;
        const auto loss = [&](double x) {
            gain[s] = x;
            return dot(d_L, radiance<double>(path_in(scene), nullptr));
        };
        const double difference = (loss(at + h) - loss(at - h)) / (2 * h);
        gain[s] = at;
        std::printf("%.17g %.17g\\n", row[first + s], difference);
    }
}
"""


def change(cpp: Path) -> None:
    for name, edits in CHANGES.items():
        text = (cpp / name).read_text()
        for old, new in edits:
            assert text.count(old) == 1, f"{name} no longer has one of: {old}"
            text = text.replace(old, new)
        (cpp / name).write_text(text)


@pytest.mark.slow
def test_a_gain_of_emission_has_the_right_derivative(tmp_path: Path) -> None:
    compiler = shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        missing("a C++ compiler is not here")
    cpp = tmp_path / "cpp"
    shutil.copytree(ROOT / "cpp", cpp)
    change(cpp)
    assert len(CHANGES) <= 5
    (cpp / "main.cpp").write_text(PROGRAM)
    program = tmp_path / "program"
    # What is never called, of Embree and of reflectance models, need not be there.
    flags = [
        "-std=c++20",
        "-O0",
        f"-I{cpp}",
        "-fno-pie",
        "-no-pie",
        "-Wl,--unresolved-symbols=ignore-all",
    ]
    command = [compiler, *flags, str(cpp / "main.cpp"), "-o", str(program)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    out = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    rows = [[float(x) for x in line.split()] for line in out.splitlines()]
    assert len(rows) == 2
    for derivative, difference in rows:
        assert abs(difference) > 0.1
        assert derivative == pytest.approx(difference, rel=1e-8)
