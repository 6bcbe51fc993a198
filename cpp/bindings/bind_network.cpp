// Multilayer perceptrons and input encodings; photograd.network is the typed face.

#include "module.h"
#include "network_args.h"
#include "photograd/network/batch.h"
#include "photograd/network/frequency_encoding.h"
#include "photograd/network/hash_encoding.h"
#include "photograd/network/one_blob_encoding.h"
#include "sample_args.h"

namespace photograd {
namespace {

constexpr int most_width = 1024, most_layers = 64, most_levels = 32,
              most_features = HashEncoding<float, 3>::max_features;
constexpr int most_octaves = 24, most_bins = 256, most_log2_rows = 24, most_resolution = 1 << 20;

/// Throws RangeError unless least <= got <= most.
void require(const char* function, const char* argument, std::int64_t got, std::int64_t least,
             std::int64_t most) {
    if (got < least || got > most)
        fail(ErrorKind::range, function, argument,
             std::to_string(least) + " to " + std::to_string(most), std::to_string(got));
}

PerceptronShape shape_of(int inputs, const std::vector<int>& widths, int hidden, int output,
                         int skip) {
    constexpr const char* name = "PerceptronShape";
    require(name, "inputs", inputs, 1, most_width);
    require(name, "widths", static_cast<int>(widths.size()), 1, most_layers);
    for (const int width : widths) require(name, "widths", width, 1, most_width);
    require(name, "hidden", hidden, 0, static_cast<int>(Activation::sigmoid));
    require(name, "output", output, 0, static_cast<int>(Activation::sigmoid));
    require(name, "skip", skip, 0, static_cast<int>(widths.size()) - 1);
    return {inputs, widths, static_cast<Activation>(hidden), static_cast<Activation>(output), skip};
}

/// Refuses values of layers that the kernel does not fill.
template <class R>
void check_values(const ArrayArgs& args, bool fused, const PerceptronValues* values) {
    if (values && !(fused && std::is_same_v<R, float>))
        args.range("values", "none, unless the kernel runs in float32", "some");
}

void layers_forward(const PerceptronShape& shape, const py::array& parameters,
                    const py::array& inputs, py::array outputs, bool fused,
                    std::optional<PerceptronValues*> kept) {
    PerceptronValues* values = kept.value_or(nullptr);
    dispatch_real("perceptron_forward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        check_values<R>(args, fused, values);
        const R* p = network_parameters<R>(args, "parameters", shape, parameters);
        const R* in = args.in<R>("inputs", inputs, "N " + std::to_string(shape.inputs));
        R* out = args.out<R>("outputs", outputs, "N " + std::to_string(shape.outputs()));
        const py::gil_scoped_release release;
        perceptron_forward<R>(shape, p, args.size("N"), in, out, !fused, values);
    });
}

void layers_backward(const PerceptronShape& shape, const py::array& parameters,
                     const py::array& inputs, const py::array& d_outputs, py::array d_parameters,
                     std::optional<py::array> d_inputs, bool fused,
                     std::optional<PerceptronValues*> kept) {
    PerceptronValues* values = kept.value_or(nullptr);
    dispatch_real("perceptron_backward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        check_values<R>(args, fused, values);
        const R* p = network_parameters<R>(args, "parameters", shape, parameters);
        const std::string in_axes = "N " + std::to_string(shape.inputs);
        const R* in = args.in<R>("inputs", inputs, in_axes);
        const R* d_out = args.in<R>("d_outputs", d_outputs, "N " + std::to_string(shape.outputs()));
        R* d_p = args.out<R>("d_parameters", d_parameters, std::to_string(shape.parameters()));
        R* d_in = d_inputs ? args.out<R>("d_inputs", *d_inputs, in_axes) : nullptr;
        const std::int64_t samples = args.size("N");
        if (values && (values->samples != samples || values->parameters != shape.parameters()))
            args.range("values", "those of forward at these " + std::to_string(samples) + " inputs",
                       "values of " + std::to_string(values->samples) + " inputs");
        const py::gil_scoped_release release;
        perceptron_backward<R>(shape, p, samples, in, d_out, d_p, d_in, !fused, values);
    });
}

std::span<const std::int64_t> offset_of(const SampleRows& rows) {
    return {rows.offset, static_cast<std::size_t>(rows.rays) + 1};
}
template <class R>
const R* parameters_of(ArrayArgs& args, const PerceptronShape& shape, const SampleRows& rows,
                       const py::array& array) {
    const std::string axes = std::to_string(rows.rays) + " " + std::to_string(shape.parameters());
    return args.in<R>("parameters", array, axes);
}

void networks_forward(const PerceptronShape& shape, const py::array& parameters,
                      const py::array& offset, const py::array& inputs, py::array outputs) {
    dispatch_real("perceptrons_forward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* in = args.in<R>("inputs", inputs, "M " + std::to_string(shape.inputs));
        const SampleRows rows = sample_rows(args, offset);
        const R* p = parameters_of<R>(args, shape, rows, parameters);
        R* out = args.out<R>("outputs", outputs, "M " + std::to_string(shape.outputs()));
        const py::gil_scoped_release release;
        perceptrons_forward<R>(shape, p, offset_of(rows), in, out);
    });
}

void networks_backward(const PerceptronShape& shape, const py::array& parameters,
                       const py::array& offset, const py::array& inputs, const py::array& d_outputs,
                       py::array d_parameters, py::array d_inputs) {
    dispatch_real(
        "perceptrons_backward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
            using R = decltype(real);
            const std::string in_axes = "M " + std::to_string(shape.inputs);
            const R* in = args.in<R>("inputs", inputs, in_axes);
            const SampleRows rows = sample_rows(args, offset);
            const R* p = parameters_of<R>(args, shape, rows, parameters);
            const R* d_out =
                args.in<R>("d_outputs", d_outputs, "M " + std::to_string(shape.outputs()));
            R* d_p =
                args.out<R>("d_parameters", d_parameters,
                            std::to_string(rows.rays) + " " + std::to_string(shape.parameters()));
            R* d_in = args.out<R>("d_inputs", d_inputs, in_axes);
            const py::gil_scoped_release release;
            perceptrons_backward<R>(shape, p, offset_of(rows), in, d_out, d_p, d_in);
        });
}

HashSettings hash_settings(int dimensions, const std::vector<std::int32_t>& resolutions,
                           int log2_rows, int features, bool smoothstep) {
    constexpr const char* name = "HashSettings";
    require(name, "dimensions", dimensions, 2, 3);
    require(name, "resolutions", static_cast<int>(resolutions.size()), 1, most_levels);
    for (const std::int32_t n : resolutions) require(name, "resolutions", n, 1, most_resolution);
    require(name, "log2_rows", log2_rows, 1, most_log2_rows);
    require(name, "features", features, 1, most_features);
    return {hash_levels(resolutions, dimensions, log2_rows), dimensions, features, smoothstep};
}

/// use(encoding, table, points) with arrays that fit `settings`.
template <class Use>
void with_hash(const char* function, const HashSettings& settings, const py::array& table,
               const py::array& points, Use&& use) {
    dispatch_real(function, "table", table, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* t = args.in<R>("table", table, settings.table_axes());
        const R* p = args.in<R>("points", points, "N " + std::to_string(settings.dimensions));
        if (settings.dimensions == 2)
            use(HashEncoding<R, 2>(settings.levels, settings.features, settings.smoothstep), args,
                t, p);
        else
            use(HashEncoding<R, 3>(settings.levels, settings.features, settings.smoothstep), args,
                t, p);
    });
}

std::string features_axes(const HashSettings& settings) {
    return "N " +
           std::to_string(settings.levels.size() * static_cast<std::size_t>(settings.features));
}

void encode_hash(const HashSettings& settings, const py::array& table, const py::array& points,
                 py::array features) {
    with_hash("hash_encode", settings, table, points,
              [&]<class R, int D>(const HashEncoding<R, D>& encoding, ArrayArgs& args, const R* t,
                                  const R* p) {
                  R* out = args.out<R>("features", features, features_axes(settings));
                  const py::gil_scoped_release release;
                  hash_encode<R, D>(encoding, t, p, args.size("N"), out);
              });
}

void encode_hash_backward(const HashSettings& settings, const py::array& table,
                          const py::array& points, const py::array& d_features, py::array d_table,
                          std::optional<py::array> d_points) {
    with_hash("hash_encode_backward", settings, table, points,
              [&]<class R, int D>(const HashEncoding<R, D>& encoding, ArrayArgs& args, const R* t,
                                  const R* p) {
                  const R* d_out = args.in<R>("d_features", d_features, features_axes(settings));
                  R* d_t = args.out<R>("d_table", d_table, settings.table_axes());
                  R* d_p = d_points ? args.out<R>("d_points", *d_points, "N " + std::to_string(D))
                                    : nullptr;
                  const py::gil_scoped_release release;
                  hash_encode_backward<R, D>(encoding, t, p, args.size("N"), d_out, d_t, d_p);
              });
}

/// An encoding without parameters, number by number, of points (N, D).
template <class Encoding>
void encode_points(const char* function, const Encoding& e, const py::array& points,
                   py::array features) {
    dispatch_real(function, "points", points, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* p = args.in<R>("points", points, "N " + std::to_string(e.dimensions));
        R* out = args.out<R>("features", features, "N " + std::to_string(e.features()));
        const std::int64_t count = args.size("N"), piece = 1024;
        const py::gil_scoped_release release;
        parallel_for((count + piece - 1) / piece, [&](std::int64_t k) {
            for (std::int64_t s = k * piece; s < std::min(count, (k + 1) * piece); ++s)
                e.encode(p + s * e.dimensions, 1, out + s * e.features());
        });
    });
}
template <class Encoding>
void encode_points_backward(const char* function, const Encoding& e, const py::array& points,
                            const py::array& d_features, py::array d_points) {
    dispatch_real(function, "points", points, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* p = args.in<R>("points", points, "N " + std::to_string(e.dimensions));
        const R* d_out = args.in<R>("d_features", d_features, "N " + std::to_string(e.features()));
        R* d_p = args.out<R>("d_points", d_points, "N " + std::to_string(e.dimensions));
        const std::int64_t count = args.size("N"), piece = 1024;
        const py::gil_scoped_release release;
        parallel_for((count + piece - 1) / piece, [&](std::int64_t k) {
            for (std::int64_t s = k * piece; s < std::min(count, (k + 1) * piece); ++s)
                e.backward(p + s * e.dimensions, 1, d_out + s * e.features(),
                           d_p + s * e.dimensions);
        });
    });
}

FrequencyEncoding frequencies(const py::array& points, int octaves) {
    require("frequency_encode", "octaves", octaves, 0, most_octaves);
    return {points.ndim() == 2 ? static_cast<int>(points.shape(1)) : 1, octaves};
}
OneBlobEncoding one_blob(const py::array& points, int bins) {
    require("one_blob_encode", "bins", bins, 1, most_bins);
    return {points.ndim() == 2 ? static_cast<int>(points.shape(1)) : 1, bins};
}

void bind_encodings(py::module_& m) {
    py::class_<HashSettings>(m, "HashSettings")
        .def(py::init(&hash_settings), py::arg("dimensions"), py::arg("resolutions"),
             py::arg("log2_rows"), py::arg("features"), py::arg("smoothstep"))
        .def_property_readonly("rows", &HashSettings::rows)
        .def_property_readonly("levels", [](const HashSettings& s) {
            std::vector<std::tuple<int, std::int64_t, std::int64_t, bool>> levels;
            for (const HashLevel& l : s.levels)
                levels.emplace_back(l.resolution, l.first, l.rows, l.dense);
            return levels;
        });
    m.def("hash_encode", &encode_hash, py::arg("settings"), py::arg("table"), py::arg("points"),
          py::arg("features"), "Writes features (N, levels F) of points (N, D) in the unit cube.");
    m.def("hash_encode_backward", &encode_hash_backward, py::arg("settings"), py::arg("table"),
          py::arg("points"), py::arg("d_features"), py::arg("d_table"), py::arg("d_points"),
          "Adds to d_table, and to d_points unless None.");
    m.def(
        "frequency_encode",
        [](const py::array& points, int octaves, py::array features) {
            encode_points("frequency_encode", frequencies(points, octaves), points, features);
        },
        py::arg("points"), py::arg("octaves"), py::arg("features"));
    m.def(
        "frequency_encode_backward",
        [](const py::array& points, int octaves, const py::array& d_features, py::array d_points) {
            encode_points_backward("frequency_encode_backward", frequencies(points, octaves),
                                   points, d_features, d_points);
        },
        py::arg("points"), py::arg("octaves"), py::arg("d_features"), py::arg("d_points"));
    m.def(
        "one_blob_encode",
        [](const py::array& points, int bins, py::array features) {
            encode_points("one_blob_encode", one_blob(points, bins), points, features);
        },
        py::arg("points"), py::arg("bins"), py::arg("features"));
    m.def(
        "one_blob_encode_backward",
        [](const py::array& points, int bins, const py::array& d_features, py::array d_points) {
            encode_points_backward("one_blob_encode_backward", one_blob(points, bins), points,
                                   d_features, d_points);
        },
        py::arg("points"), py::arg("bins"), py::arg("d_features"), py::arg("d_points"));
}

}  // namespace

void bind_network(py::module_& m) {
    py::class_<PerceptronShape>(m, "PerceptronShape")
        .def(py::init(&shape_of), py::arg("inputs"), py::arg("widths"), py::arg("hidden"),
             py::arg("output"), py::arg("skip"))
        .def_property_readonly("parameters", &PerceptronShape::parameters);
    py::class_<PerceptronValues>(m, "PerceptronValues").def(py::init<>());
    m.def(
        "perceptron_forward", &layers_forward, py::arg("shape"), py::arg("parameters"),
        py::arg("inputs"), py::arg("outputs"), py::arg("fused") = true,
        py::arg("values") = py::none(),
        "Writes outputs of inputs (N, shape's). fused: by the kernel, for float32. Fills values.");
    m.def("perceptron_backward", &layers_backward, py::arg("shape"), py::arg("parameters"),
          py::arg("inputs"), py::arg("d_outputs"), py::arg("d_parameters"), py::arg("d_inputs"),
          py::arg("fused") = true, py::arg("values") = py::none(),
          "Adds to d_parameters; writes d_inputs unless None. values: of forward, or None.");
    m.def("perceptrons_forward", &networks_forward, py::arg("shape"), py::arg("parameters"),
          py::arg("offset"), py::arg("inputs"), py::arg("outputs"),
          "Writes outputs of inputs (M, shape's): those from offset[n] on by row n of parameters.");
    m.def("perceptrons_backward", &networks_backward, py::arg("shape"), py::arg("parameters"),
          py::arg("offset"), py::arg("inputs"), py::arg("d_outputs"), py::arg("d_parameters"),
          py::arg("d_inputs"), "Adds to d_parameters (rows of parameters); writes d_inputs.");
    bind_encodings(m);
}

}  // namespace photograd
