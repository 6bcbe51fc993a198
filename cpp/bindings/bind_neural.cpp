// Radiance fields by networks; photograd.fields.neural is the typed face.
#include "march_args.h"
#include "module.h"
#include "network_args.h"
#include "photograd/field/neural_field.h"
#include "photograd/render/march/kept_samples.h"

namespace photograd {
namespace {

using NeuralArrays =
    Arrays<3>;  // table (rows, F) or (0, 1), density and color network's parameters

/// What a neural field is made of besides its parameters.
struct NeuralSettings {
    std::optional<HashSettings> hash;
    int octaves;
    PerceptronShape density, color;

    [[nodiscard]] int encoded() const {
        if (hash) return static_cast<int>(hash->levels.size()) * hash->features;
        return FrequencyEncoding{3, octaves}.features();
    }
};

NeuralSettings neural_settings(const std::optional<HashSettings>& hash, int octaves,
                               const PerceptronShape& density, const PerceptronShape& color) {
    NeuralSettings s{hash, octaves, density, color};
    const ArrayArgs args("NeuralSettings");
    const int given = density.outputs() - 1 + NeuralField<float>::sh_numbers;
    if (hash && hash->dimensions != 3)
        args.range("hash", "3 dimensions", std::to_string(hash->dimensions));
    if (octaves < 0 || octaves > 24) args.range("octaves", "0 to 24", std::to_string(octaves));
    if (density.inputs != s.encoded())
        args.range("density", std::to_string(s.encoded()) + " inputs, as the encoding gives",
                   std::to_string(density.inputs));
    if (color.inputs != given || color.outputs() != 3)
        args.range("color", std::to_string(given) + " inputs and 3 outputs",
                   std::to_string(color.inputs) + " and " + std::to_string(color.outputs()));
    return s;
}

/// What a forward pass leaves for its backward pass, of either type of numbers.
struct NeuralSamples {
    std::tuple<KeptSamples<float>, KeptSamples<double>> kept;

    template <class R>
    KeptSamples<R>& of() {
        return std::get<KeptSamples<R>>(kept);
    }
};
using Samples = std::optional<std::shared_ptr<NeuralSamples>>;

/// use(field) with the field over `parameters`.
template <class R, class Use>
void with_neural(ArrayArgs& args, const NeuralSettings& s, const NeuralArrays& parameters,
                 const std::optional<py::array>& occupancy, const FieldOptions& options,
                 Use&& use) {
    const R* table = s.hash ? args.in<R>("table", parameters[0], s.hash->table_axes()) : nullptr;
    const R* density = network_parameters<R>(args, "density", s.density, parameters[1]);
    const R* color = network_parameters<R>(args, "color", s.color, parameters[2]);
    Occupancy cells;
    if (occupancy) {
        cells.cells = args.in<std::uint8_t>("occupancy", *occupancy, "K K K");
        cells.resolution = static_cast<int>(args.size("K"));
    }
    std::optional<HashEncoding<R, 3>> hash;
    if (s.hash) hash.emplace(s.hash->levels, s.hash->features, s.hash->smoothstep);
    use(NeuralField<R>{hash ? &*hash : nullptr,
                       {3, s.octaves},
                       table,
                       Network<R>(s.density, density),
                       Network<R>(s.color, color),
                       cells,
                       options});
}

using PlacedArrays = std::optional<Arrays<2>>;  // t (R, N), width (R, N)

template <class R>
PlacedSamples<R> placed_samples(ArrayArgs& args, const PlacedArrays& from,
                                const RayBatch<R>& rays) {
    if (!from) return {};
    PlacedSamples<R> placed{args.within<R>("t", (*from)[0], "R N", world_limit),
                            args.within<R>("width", (*from)[1], "R N", world_limit),
                            args.size("N")};
    for (std::int64_t ray = 0; ray < rays.count; ++ray)
        if (rays.samples[ray] > placed.stride)
            args.range("samples", "at most " + std::to_string(placed.stride) + " of a ray",
                       std::to_string(rays.samples[ray]) + " in row " + std::to_string(ray));
    return placed;
}

py::tuple march_neural(const NeuralSettings& s, const NeuralArrays& parameters,
                       const std::optional<py::array>& occupancy, const MarchSettings& settings,
                       const RayArrays& ray_arrays, const Samples& keep,
                       const PlacedArrays& placed_arrays) {
    return dispatch_real(
        "march_neural", "density", parameters[1], [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
            const PlacedSamples<R> placed = placed_samples(args, placed_arrays, rays);
            py::tuple image;
            with_neural<R>(args, s, parameters, occupancy, settings.field, [&](const auto& field) {
                image =
                    filled_image<R, MarchOutputs<R>>({rays.count}, [&](const MarchOutputs<R>& out) {
                        KeptSamples<R> none;
                        KeptSamples<R>& kept = keep ? (*keep)->of<R>() : none;
                        if (keep) kept.start(field, rays);
                        march_by<NeuralField<R>>(
                            [&](std::int64_t chunk) { return kept.keeping(field, chunk); }, rays,
                            settings.march, out, placed);
                    });
            });
            return image;
        });
}

void march_neural_backward(const NeuralSettings& s, const NeuralArrays& parameters,
                           const std::optional<py::array>& occupancy, const MarchSettings& settings,
                           const RayArrays& ray_arrays, const Arrays<3>& outputs,
                           const Arrays<3>& d_outputs, NeuralArrays d_parameters,
                           const std::optional<Arrays<2>>& d_rays, const Samples& kept,
                           const PlacedArrays& placed_arrays) {
    dispatch_real(
        "march_neural_backward", "density", parameters[1], [&](auto real, ArrayArgs& args) {
            using R = decltype(real);
            const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
            const PlacedSamples<R> placed = placed_samples(args, placed_arrays, rays);
            MarchAdjoint<R> adjoint;
            const auto out =
                MarchCotangentArrays{outputs, d_outputs, d_rays}.read<R>(args, adjoint);
            R* d_table =
                s.hash ? args.out<R>("d_table", d_parameters[0], s.hash->table_axes()) : nullptr;
            R* d_density =
                args.out<R>("d_density", d_parameters[1], std::to_string(s.density.parameters()));
            R* d_color =
                args.out<R>("d_color", d_parameters[2], std::to_string(s.color.parameters()));
            with_neural<R>(args, s, parameters, occupancy, settings.field, [&](const auto& field) {
                typename NeuralField<R>::Sink sink(field, d_table, d_density, d_color);
                const py::gil_scoped_release release;
                const KeptSamples<R> none;
                const KeptSamples<R>& found = kept ? (*kept)->of<R>() : none;
                march_backward_by([&](std::int64_t chunk) { return found.replay(field, chunk); },
                                  field, rays, settings.march, out, adjoint, sink, placed);
            });
        });
}

void neural_densities(const NeuralSettings& s, const NeuralArrays& parameters,
                      const MarchSettings& settings, const py::array& points, py::array sigma_t) {
    dispatch_real("neural_densities", "density", parameters[1], [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* p = args.in<R>("points", points, "N 3");
        R* out = args.out<R>("sigma_t", sigma_t, "N");
        with_neural<R>(args, s, parameters, std::nullopt, settings.field, [&](const auto& field) {
            const py::gil_scoped_release release;
            field.densities(p, args.size("N"), out);
        });
    });
}

}  // namespace

void bind_neural(py::module_& m) {
    py::class_<NeuralSettings>(m, "NeuralSettings")
        .def(py::init(&neural_settings), py::arg("hash"), py::arg("octaves"), py::arg("density"),
             py::arg("color"));
    py::class_<NeuralSamples, std::shared_ptr<NeuralSamples>>(
        m, "NeuralSamples", "What march_neural keeps of its samples for march_neural_backward.")
        .def(py::init<>());
    m.attr("neural_direction_numbers") = NeuralField<float>::sh_numbers;
    m.def("march_neural", &march_neural, py::arg("settings"), py::arg("parameters"),
          py::arg("occupancy"), py::arg("march"), py::arg("rays"), py::arg("keep") = py::none(),
          py::arg("placed") = py::none(),
          "(color, transmittance, depth) of rays through a field of networks. parameters: table, "
          "density network, color network; occupancy (K, K, K) uint8, z y x, or None. "
          "Samples are written to keep unless None; placed: their t and width (R, N), or None.");
    m.def("march_neural_backward", &march_neural_backward, py::arg("settings"),
          py::arg("parameters"), py::arg("occupancy"), py::arg("march"), py::arg("rays"),
          py::arg("outputs"), py::arg("d_outputs"), py::arg("d_parameters"), py::arg("d_rays"),
          py::arg("kept") = py::none(), py::arg("placed") = py::none(),
          "Adds to d_parameters, and to d_rays unless None. kept: of the forward pass, or None.");
    m.def("neural_densities", &neural_densities, py::arg("settings"), py::arg("parameters"),
          py::arg("march"), py::arg("points"), py::arg("sigma_t"),
          "Writes extinctions (N,), 1/m, at points (N, 3) of the unit cube.");
}

}  // namespace photograd
