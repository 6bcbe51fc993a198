// The sampler and the marcher: staged for every field of the registry, fused for the dense grid.
#include "march_args.h"
#include "module.h"
#include "photograd/field/registry.h"
#include "photograd/render/march/lattice.h"
#include "photograd/render/march/march_dense.h"

namespace photograd {
namespace {

py::tuple place_rays(const MarchSettings& settings, const py::array& origins,
                     const py::array& directions, const std::optional<py::array>& jitter) {
    return dispatch_real(
        "place_samples", "origins", origins, [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const R* o = args.within<R>("origins", origins, "R 3", world_limit);
            const R* d = args.within<R>("directions", directions, "R 3", world_limit);
            const R* u = jitter ? args.within<R>("jitter", *jitter, "R", 1.0) : nullptr;
            const std::int64_t count = args.size("R");
            py::array_t<R> t0(count);
            py::array_t<std::int32_t> samples(count);
            R* t0_out = t0.mutable_data();
            std::int32_t* samples_out = samples.mutable_data();
            {
                const py::gil_scoped_release release;
                parallel_for((count + 4095) / 4096, [&](std::int64_t chunk) {
                    for (std::int64_t ray = chunk * 4096; ray < std::min(count, (chunk + 1) * 4096);
                         ++ray) {
                        const RaySamples<R> placed =
                            place_samples(clip_to_box(o + 3 * ray, d + 3 * ray, settings.field.box),
                                          static_cast<R>(settings.march.dt), settings.lattice,
                                          u ? u[ray] : R(0.5));
                        t0_out[ray] = placed.t0;
                        samples_out[ray] = placed.count;
                    }
                });
            }
            for (std::int64_t ray = 0; ray < count; ++ray)
                if (samples_out[ray] > max_samples)
                    args.range("settings",
                               "a step of which " + std::to_string(max_samples) + " cross the box",
                               number_text(settings.march.dt) + " m, too short in row " +
                                   std::to_string(ray),
                               "take longer steps, or a smaller box");
            return py::make_tuple(t0, samples);
        });
}

using Box = std::array<std::array<double, 3>, 2>;

void check_box(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lo = box[0][axis], hi = box[1][axis];
        const std::string got = number_text(lo) + " and " + number_text(hi);
        if (!(hi > lo))
            fail(ErrorKind::range, "MarchSettings", "box",
                 "a lower corner below the upper one on every axis", got);
        if (!(std::abs(lo) <= world_limit && std::abs(hi) <= world_limit &&
              hi - lo >= 1 / world_limit))
            fail(ErrorKind::range, "MarchSettings", "box",
                 "corners up to 1e15 m away and 1e-15 m apart", got);
    }
}

/// The enumerator with this number; `last` is the largest.
template <class Enum>
Enum choice(const char* argument, int chosen, Enum last) {
    if (chosen < 0 || chosen > static_cast<int>(last))
        fail(ErrorKind::range, "MarchSettings", argument,
             "0 to " + std::to_string(static_cast<int>(last)), std::to_string(chosen));
    return static_cast<Enum>(chosen);
}

MarchSettings settings_of(const Box& box, double dt, double stop, int lattice, int quadrature,
                          int border, int density_activation, int color_activation,
                          double density_scale) {
    const auto require = [](bool good, const char* argument, const char* expected, double got) {
        if (!good) fail(ErrorKind::range, "MarchSettings", argument, expected, number_text(got));
    };
    require(dt > 0 && dt <= world_limit, "dt", "a positive step", dt);
    check_box(box);
    require(stop >= 0 && stop < 1, "stop", "a transmittance in [0, 1)", stop);
    require(std::isfinite(density_scale), "density_scale", "a finite number", density_scale);
    MarchSettings s;
    for (std::size_t end = 0; end < 2; ++end)
        std::copy(box[end].begin(), box[end].end(), s.field.box[end]);
    s.lattice = choice("lattice", lattice, Lattice::entry);
    s.march = {dt, stop, choice("quadrature", quadrature, Quadrature::riemann)};
    s.field.border = choice("border", border, Border::zero);
    s.field.density_activation =
        choice("density_activation", density_activation, Activation::sigmoid);
    s.field.color_activation = choice("color_activation", color_activation, Activation::sigmoid);
    s.field.density_scale = density_scale;
    return s;
}

py::tuple field_names() {
    py::list names;
    Fields<float>::for_each([&]<class F>(std::type_identity<F>) { names.append(F::name); });
    return py::tuple(names);
}

/// Calls use(field, parameter axes) with the field of the registry that `name` stands for, over
/// `parameters`.
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
        use(F::over(values, shape.data(), settings.field), F::axes);
    });
    if (!found) args.range("field", "one of " + std::string(py::str(field_names())), name);
}

py::tuple march_any(const std::string& name, const py::array& parameters,
                    const MarchSettings& settings, const RayArrays& ray_arrays, bool fused) {
    return dispatch_real(
        "march", "parameters", parameters, [&](auto real, ArrayArgs& args) -> py::tuple {
            using R = decltype(real);
            const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
            py::tuple image;
            with_field<R>(args, name, parameters, settings, [&](const auto& field, const char*) {
                image = filled_image<R, MarchOutputs<R>>({rays.count}, [&](const MarchOutputs<R>&
                                                                               out) {
                    if constexpr (std::is_same_v<std::decay_t<decltype(field)>, DenseGrid<float>>)
                        if (fused) return march_dense(field, rays, settings.march, out);
                    march(field, rays, settings.march, out);
                });
            });
            return image;
        });
}

void march_any_backward(const std::string& name, const py::array& parameters,
                        const MarchSettings& settings, const RayArrays& ray_arrays,
                        const Arrays<3>& outputs, const Arrays<3>& d_outputs,
                        py::array d_parameters, const std::optional<Arrays<2>>& d_rays,
                        bool fused) {
    dispatch_real("march_backward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const RayBatch<R> rays = ray_batch<R>(args, ray_arrays);
        MarchAdjoint<R> adjoint;
        const auto out = MarchCotangentArrays{outputs, d_outputs, d_rays}.read<R>(args, adjoint);
        with_field<R>(args, name, parameters, settings, [&](const auto& field, const char* axes) {
            using F = std::decay_t<decltype(field)>;
            R* d = args.out<R>("d_parameters", d_parameters, axes);
            const py::gil_scoped_release release;
            if constexpr (std::is_same_v<F, DenseGrid<float>>)
                if (fused && !adjoint.d_origins)
                    return march_dense_backward(field, rays, settings.march, out, adjoint, d);
            typename F::Sink sink(field, d);
            march_backward(field, rays, settings.march, out, adjoint, sink);
        });
    });
}

}  // namespace

void bind_march(py::module_& m) {
    py::class_<MarchSettings>(m, "MarchSettings", "Box, step and policies of a march.")
        .def(py::init(&settings_of), py::arg("box"), py::arg("dt"), py::arg("stop"),
             py::arg("lattice"), py::arg("quadrature"), py::arg("border"),
             py::arg("density_activation"), py::arg("color_activation"), py::arg("density_scale"));
    m.attr("fields") = field_names();
    m.attr("max_samples") = max_samples;
    m.attr("tiny_network_parameters") = TinyNetwork<float>::parameter_count;
    m.def("place_samples", &place_rays, py::arg("settings"), py::arg("origins"),
          py::arg("directions"), py::arg("jitter") = py::none(),
          "Per ray: t0 (R,) and the number of samples (R,) int32.");
    m.def(
        "march", &march_any, py::arg("field"), py::arg("parameters"), py::arg("settings"),
        py::arg("rays"), py::arg("fused") = true,
        "Color without background (R, 3), transmittance (R,) and depth (R,). rays: origins (R, 3), "
        "directions (R, 3), t0 (R,), samples (R,) int32.");
    m.def("march_backward", &march_any_backward, py::arg("field"), py::arg("parameters"),
          py::arg("settings"), py::arg("rays"), py::arg("outputs"), py::arg("d_outputs"),
          py::arg("d_parameters"), py::arg("d_rays") = py::none(), py::arg("fused") = true,
          "Adds to d_parameters and, where given, to d_rays: d_origins and d_directions.");
}

}  // namespace photograd
