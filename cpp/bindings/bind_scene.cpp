// Geometry of a scene: shapes, instances, textures, media, lights.
#include <optional>

#include "light_list.h"
#include "media_args.h"
#include "module.h"
#include "photograd/scene/path_scene.h"
#include "sdf_args.h"
#include "texture_args.h"

namespace photograd {
namespace {

/// vertices (V, 3), faces (F, 3), shading normals (V, 3) or None, texture coordinates (V, 2) or
/// None.
using MeshArrays =
    std::tuple<py::array, py::array, std::optional<py::array>, std::optional<py::array>>;

struct Meshes {
    std::vector<Mesh> meshes;
    std::vector<std::vector<float>> normals;
};

Meshes meshes_of(const std::vector<MeshArrays>& rows) {
    Meshes out;
    for (const auto& [vertices, faces, shading, coordinates] : rows) {
        ArrayArgs args("PathTracer");
        const float* v = args.in<float>("vertices", vertices, "V 3");
        const std::uint32_t* f = args.in<std::uint32_t>("faces", faces, "F 3");
        const auto V = static_cast<std::size_t>(args.size("V")),
                   F = static_cast<std::size_t>(args.size("F"));
        out.normals.emplace_back();
        if (shading) {
            const float* n = args.in<float>("normals", *shading, "V 3");
            out.normals.back().assign(n, n + 3 * V);
        }
        std::span<const float> uv;
        if (coordinates) uv = {args.in<float>("uv", *coordinates, "V 2"), 2 * V};
        out.meshes.emplace_back(std::span<const float>(v, 3 * V),
                                std::span<const std::uint32_t>(f, 3 * F), uv,
                                static_cast<int>(out.meshes.size()));
    }
    return out;
}

/// (I,) mesh numbers and (I, 3, 4) matrices, when the shutter opens and when it closes.
std::vector<Instance> instances_of(ArrayArgs& args, const py::array& placed,
                                   const py::array& matrices,
                                   const std::optional<py::array>& closing) {
    const std::int32_t* which = args.in<std::int32_t>("instances", placed, "I");
    const double* rows = args.in<double>("matrices", matrices, "I 3 4");
    const double* later =
        closing ? args.in<double>("closing_matrices", *closing, "I 3 4") : nullptr;
    std::vector<Instance> out;
    for (std::int64_t i = 0; i < args.size("I"); ++i) {
        Instance& one = out.emplace_back(Instance{which[i], Affine{}});
        std::copy_n(rows + 12 * i, 12, one.world_from_object.m.begin());
        if (!later) continue;
        std::copy_n(later + 12 * i, 12, one.closing.m.begin());
        one.moves = one.closing.m != one.world_from_object.m;
    }
    return out;
}

/// (K, 4): center and radius.
std::vector<Sphere> spheres_of(ArrayArgs& args, const char* name, const py::array& rows) {
    const float* s = args.in<float>(name, rows, "K 4");
    std::vector<Sphere> out;
    for (std::int64_t i = 0; i < args.size("K"); ++i)
        out.push_back({s[4 * i], s[4 * i + 1], s[4 * i + 2], s[4 * i + 3]});
    return out;
}

std::shared_ptr<PathGeometry> build(const std::vector<MeshArrays>& mesh_rows,
                                    const py::array& placed, const py::array& matrices,
                                    const py::array& spheres, const py::array& material,
                                    const py::array& emission, const LightTuples& lights,
                                    const std::vector<std::tuple<Sdf, py::array>>& sdfs,
                                    const std::optional<py::array>& closing_matrices,
                                    const std::optional<py::array>& closing_spheres) {
    Meshes built = meshes_of(mesh_rows);
    ArrayArgs args("PathTracer");
    std::vector<Instance> instances = instances_of(args, placed, matrices, closing_matrices);
    std::vector<Sphere> opening = spheres_of(args, "spheres", spheres), closing;
    if (closing_spheres) closing = spheres_of(args, "closing_spheres", *closing_spheres);
    const std::int32_t* m = args.in<std::int32_t>("material", material, "S");
    const double* e = args.in<double>("emission", emission, "S 3");
    const auto S = static_cast<std::size_t>(args.size("S"));
    const std::size_t shapes = instances.size() + opening.size() + sdfs.size();
    if (S != shapes)
        args.range("material", std::to_string(shapes) + ", one a shape", std::to_string(S));
    std::vector<SdfSolid> solids;
    for (const auto& [sdf, numbers] : sdfs)
        solids.emplace_back(sdf, checked_numbers(args, sdf, numbers));
    const std::vector<AnyLight<double>> infinite_and_delta_lights =
        infinite_and_delta<double>(lights);
    const py::gil_scoped_release release;
    return std::make_shared<PathGeometry>(
        Bvh(std::move(built.meshes), std::move(instances), std::move(opening), std::move(solids),
            std::move(closing)),
        std::vector<std::int32_t>(m, m + S), std::move(built.normals),
        std::span<const double>(e, 3 * S), infinite_and_delta_lights);
}

/// Entries of the table of lights, by uniform numbers: those of the list first, then pieces of
/// shapes.
py::tuple choose_lights(const PathGeometry& geometry, const py::array& u) {
    ArrayArgs args("choose_lights");
    const double* x = args.in<double>("u", u, "N");
    if (geometry.lights.empty()) args.range("u", "a scene with lights", "one without");
    py::array_t<std::int64_t> entry(args.size("N"));
    py::array_t<double> pmf(args.size("N"));
    for (std::int64_t n = 0; n < args.size("N"); ++n) {
        const Choice choice = geometry.lights.choose(x[n]);
        entry.mutable_at(n) = choice.index;
        pmf.mutable_at(n) = choice.pmf;
    }
    return py::make_tuple(entry, pmf);
}

}  // namespace

void bind_scene(py::module_& m) {
    py::class_<PathGeometry, std::shared_ptr<PathGeometry>>(
        m, "PathGeometry",
        "Shapes of a scene: instances of meshes first, then spheres, then signed distance fields.")
        .def(py::init(&build), py::arg("meshes"), py::arg("instances"), py::arg("matrices"),
             py::arg("spheres"), py::arg("material"), py::arg("emission"), py::arg("lights"),
             py::arg("sdfs") = py::list(), py::arg("closing_matrices") = py::none(),
             py::arg("closing_spheres") = py::none(),
             "Meshes as (vertices (V, 3) float32, faces (F, 3) uint32, normals (V, 3) float32 or "
             "None,\nuv (V, 2) float32 or None); instances (I,) int32, mesh numbers, and matrices "
             "(I, 3, 4) float64;\nspheres (K, 4) float32; material (S,) int32 and emission (S, 3) "
             "float64 of each shape,\nwhich are the instances, then the spheres, then sdfs, (body, "
             "numbers (P,)). Lights of the "
             "list: (name, parameters, "
             "constants) or\n(\"environment\", texels, world_from_map, sampler), float64. "
             "closing_matrices and\nclosing_spheres are those when the shutter closes, None where "
             "nothing moves.")
        .def("choose_lights", &choose_lights, py::arg("u"),
             "(entries (N,) int64, their probabilities (N,)) by uniform u (N,): first lights of "
             "the list, then what emits of the shapes.")
        .def(
            "set_textures", &set_textures, py::arg("layouts"), py::arg("uses"),
            py::arg("normal_maps"), py::arg("directed"), py::arg("cutoffs"), py::arg("emission"),
            "Layouts (H, W, C, wrap_u, wrap_v, mips) of textures; for each material uses (texture, "
            "channel, first,\ncount, lo, hi), and a normal map (values (H, W, 3) float32, wrap_u, "
            "wrap_v) or None;\ndirected (M,), whether its frame follows u; cutoffs (M,), of masks, "
            "others below 0; emission,\nfor each shape (texture or -1, first of its three "
            "channels).")
        .def("set_media", &set_media, py::arg("interior"), py::arg("boundary"), py::arg("world"),
             py::arg("grids"),
             "interior (S,) int32: the number of a medium, -1 for nothing, -2 for what is around; "
             "boundary (S,) bool;\nworld: the number of a medium or -1; for each medium "
             "((X, Y, Z), box_from_world (3, 4) float64) or None.")
        .def_property_readonly(
            "bvh",
            [](std::shared_ptr<PathGeometry> self) {
                return std::shared_ptr<Bvh>(self, &self->bvh);
            },
            "The hierarchy of all shapes, to be traced.");
}

}  // namespace photograd
