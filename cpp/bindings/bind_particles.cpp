// Particles from lights: emission, irradiance of a rectangle, photon maps. And textures that are
// baked.
#include "module.h"

#include <memory>

#include "bake_calls.h"
#include "camera_args.h"
#include "model_args.h"
#include "photograd/render/light/irradiance_sensor.h"
#include "photograd/render/light/photon_map.h"
#include "scene_calls.h"

namespace photograd {
namespace {

/// (max_depth, roulette_from, seed)
using ParticleNumbers = std::tuple<int, int, std::uint64_t>;

ParticleOptions particles_of(const ArrayArgs& args, const PathGeometry& geometry,
                             const ParticleNumbers& given) {
    const auto [max_depth, roulette_from, seed] = given;
    if (max_depth < 1 || max_depth > 4096)
        args.range("max_depth", "1 to 4096 segments", std::to_string(max_depth));
    if (roulette_from < 0) args.range("roulette_from", "at least 0", std::to_string(roulette_from));
    if (geometry.lights.empty()) args.range("scene", "a scene with lights", "one without");
    return {max_depth, roulette_from, seed};
}

/// Fewer than 2^31: rows and photons are numbered with 32 bits.
void check_count(const ArrayArgs& args, std::uint64_t count) {
    constexpr std::uint64_t most = (std::uint64_t{1} << 31) - 1;
    if (count < 1 || count > most)
        args.range("count", "1 to " + std::to_string(most) + " particles", std::to_string(count));
}

/// origins, directions and flux (N, 3), entries of the table of lights (N,).
py::tuple emit_rows(const SceneRows& scene, std::uint64_t seed, std::uint64_t first,
                    std::uint64_t count) {
    ArrayArgs args("emit_particles");
    const SceneNumbers<double> at(args, scene);
    particles_of(args, scene.geometry, {1, 0, seed});
    check_count(args, count);
    const auto rows = static_cast<std::int64_t>(count);
    py::array_t<double> origins({rows, std::int64_t(3)}), directions({rows, std::int64_t(3)}),
        flux({rows, std::int64_t(3)});
    py::array_t<std::int64_t> entries(rows);
    double *o = origins.mutable_data(), *d = directions.mutable_data(), *f = flux.mutable_data();
    std::int64_t* e = entries.mutable_data();
    for (std::int64_t n = 0; n < rows; ++n) {
        const Particle one = emitted_particle(at.scene, seed, first + std::uint64_t(n));
        put_vec3(o, n, one.origin);
        put_vec3(d, n, one.direction);
        put_vec3(f, n, one.flux);
        e[n] = one.entry;
    }
    return py::make_tuple(origins, directions, flux, entries);
}

void sense(const SceneRows& scene, const ParticleNumbers& given, std::uint64_t first,
           std::uint64_t count, const py::array& rectangle, py::array irradiance,
           py::array squares) {
    ArrayArgs args("trace_light");
    const SceneNumbers<double> at(args, scene);
    const ParticleOptions options = particles_of(args, scene.geometry, given);
    const double* r = args.within<double>("rectangle", rectangle, "3 3", world_limit);
    const PathSums sums{args.out<double>("irradiance", irradiance, "H W 3"),
                        args.out<double>("squares", squares, "H W 3")};
    const IrradianceSensor sensor{vec3_at(r, 0), vec3_at(r, 1), vec3_at(r, 2), args.size("H"),
                                  args.size("W")};
    const py::gil_scoped_release release;
    trace_irradiance(at.scene, options, {first, count}, sensor, sums);
}

std::unique_ptr<PhotonMap> gather_photons(const SceneRows& scene, const ParticleNumbers& given,
                                          std::uint64_t count, double radius, bool direct) {
    ArrayArgs args("PhotonMap");
    const SceneNumbers<double> at(args, scene);
    const ParticleOptions options = particles_of(args, scene.geometry, given);
    check_count(args, count);
    if (!(radius >= 1 / world_limit && radius <= world_limit))
        args.range("radius", "above 0 m, and finite", number_text(radius));
    const py::gil_scoped_release release;
    return std::make_unique<PhotonMap>(at.scene, options, count, radius, direct);
}

py::array irradiance_rows(const PhotonMap& map, const py::array& points, const py::array& normals) {
    ArrayArgs args("PhotonMap.irradiance");
    const double *x = args.within<double>("points", points, "N 3", world_limit),
                 *n = args.finite<double>("normals", normals, "N 3");
    return vector_rows<double>(
        args, [&](std::int64_t i) { return map.irradiance(vec3_at(x, i), vec3_at(n, i)); });
}

void picture(const SceneRows& scene, const PhotonMap& map, const py::tuple& camera_numbers,
             const Options& given, std::uint32_t first, std::uint32_t count, py::array radiance,
             py::array squares) {
    ArrayArgs args("trace_photons");
    const SceneNumbers<double> at(args, scene);
    const ThinLens camera = thin_lens(camera_numbers);
    const PathSums sums = path_sums(args, camera, radiance, squares);
    const PathOptions options = options_of(args, given);
    check_samples(args, first, count);
    const py::gil_scoped_release release;
    trace_photons(at.scene, map, camera, options, {first, count}, sums);
}

}  // namespace

void bind_particles(py::module_& m) {
    bind_bake(m);
    with_scene_names([&](auto... scene) {
        m.def("emit_particles", of_scene(&emit_rows), scene..., py::arg("seed"), py::arg("first"),
              py::arg("count"),
              "(origins (N, 3), directions (N, 3), flux (N, 3) W, entries (N,) of the table of "
              "lights) of particles\nas they leave their lights.");
        m.def("trace_light", of_scene(&sense), scene..., py::arg("options"), py::arg("first"),
              py::arg("count"), py::arg("rectangle"), py::arg("irradiance"), py::arg("squares"),
              "Adds what particles bring to a rectangle (corner, edge_x, edge_y) (3, 3) to "
              "irradiance (H, W, 3),\nand its squares, float64. options: (max_depth, "
              "roulette_from, seed).");
        py::class_<PhotonMap>(m, "PhotonMap", "Particles where they have hit surfaces.")
            .def(py::init(of_scene(&gather_photons)), scene..., py::arg("options"),
                 py::arg("count"), py::arg("radius"), py::arg("direct"))
            .def("__len__", [](const PhotonMap& map) { return map.photons().size(); })
            .def("irradiance", &irradiance_rows, py::arg("points"), py::arg("normals"),
                 "(N, 3) W/m^2 at points (N, 3) with geometric normals (N, 3), float64.");
        m.def("trace_photons", of_scene(&picture), scene..., py::arg("map"), py::arg("camera"),
              py::arg("options"), py::arg("first"), py::arg("count"), py::arg("radiance"),
              py::arg("squares"), "Adds samples of a picture, as trace_paths does.");
    });
}

}  // namespace photograd
