// Path tracing: scenes of shapes and materials, pictures, derivatives, single paths.
#include <optional>

#include "adjoint_calls.h"
#include "camera_args.h"
#include "module.h"
#include "path_rows.h"
#include "photograd/render/ambient_occlusion.h"
#include "photograd/render/path.h"
#include "sdf_args.h"
#include "texture_args.h"

namespace photograd {
namespace {

/// vertices (V, 3), faces (F, 3), shading normals (V, 3) or None, texture coordinates (V, 2) or None.
using MeshArrays =
    std::tuple<py::array, py::array, std::optional<py::array>, std::optional<py::array>>;

std::shared_ptr<PathGeometry> build(const std::vector<MeshArrays>& meshes, const py::array& placed,
                                    const py::array& matrices, const py::array& spheres,
                                    const py::array& material, const py::array& emission,
                                    const LightTuples& lights,
                                    const std::vector<std::tuple<Sdf, py::array>>& sdfs,
                                    const std::optional<py::array>& closing_matrices,
                                    const std::optional<py::array>& closing_spheres) {
    std::vector<Mesh> built;
    std::vector<Instance> instances;
    std::vector<std::vector<float>> normals;
    for (const auto& [vertices, faces, shading, coordinates] : meshes) {
        ArrayArgs args("PathTracer");
        const float* v = args.in<float>("vertices", vertices, "V 3");
        const std::uint32_t* f = args.in<std::uint32_t>("faces", faces, "F 3");
        const auto V = static_cast<std::size_t>(args.size("V")),
                   F = static_cast<std::size_t>(args.size("F"));
        normals.emplace_back();
        if (shading) {
            const float* n = args.in<float>("normals", *shading, "V 3");
            normals.back().assign(n, n + 3 * V);
        }
        std::span<const float> uv;
        if (coordinates) uv = {args.in<float>("uv", *coordinates, "V 2"), 2 * V};
        built.emplace_back(std::span<const float>(v, 3 * V),
                           std::span<const std::uint32_t>(f, 3 * F), uv,
                           static_cast<int>(built.size()));
    }
    ArrayArgs args("PathTracer");
    const std::int32_t* which = args.in<std::int32_t>("instances", placed, "I");
    const double* rows = args.in<double>("matrices", matrices, "I 3 4");
    const double* later = closing_matrices
                              ? args.in<double>("closing_matrices", *closing_matrices, "I 3 4")
                              : nullptr;
    for (std::int64_t i = 0; i < args.size("I"); ++i) {
        instances.push_back({which[i], Affine{}});
        Instance& it = instances.back();
        std::copy_n(rows + 12 * i, 12, it.world_from_object.m.begin());
        if (!later) continue;
        std::copy_n(later + 12 * i, 12, it.closing.m.begin());
        it.moves = it.closing.m != it.world_from_object.m;
    }
    const float* s = args.in<float>("spheres", spheres, "K 4");
    const std::int32_t* m = args.in<std::int32_t>("material", material, "S");
    const double* e = args.in<double>("emission", emission, "S 3");
    const auto K = static_cast<std::size_t>(args.size("K")),
               S = static_cast<std::size_t>(args.size("S"));
    const std::size_t shapes = instances.size() + K + sdfs.size();
    if (S != shapes)
        args.range("material", std::to_string(shapes) + ", one a shape", std::to_string(S));
    std::vector<Sphere> balls;
    for (std::size_t i = 0; i < K; ++i)
        balls.push_back({s[4 * i], s[4 * i + 1], s[4 * i + 2], s[4 * i + 3]});
    std::vector<Sphere> closing;
    if (closing_spheres) s = args.in<float>("closing_spheres", *closing_spheres, "K 4");
    for (std::size_t i = 0; closing_spheres && i < K; ++i)
        closing.push_back({s[4 * i], s[4 * i + 1], s[4 * i + 2], s[4 * i + 3]});
    std::vector<SdfSolid> solids;
    for (const auto& [body, numbers] : sdfs)
        solids.emplace_back(body, checked_numbers(args, body, numbers));
    const std::vector<AnyLight<double>> listed = listed_lights<double>(lights);
    const py::gil_scoped_release release;
    return std::make_shared<PathGeometry>(
        Bvh(std::move(built), std::move(instances), std::move(balls), std::move(solids),
            std::move(closing)),
        std::vector<std::int32_t>(m, m + S), std::move(normals), std::span<const double>(e, 3 * S),
        listed);
}

void trace(const PathGeometry& geometry, const Models& models, const py::array& parameters,
           const std::optional<py::array>& sampling_parameters, const py::array& emission,
           const LightTuples& lights, const Arrays& textures,
           const std::optional<Arrays>& sampling_textures, const MediumTuples& media,
           const std::optional<MediumTuples>& sampling_media, const py::tuple& camera_numbers,
           const Options& given, std::uint32_t first, std::uint32_t count, py::array radiance,
           py::array squares, std::optional<py::array> hits) {
    dispatch_real("trace_paths", "parameters", parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("trace_paths");
        const SceneNumbers<R> numbers(
            args, {geometry, models, parameters, emission, lights, textures, media},
            {sampling_parameters, sampling_textures, sampling_media});
        for (std::size_t i = 0; i < numbers.sampling_media.size(); ++i)
            if (!same_phase(numbers.media[i], numbers.sampling_media[i]))
                args.range("sampling_media", "the same phase functions as media", "others");
        const ThinLens camera = thin_lens(camera_numbers);
        const PathSums sums = path_sums(args, camera, radiance, squares);
        double* counts = nullptr;
        if (hits)
            counts = args.out<double>(
                "hits", *hits, std::to_string(camera.height) + " " + std::to_string(camera.width));
        const PathOptions options = options_of(args, given);
        check_samples(args, first, count);
        const py::gil_scoped_release release;
        trace_paths(numbers.scene, camera, options, {first, count}, sums, counts);
    });
}

/// Entries of the table of lights, by uniform numbers: those of the list first, then pieces of shapes.
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

void ambient_occlusion(const PathGeometry& geometry, const py::tuple& camera_numbers, double radius,
                       std::uint64_t seed, std::uint32_t first, std::uint32_t count,
                       py::array sums) {
    ArrayArgs args("ambient_occlusion");
    const Pinhole camera = pinhole(camera_numbers);
    double* out = args.out<double>(
        "sums", sums, std::to_string(camera.height) + " " + std::to_string(camera.width));
    if (!(radius > 0)) args.range("radius", "above 0 m", std::to_string(radius));
    check_samples(args, first, count);
    const py::gil_scoped_release release;
    trace_ambient_occlusion<double>(geometry, camera, radius, seed, {first, count}, out);
}

}  // namespace

void bind_path(py::module_& m) {
    py::class_<PathGeometry, std::shared_ptr<PathGeometry>>(
        m, "PathGeometry",
        "Shapes of a scene: instances of meshes first, then spheres, then bodies of signed "
        "distances.")
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
    m.def("trace_paths", &trace, py::arg("geometry"), py::arg("models"), py::arg("parameters"),
          py::arg("sampling_parameters"), py::arg("emission"), py::arg("lights"),
          py::arg("textures"), py::arg("sampling_textures"), py::arg("media"),
          py::arg("sampling_media"), py::arg("camera"), py::arg("options"), py::arg("first"),
          py::arg("count"), py::arg("radiance"), py::arg("squares"), py::arg("hits") = py::none(),
          "Adds samples to radiance (H, W, 3) and squares (H, W, 3), float64. options: (strategy, "
          "heuristic, max_depth, roulette_from, sampler, seed).\nmedia: (phase function or \"\", "
          "parameters (P,), densities (X, Y, Z) or None, sigma_maj). hits: None, or (H, W) "
          "float64,\nto which the number of samples is added that see more than the background; "
          "the others then add nothing.");
    bind_adjoints(m);
    with_scene_names([&](auto... scene) {
        m.def("trace_path", of_scene(&path_rows), scene..., py::arg("camera"), py::arg("options"),
              py::arg("pixel"), py::arg("sample"), "One path, a dictionary a vertex.");
    });
    m.def("ambient_occlusion", &ambient_occlusion, py::arg("geometry"), py::arg("camera"),
          py::arg("radius"), py::arg("seed"), py::arg("first"), py::arg("count"), py::arg("sums"),
          "Adds the free part of each sample to sums (H, W), float64.");
}

}  // namespace photograd
