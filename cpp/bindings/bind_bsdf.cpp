// Reflectance models as functions on arrays, through the table of bsdf/bsdf_table.h: {name: Bsdf}
// as _core.bsdfs and, of specular ones, {name: DeltaBsdf} as _core.delta_bsdfs.
#include "method.h"
#include "model_args.h"
#include "module.h"
#include "photograd/bsdf/bsdf_table.h"

namespace photograd {
namespace {

static_assert(max_bsdf_parameters <= max_row);

/// A row of the table, as Python holds it.
struct BoundBsdf {
    int number;

    [[nodiscard]] const BsdfInfo& info() const {
        return bsdf_infos[static_cast<std::size_t>(number)];
    }
    [[nodiscard]] int parameter_count() const { return info().parameter_count; }
    template <class R>
    [[nodiscard]] ModelRows<R> read(ArrayArgs& args, const py::array& parameters) const {
        return ModelRows<R>::read(args, parameters, parameter_count());
    }
    [[nodiscard]] std::string repr() const {
        return std::string("<").append(info().name).append(">");
    }

    py::array f(const py::array& parameters, const py::array& wo, const py::array& wi) const;
    py::array f_backward(const py::array& parameters, const py::array& wo, const py::array& wi,
                         const py::array& d_f, py::array d_parameters) const;
    py::array jvp(const py::array& parameters, const py::array& v, const py::array& wo,
                  const py::array& wi) const;
    py::array sample(const py::array& parameters, const py::array& wo, const py::array& u2) const;
    py::array pdf(const py::array& parameters, const py::array& wo, const py::array& wi) const;
    py::array index_inside(const py::array& parameters) const;
    [[nodiscard]] ParameterRows parameters() const { return parameter_rows(info().parameters); }
    /// Kind of the claim, and its bound.
    [[nodiscard]] std::pair<std::string, double> energy() const;
};
struct BoundDelta : BoundBsdf {
    [[nodiscard]] std::int64_t lobe_count() const { return info().lobe_count; }
    [[nodiscard]] std::string lobe_axes() const {
        return "N " + std::to_string(lobe_count()) + " 3";
    }

    py::tuple lobes(const py::array& parameters, const py::array& wo) const;
    py::array lobes_backward(const py::array& parameters, const py::array& wo,
                             const py::array& d_wi, const py::array& d_weight,
                             py::array d_parameters) const;
    py::tuple jvp(const py::array& parameters, const py::array& v, const py::array& wo) const;
};

py::array BoundBsdf::f(const py::array& parameters, const py::array& wo,
                       const py::array& wi) const {
    return dispatch_real("f", "parameters", parameters, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args("f");
        const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
        const auto rows = read<R>(args, parameters);
        const auto value = bsdf_functions<R>(number).value;
        py::array_t<R> out({args.size("N"), std::int64_t(3)});
        R* to = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            put_vec3(to, n, value(rows.at(n), vec3_at(o, n), vec3_at(i, n), -1));
        });
        return out;
    });
}

py::array BoundBsdf::f_backward(const py::array& parameters, const py::array& wo,
                                const py::array& wi, const py::array& d_f,
                                py::array d_parameters) const {
    return dispatch_real("f_backward", "parameters", parameters, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args("f_backward");
        const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
        const R* d = args.in<R>("d_f", d_f, "N 3");
        const int count = parameter_count();
        const auto rows = read<R>(args, parameters);
        R* out = args.out<R>("d_parameters", d_parameters, rows.axes(count));
        const auto backward = bsdf_functions<R>(number).value_backward;
        add_parameter_rows<R>(
            count, args.size("N"), rows.shared(), out, [&](std::int64_t n, R* d_row) {
                backward(rows.at(n), vec3_at(o, n), vec3_at(i, n), -1, vec3_at(d, n), d_row);
            });
        return d_parameters;
    });
}

py::array BoundBsdf::jvp(const py::array& parameters, const py::array& v, const py::array& wo,
                         const py::array& wi) const {
    ArrayArgs args("jvp");
    const double *o = args.in<double>("wo", wo, "N 3"), *i = args.in<double>("wi", wi, "N 3");
    const auto rows = read<double>(args, parameters);
    const auto tangents = read<double>(args, v);
    const auto tangent = bsdf_tangents[number].value;
    py::array_t<double> out({args.size("N"), std::int64_t(3)});
    double* to = out.mutable_data();
    for_each_row(args.size("N"), [&](std::int64_t n) {
        put_vec3(to, n, tangent(rows.at(n), tangents.at(n), vec3_at(o, n), vec3_at(i, n), -1));
    });
    return out;
}

py::array BoundBsdf::sample(const py::array& parameters, const py::array& wo,
                            const py::array& u2) const {
    return dispatch_real("sample", "parameters", parameters, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args("sample");
        const R *o = args.in<R>("wo", wo, "N 3"), *u = args.in<R>("u2", u2, "N 2");
        const auto rows = read<R>(args, parameters);
        const auto direction = bsdf_functions<R>(number).sample_direction;
        py::array_t<R> out({args.size("N"), std::int64_t(3)});
        R* wi = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            put_vec3(wi, n, direction(rows.at(n), vec3_at(o, n), Vec2<R>(u[2 * n], u[2 * n + 1])));
        });
        return out;
    });
}

py::array BoundBsdf::pdf(const py::array& parameters, const py::array& wo,
                         const py::array& wi) const {
    return dispatch_real("pdf", "parameters", parameters, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args("pdf");
        const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
        const auto rows = read<R>(args, parameters);
        const auto pdf = bsdf_functions<R>(number).pdf;
        py::array_t<R> out(args.size("N"));
        R* density = out.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            density[n] = pdf(rows.at(n), vec3_at(o, n), vec3_at(i, n));
        });
        return out;
    });
}

py::array BoundBsdf::index_inside(const py::array& parameters) const {
    ArrayArgs args("index_inside");
    const int count = parameter_count();
    const double* rows = args.in<double>("parameters", parameters, "N " + std::to_string(count));
    const auto index = bsdf_functions<double>(number).index_inside;
    py::array_t<double> out({args.size("N"), std::int64_t(3)});
    for (std::int64_t n = 0; n < args.size("N"); ++n)
        put_vec3(out.mutable_data(), n, index(rows + n * count));
    return out;
}

/// Writes all lobes of evaluation n behind those of the others.
template <class R>
void put_lobes(const DeltaLobe<R>* lobes, std::int64_t count, std::int64_t n, R* wi, R* weight) {
    for (std::int64_t k = 0; k < count; ++k) {
        put_vec3(wi, n * count + k, lobes[k].wi);
        put_vec3(weight, n * count + k, lobes[k].weight);
    }
}

py::tuple BoundDelta::lobes(const py::array& parameters, const py::array& wo) const {
    return dispatch_real("lobes", "parameters", parameters, [&](auto real) -> py::tuple {
        using R = decltype(real);
        ArrayArgs args("lobes");
        const R* o = args.in<R>("wo", wo, "N 3");
        const auto rows = read<R>(args, parameters);
        const auto lobes_of = bsdf_functions<R>(number).lobes;
        const std::int64_t count = lobe_count();
        py::array_t<R> wi({args.size("N"), count, std::int64_t(3)});
        py::array_t<R> weight({args.size("N"), count, std::int64_t(3)});
        R *to = wi.mutable_data(), *w = weight.mutable_data();
        for_each_row(args.size("N"), [&](std::int64_t n) {
            DeltaLobe<R> found[max_lobes];
            lobes_of(rows.at(n), vec3_at(o, n), found);
            put_lobes(found, count, n, to, w);
        });
        return py::make_tuple(wi, weight);
    });
}

py::array BoundDelta::lobes_backward(const py::array& parameters, const py::array& wo,
                                     const py::array& d_wi, const py::array& d_weight,
                                     py::array d_parameters) const {
    return dispatch_real("lobes_backward", "parameters", parameters, [&](auto real) -> py::array {
        using R = decltype(real);
        ArrayArgs args("lobes_backward");
        const R* o = args.in<R>("wo", wo, "N 3");
        const R* d_to = args.in<R>("d_wi", d_wi, lobe_axes());
        const R* d_w = args.in<R>("d_weight", d_weight, lobe_axes());
        const auto rows = read<R>(args, parameters);
        const int size = parameter_count();
        R* out = args.out<R>("d_parameters", d_parameters, rows.axes(size));
        const auto backward = bsdf_functions<R>(number).lobes_backward;
        const std::int64_t count = lobe_count();
        add_parameter_rows<R>(
            size, args.size("N"), rows.shared(), out, [&](std::int64_t n, R* d_row) {
                DeltaLobe<R> d_lobes[max_lobes];
                for (std::int64_t k = 0; k < count; ++k)
                    d_lobes[k] = {vec3_at(d_to, n * count + k), vec3_at(d_w, n * count + k)};
                backward(rows.at(n), vec3_at(o, n), d_lobes, d_row);
            });
        return d_parameters;
    });
}

py::tuple BoundDelta::jvp(const py::array& parameters, const py::array& v,
                          const py::array& wo) const {
    ArrayArgs args("jvp");
    const double* o = args.in<double>("wo", wo, "N 3");
    const auto rows = read<double>(args, parameters);
    const auto tangents = read<double>(args, v);
    const auto tangent = bsdf_tangents[number].lobes;
    const std::int64_t count = lobe_count();
    py::array_t<double> wi({args.size("N"), count, std::int64_t(3)});
    py::array_t<double> weight({args.size("N"), count, std::int64_t(3)});
    double *to = wi.mutable_data(), *w = weight.mutable_data();
    for_each_row(args.size("N"), [&](std::int64_t n) {
        DeltaLobe<double> found[max_lobes];
        tangent(rows.at(n), tangents.at(n), vec3_at(o, n), found);
        put_lobes(found, count, n, to, w);
    });
    return py::make_tuple(wi, weight);
}

std::pair<std::string, double> BoundBsdf::energy() const {
    static constexpr const char* kinds[] = {"conserving", "lossy", "gains"};
    const EnergyClaim& claim = info().energy;
    return {kinds[static_cast<int>(claim.kind)], claim.most};
}

// module_local: tests load a second module with models of its own.
void bind_densities(py::module_& m) {
    py::class_<BoundBsdf>(
        m, "Bsdf", py::module_local(),
        "A reflectance model. Parameters (N, P), or (1, P) for all rows; directions "
        "(N, 3) in the shading frame, normal +Z.")
        .def("f", method<BoundBsdf>(&BoundBsdf::f), py::arg("parameters"), py::arg("wo"),
             py::arg("wi"), "Value without the cosine, (N, 3).")
        .def("f_backward", method<BoundBsdf>(&BoundBsdf::f_backward), py::arg("parameters"),
             py::arg("wo"), py::arg("wi"), py::arg("d_f"), py::arg("d_parameters"),
             "Adds dL/dparameters to d_parameters, shaped like parameters; returns it.")
        .def("jvp", method<BoundBsdf>(&BoundBsdf::jvp), py::arg("parameters"), py::arg("v"),
             py::arg("wo"), py::arg("wi"), "Exact derivative of f along v, (N, 3), float64.")
        .def("sample", method<BoundBsdf>(&BoundBsdf::sample), py::arg("parameters"), py::arg("wo"),
             py::arg("u2"), "wi (N, 3) from uniform u2 (N, 2).")
        .def("pdf", method<BoundBsdf>(&BoundBsdf::pdf), py::arg("parameters"), py::arg("wo"),
             py::arg("wi"), "Density of `sample` over solid angle, (N,).")
        .def("parameters", method<BoundBsdf>(&BoundBsdf::parameters),
             "(name, scalars, lo, hi, unit) of each parameter, in the order of a row.")
        .def("energy", method<BoundBsdf>(&BoundBsdf::energy),
             "What is claimed of the directional albedo: (conserving, lossy or gains; its bound).")
        .def(
            "reciprocal", [](const BoundBsdf& model) { return model.info().reciprocal; },
            "Whether f(wo, wi) / index(wo)^2 = f(wi, wo) / index(wi)^2; outside the index is 1.")
        .def("index_inside", method<BoundBsdf>(&BoundBsdf::index_inside), py::arg("parameters"),
             "Refractive index below the surface over that above, per channel (N, 3), of "
             "parameters (N, P) float64.")
        .def(
            "transmits", [](const BoundBsdf& model) { return model.info().transmits; },
            "Whether light may pass the surface.")
        .def("__repr__", method<BoundBsdf>(&BoundBsdf::repr));
}

void bind_deltas(py::module_& m) {
    py::class_<BoundDelta>(m, "DeltaBsdf", py::module_local(),
                           "A specular surface. Parameters (N, P), or (1, P) for all rows; wo "
                           "(N, 3) in the shading frame, normal +Z, on either side.")
        .def("lobes", method<BoundDelta>(&BoundDelta::lobes), py::arg("parameters"), py::arg("wo"),
             "(wi, weight), (N, L, 3) each: L(wo) is the sum of weight L(wi).")
        .def("lobes_backward", method<BoundDelta>(&BoundDelta::lobes_backward),
             py::arg("parameters"), py::arg("wo"), py::arg("d_wi"), py::arg("d_weight"),
             py::arg("d_parameters"),
             "Adds dL/dparameters to d_parameters, shaped like parameters; returns it.")
        .def("jvp", method<BoundDelta>(&BoundDelta::jvp), py::arg("parameters"), py::arg("v"),
             py::arg("wo"), "Exact derivatives of (wi, weight) along v, float64.")
        .def("lobe_count", method<BoundDelta>(&BoundDelta::lobe_count), "L.")
        .def(
            "parameters", [](const BoundDelta& model) { return model.parameters(); },
            "(name, scalars, lo, hi, unit) of each parameter, in the order of a row.")
        .def("__repr__", method<BoundDelta>(&BoundDelta::repr));
}

}  // namespace

void bind_bsdf(py::module_& m) {
    bind_densities(m);
    bind_deltas(m);
    py::dict densities, deltas;
    for (int k = 0; k < static_cast<int>(bsdf_infos.size()); ++k) {
        const BoundBsdf model{k};
        const py::str name(std::string(model.info().name));
        if (model.info().is_specular())
            deltas[name] = BoundDelta{model};
        else
            densities[name] = model;
    }
    m.attr("bsdfs") = densities;
    m.attr("delta_bsdfs") = deltas;
}

}  // namespace photograd
