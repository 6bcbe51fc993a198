// The sampler and the marcher: staged for every field of the registry, fused for the dense grid.
#include <pybind11/stl.h>

#include <optional>

#include "array_args.h"
#include "march_args.h"
#include "module.h"
#include "photograd/field/registry.h"
#include "photograd/render/march/lattice.h"
#include "photograd/render/march/march_dense.h"

namespace photograd {
namespace {

py::tuple place(const MarchSettings& settings, const py::array& origins,
                const py::array& directions, const std::optional<py::array>& jitter) {
    return dispatch_real("place_samples", "origins", origins, [&](auto real) -> py::tuple {
        using R = decltype(real);
        ArrayArgs args("place_samples");
        const R* o = args.within<R>("origins", origins, "R 3", world_limit);
        const R* d = args.within<R>("directions", directions, "R 3", world_limit);
        const R* u = jitter ? args.within<R>("jitter", *jitter, "R", 1.0) : nullptr;
        const std::int64_t count = args.size("R");
        py::array_t<R> t0(count);
        py::array_t<std::int32_t> samples(count);
        R* t0_out = t0.mutable_data();
        std::int32_t* samples_out = samples.mutable_data();
        const FieldOptions options = settings.field();
        {
            const py::gil_scoped_release release;
            parallel_for((count + 4095) / 4096, [&](std::int64_t chunk) {
                for (std::int64_t ray = chunk * 4096; ray < std::min(count, (chunk + 1) * 4096);
                     ++ray) {
                    const RaySamples<R> placed =
                        place_samples(clip_to_box(o + 3 * ray, d + 3 * ray, options.box),
                                      static_cast<R>(settings.dt),
                                      static_cast<Lattice>(settings.lattice), u ? u[ray] : R(0.5));
                    t0_out[ray] = placed.t0;
                    samples_out[ray] = placed.count;
                }
            });
        }
        for (std::int64_t ray = 0; ray < count; ++ray)
            if (samples_out[ray] > most_samples)
                args.range("settings",
                           "a step of which " + std::to_string(most_samples) + " cross the box",
                           number_text(settings.dt) + " m, too short in row " + std::to_string(ray),
                           "take longer steps, or a smaller box");
        return py::make_tuple(t0, samples);
    });
}

const MarchSettings& checked(const MarchSettings& s) {
    const auto refuse = [](const char* argument, const std::string& expected,
                           const std::string& got) {
        fail(ErrorKind::range, "MarchSettings", argument, expected, got);
    };
    if (!(s.dt > 0 && s.dt <= world_limit)) refuse("dt", "a positive step", number_text(s.dt));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lo = s.box[0][axis], hi = s.box[1][axis];
        const std::string got = number_text(lo) + " and " + number_text(hi);
        if (!(hi > lo)) refuse("box", "a lower corner below the upper one on every axis", got);
        if (!(std::abs(lo) <= world_limit && std::abs(hi) <= world_limit &&
              hi - lo >= 1 / world_limit))
            refuse("box", "corners up to 1e15 m away and 1e-15 m apart", got);
    }
    if (!(s.stop >= 0 && s.stop < 1))
        refuse("stop", "a transmittance in [0, 1)", number_text(s.stop));
    if (!std::isfinite(s.density_scale))
        refuse("density_scale", "a finite number", number_text(s.density_scale));
    const std::tuple<const char*, int, int> choices[] = {
        {"lattice", s.lattice, 1},
        {"quadrature", s.quadrature, 1},
        {"border", s.border, 1},
        {"density_activation", s.density_activation, 4},
        {"color_activation", s.color_activation, 4}};
    for (const auto& [name, chosen, last] : choices)
        if (chosen < 0 || chosen > last)
            refuse(name, "0 to " + std::to_string(last), std::to_string(chosen));
    return s;
}

py::tuple field_names() {
    py::list names;
    Fields<float>::for_each([&]<class F>(std::type_identity<F>) { names.append(F::name); });
    return py::tuple(names);
}

/// Calls use(field, parameter axes) with the field of the registry that `name` stands for, over `parameters`.
template <class R, class Use>
void with_field(ArrayArgs& args, const std::string& name, const py::array& parameters,
                const MarchSettings& settings, Use&& use) {
    bool found = false;
    Fields<R>::for_each([&]<class F>(std::type_identity<F>) {
        if (name != F::name) return;
        found = true;
        const R* values = args.in<R>("parameters", parameters, F::axes);
        const std::vector<std::int64_t> shape(parameters.shape(),
                                              parameters.shape() + parameters.ndim());
        if (!F::fits(shape.data())) args.range("parameters", F::expected(), shape_text(parameters));
        use(F::over(values, shape.data(), settings.field()), F::axes);
    });
    if (!found) args.range("field", "one of " + std::string(py::str(field_names())), name);
}

py::tuple march_any(const std::string& name, const py::array& parameters,
                    const MarchSettings& settings, const py::array& origins,
                    const py::array& directions, const py::array& t0, const py::array& samples,
                    bool fused) {
    return dispatch_real("march", "parameters", parameters, [&](auto real) -> py::tuple {
        using R = decltype(real);
        ArrayArgs args("march");
        const RayBatch<R> rays = ray_batch<R>(args, origins, directions, t0, samples);
        py::array_t<R> color({rays.count, std::int64_t(3)}), transmittance(rays.count),
            depth(rays.count);
        const RayOutputs<R> out{color.mutable_data(), transmittance.mutable_data(),
                                depth.mutable_data()};
        with_field<R>(args, name, parameters, settings, [&](const auto& field, const char*) {
            const py::gil_scoped_release release;
            if constexpr (std::is_same_v<std::decay_t<decltype(field)>, DenseGrid<float>>)
                if (fused) return march_dense(field, rays, settings.march(), out);
            march(field, rays, settings.march(), out);
        });
        return py::make_tuple(color, transmittance, depth);
    });
}

void march_any_backward(const std::string& name, const py::array& parameters,
                        const MarchSettings& settings, const py::array& origins,
                        const py::array& directions, const py::array& t0, const py::array& samples,
                        py::array color, py::array transmittance, py::array depth,
                        const py::array& d_color, const py::array& d_transmittance,
                        const py::array& d_depth, py::array d_parameters,
                        std::optional<py::array> d_origins, std::optional<py::array> d_directions,
                        bool fused) {
    dispatch_real("march_backward", "parameters", parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("march_backward");
        const RayBatch<R> rays = ray_batch<R>(args, origins, directions, t0, samples);
        const RayOutputs<R> out{args.out<R>("color", color, "R 3"),
                                args.out<R>("transmittance", transmittance, "R"),
                                args.out<R>("depth", depth, "R")};
        RayAdjoints<R> adjoints{args.in<R>("d_color", d_color, "R 3"),
                                args.in<R>("d_transmittance", d_transmittance, "R"),
                                args.in<R>("d_depth", d_depth, "R")};
        if (d_origins.has_value() != d_directions.has_value())
            args.range("d_origins, d_directions", "both or neither", "one of them");
        if (d_origins) {
            adjoints.d_origins = args.out<R>("d_origins", *d_origins, "R 3");
            adjoints.d_directions = args.out<R>("d_directions", *d_directions, "R 3");
        }
        with_field<R>(args, name, parameters, settings, [&](const auto& field, const char* axes) {
            using F = std::decay_t<decltype(field)>;
            R* d = args.out<R>("d_parameters", d_parameters, axes);
            const py::gil_scoped_release release;
            if constexpr (std::is_same_v<F, DenseGrid<float>>)
                if (fused && !adjoints.d_origins)
                    return march_dense_backward(field, rays, settings.march(), out, adjoints, d);
            typename F::Sink sink(field, d);
            march_backward(field, rays, settings.march(), out, adjoints, sink);
        });
    });
}

}  // namespace

void bind_march(py::module_& m) {
    py::class_<MarchSettings>(m, "MarchSettings", "Box, step and policies of a march.")
        .def(py::init([](const Box& box, double dt, double stop, int lattice, int quadrature,
                         int border, int density_activation, int color_activation,
                         double density_scale) {
                 return checked(MarchSettings{box, dt, stop, lattice, quadrature, border,
                                              density_activation, color_activation, density_scale});
             }),
             py::arg("box"), py::arg("dt"), py::arg("stop"), py::arg("lattice"),
             py::arg("quadrature"), py::arg("border"), py::arg("density_activation"),
             py::arg("color_activation"), py::arg("density_scale"));
    m.attr("fields") = field_names();
    m.attr("most_samples") = most_samples;
    m.attr("tiny_network_parameters") = TinyNetwork<float>::parameter_count;
    m.def("place_samples", &place, py::arg("settings"), py::arg("origins"), py::arg("directions"),
          py::arg("jitter") = py::none(), "Per ray: t0 (R,) and the number of samples (R,) int32.");
    m.def("march", &march_any, py::arg("field"), py::arg("parameters"), py::arg("settings"),
          py::arg("origins"), py::arg("directions"), py::arg("t0"), py::arg("samples"),
          py::arg("fused") = true,
          "Colour without background (R, 3), transmittance (R,) and depth (R,).");
    m.def("march_backward", &march_any_backward, py::arg("field"), py::arg("parameters"),
          py::arg("settings"), py::arg("origins"), py::arg("directions"), py::arg("t0"),
          py::arg("samples"), py::arg("color"), py::arg("transmittance"), py::arg("depth"),
          py::arg("d_color"), py::arg("d_transmittance"), py::arg("d_depth"),
          py::arg("d_parameters"), py::arg("d_origins") = py::none(),
          py::arg("d_directions") = py::none(), py::arg("fused") = true,
          "Adds to d_parameters and, where given, to d_origins and d_directions.");
}

}  // namespace photograd
