// Path tracing: scenes of shapes and materials, pictures, derivatives, single paths.
#include <optional>

#include "camera_args.h"
#include "derivative_arrays.h"
#include "module.h"
#include "path_args.h"
#include "photograd/render/ambient_occlusion.h"
#include "photograd/render/path.h"
#include "photograd/render/path_pairs.h"
#include "photograd/render/volume_path.h"
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

void trace(const PathGeometry& geometry, const std::vector<std::string>& models,
           const py::array& parameters, const std::optional<py::array>& sampling_parameters,
           const py::array& emission, const LightTuples& lights,
           const std::vector<py::array>& textures,
           const std::optional<std::vector<py::array>>& sampling_textures,
           const std::vector<MediumTuple>& media,
           const std::optional<std::vector<MediumTuple>>& sampling_media,
           const py::tuple& camera_numbers, const Options& given, std::uint32_t first,
           std::uint32_t count, py::array radiance, py::array squares) {
    dispatch_real("trace_paths", "parameters", parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("trace_paths");
        const SceneNumbers<R> numbers(args, geometry, models, parameters, sampling_parameters,
                                      emission, lights, textures, sampling_textures, media,
                                      sampling_media);
        const ThinLens camera = thin_lens(camera_numbers);
        const PathSums sums = path_sums(args, camera, radiance, squares);
        const PathOptions options = options_of(args, given);
        const py::gil_scoped_release release;
        trace_paths(numbers.scene, camera, options, {first, count}, sums);
    });
}

void trace_backward(const PathGeometry& geometry, const std::vector<std::string>& models,
                    const py::array& parameters, const py::array& emission,
                    const LightTuples& lights, const std::vector<py::array>& textures,
                    const std::vector<MediumTuple>& media, const py::tuple& camera_numbers,
                    const Options& given, std::uint32_t spp, const std::optional<py::array>& counts,
                    const py::array& d_image, py::array d_parameters, py::array d_emission,
                    std::vector<py::array> d_lights, std::vector<py::array> d_textures,
                    std::vector<py::array> d_media,
                    std::vector<std::optional<py::array>> d_densities) {
    dispatch_real("trace_paths_backward", "parameters", parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("trace_paths_backward");
        const SceneNumbers<R> numbers(args, geometry, models, parameters, std::nullopt, emission,
                                      lights, textures, std::nullopt, media, std::nullopt);
        const ThinLens camera = thin_lens(camera_numbers);
        const double* d = args.in<double>("d_image", d_image, picture_axes(camera) + " 3");
        const DerivativeArrays<R> out(args, geometry, numbers, lights, d_parameters, d_emission,
                                      d_lights, d_textures, d_media, d_densities);
        const PathOptions options = options_of(args, given);
        const std::uint32_t* own = sample_counts(args, spp, counts, camera);
        const py::gil_scoped_release release;
        trace_paths_backward(numbers.scene, camera, options, spp, own, d, out.spans());
    });
}

void trace_pairs(const PathGeometry& geometry, const std::vector<std::string>& models,
                 const py::array& parameters, const py::array& emission, const LightTuples& lights,
                 const std::vector<py::array>& textures, const std::vector<MediumTuple>& media,
                 const py::tuple& camera_numbers, const Options& given, std::uint64_t other_seed,
                 std::uint32_t spp, const std::optional<py::array>& counts, const py::array& target,
                 const py::array& weight, py::array pictures, py::array d_parameters,
                 py::array d_emission, std::vector<py::array> d_lights,
                 std::vector<py::array> d_textures, std::vector<py::array> d_media,
                 std::vector<std::optional<py::array>> d_densities) {
    dispatch_real("trace_pairs_backward", "parameters", parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("trace_pairs_backward");
        const SceneNumbers<R> numbers(args, geometry, models, parameters, std::nullopt, emission,
                                      lights, textures, std::nullopt, media, std::nullopt);
        const ThinLens camera = thin_lens(camera_numbers);
        const std::string axes = picture_axes(camera) + " 3";
        const SquaredError loss{args.in<double>("target", target, axes),
                                args.in<double>("weight", weight, axes)};
        double* both = args.out<double>("pictures", pictures, "2 " + axes);
        const DerivativeArrays<R> out(args, geometry, numbers, lights, d_parameters, d_emission,
                                      d_lights, d_textures, d_media, d_densities);
        const PathOptions options = options_of(args, given);
        const std::uint32_t* own = sample_counts(args, spp, counts, camera);
        const py::gil_scoped_release release;
        trace_pairs_backward(numbers.scene, camera, options, {options.seed, other_seed}, spp, own,
                             loss, out.spans(), both);
    });
}

py::list colors(const Vec3<double>& v) {
    py::list out;
    for (int c = 0; c < 3; ++c) out.append(v[c]);
    return out;
}

py::dict vertex_row(const PathVertex<double>& v) {
    py::dict row;
    row["shape"] = v.shape;
    row["direction"] = colors(v.direction);
    row["emitted"] = colors(v.emitted);
    row["emission_weight"] = v.emission_weight;
    row["pdf"] = v.pdf;
    row["light_pdf"] = v.light_pdf;
    row["light_shape"] = v.light.shape;
    row["light_listed"] = v.light.listed;
    row["light_direction"] = colors(v.light.direction);
    row["light_f"] = colors(v.light.f);
    row["light_emitted"] = colors(v.light.weight > 0 ? v.light.sent : Vec3<double>(0));
    row["light_weight"] = v.light.weight;
    row["light_cosine"] = std::abs(v.light.wi.z);
    row["light_chosen_pdf"] = v.light.pdf;
    row["light_scatter_pdf"] = v.light.scatter_pdf;
    row["wo"] = colors(v.wo);
    row["wi"] = colors(v.wi);
    row["value"] = colors(v.value);
    row["lobe"] = v.lobe;
    row["passed"] = v.passed;
    row["coverage"] = v.coverage;
    row["coverage_slope"] = v.coverage_slope;
    row["light_through"] = v.light.through;
    row["weight"] = v.weight;
    row["survival"] = v.survival;
    return row;
}

/// (medium, kind, length, position, value) of each step of a product.
py::list step_rows(const MediaTrail<double>& trail, const StepProduct<double>& product) {
    py::list out;
    for (std::int32_t i = product.first; i < product.last; ++i) {
        const MediumStep<double>& step = trail.steps[static_cast<std::size_t>(i)];
        out.append(py::make_tuple(step.medium, static_cast<int>(step.kind), step.length,
                                  colors(step.position), colors(step.value)));
    }
    return out;
}

/// One path as a list of dictionaries, double precision.
py::list path(const PathGeometry& geometry, const std::vector<std::string>& models,
              const py::array& parameters, const py::array& emission, const LightTuples& lights,
              const std::vector<py::array>& textures, const std::vector<MediumTuple>& media,
              const py::tuple& camera_numbers, const Options& given, std::uint32_t pixel,
              std::uint32_t sample) {
    ArrayArgs args("trace_path");
    const SceneNumbers<double> numbers(args, geometry, models, parameters, std::nullopt, emission,
                                       lights, textures, std::nullopt, media, std::nullopt);
    const ThinLens camera = thin_lens(camera_numbers);
    const PathOptions options = options_of(args, given);
    py::list out;
    if (!geometry.media.any()) {
        for (const auto& v : trace_path(numbers.scene, camera, options, pixel, sample))
            out.append(vertex_row(v));
        return out;
    }
    const auto found = trace_volume_path(numbers.scene, camera, options, pixel, sample);
    for (std::size_t k = 0; k < found.path.size(); ++k) {
        const MediumVertex<double>& m = found.trail.vertices[k];
        py::dict row = vertex_row(found.path[k]);
        row["medium"] = m.medium;
        row["chance"] = colors(m.chance);
        row["segment_weight"] = m.weight;
        row["steps"] = step_rows(found.trail, m.arrival);
        row["shadow_steps"] = step_rows(found.trail, m.shadow);
        out.append(row);
    }
    return out;
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
             "((X, Y, Z), box_from_world (3, 4) float64) or None.");
    m.def("trace_paths", &trace, py::arg("geometry"), py::arg("models"), py::arg("parameters"),
          py::arg("sampling_parameters"), py::arg("emission"), py::arg("lights"),
          py::arg("textures"), py::arg("sampling_textures"), py::arg("media"),
          py::arg("sampling_media"), py::arg("camera"), py::arg("options"), py::arg("first"),
          py::arg("count"), py::arg("radiance"), py::arg("squares"),
          "Adds samples to radiance (H, W, 3) and squares (H, W, 3), float64. options: (strategy, "
          "heuristic, max_depth, roulette_from, sampler, seed).\nmedia: (phase function or \"\", "
          "parameters (P,), densities (X, Y, Z) or None, sigma_maj).");
    m.def("trace_paths_backward", &trace_backward, py::arg("geometry"), py::arg("models"),
          py::arg("parameters"), py::arg("emission"), py::arg("lights"), py::arg("textures"),
          py::arg("media"), py::arg("camera"), py::arg("options"), py::arg("spp"),
          py::arg("counts"), py::arg("d_image"), py::arg("d_parameters"), py::arg("d_emission"),
          py::arg("d_lights"), py::arg("d_textures"), py::arg("d_media"), py::arg("d_densities"),
          "Adds to d_parameters (P,), d_emission (S, 3), d_lights, an array like the first of each "
          "light, d_textures, d_media (rows) and d_densities (grids or None) for dL/d(mean "
          "radiance). counts (H, W) uint32, or None: spp samples of each pixel.");
    m.def("trace_pairs_backward", &trace_pairs, py::arg("geometry"), py::arg("models"),
          py::arg("parameters"), py::arg("emission"), py::arg("lights"), py::arg("textures"),
          py::arg("media"), py::arg("camera"), py::arg("options"), py::arg("other_seed"),
          py::arg("spp"), py::arg("counts"), py::arg("target"), py::arg("weight"),
          py::arg("pictures"), py::arg("d_parameters"), py::arg("d_emission"), py::arg("d_lights"),
          py::arg("d_textures"), py::arg("d_media"), py::arg("d_densities"),
          "As trace_paths_backward, for the loss sum weight (mean radiance - target)^2, both "
          "(H, W, 3) float64, by two\npictures with paths of their own, of the seed in options and "
          "of other_seed, written to pictures\n(2, H, W, 3) float64.");
    m.def("trace_path", &path, py::arg("geometry"), py::arg("models"), py::arg("parameters"),
          py::arg("emission"), py::arg("lights"), py::arg("textures"), py::arg("media"),
          py::arg("camera"), py::arg("options"), py::arg("pixel"), py::arg("sample"),
          "One path, a dictionary a vertex.");
    m.def("ambient_occlusion", &ambient_occlusion, py::arg("geometry"), py::arg("camera"),
          py::arg("radius"), py::arg("seed"), py::arg("first"), py::arg("count"), py::arg("sums"),
          "Adds the free part of each sample to sums (H, W), float64.");
}

}  // namespace photograd
