// Reflectance models as functions on arrays, through the table of bsdf/bsdf_table.h: {name: Bsdf}
// as _core.bsdfs and, of specular ones, {name: DeltaBsdf} as _core.delta_bsdfs.
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
    [[nodiscard]] ParameterRows parameters() const { return parameter_rows(info().parameters); }
};
struct BoundDelta : BoundBsdf {
    [[nodiscard]] std::int64_t lobe_count() const { return info().lobe_count; }
    [[nodiscard]] std::string lobe_axes() const {
        return "N " + std::to_string(lobe_count()) + " 3";
    }
};

py::array bsdf_f(const BoundBsdf& model, const py::array& parameters, const py::array& wo,
                 const py::array& wi) {
    return dispatch_real("f", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
        const auto rows = model.read<R>(args, parameters);
        const auto value = bsdf_functions<R>(model.number).value;
        return vector_rows<R>(args, [&](std::int64_t n) {
            return value(rows.at(n), vec3_at(o, n), vec3_at(i, n), -1);
        });
    });
}

py::array bsdf_f_backward(const BoundBsdf& model, const py::array& parameters, const py::array& wo,
                          const py::array& wi, const py::array& d_f, py::array d_parameters) {
    return dispatch_real("f_backward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
        const R* d = args.in<R>("d_f", d_f, "N 3");
        const int count = model.parameter_count();
        const auto rows = model.read<R>(args, parameters);
        R* out = args.out<R>("d_parameters", d_parameters, rows.axes(count));
        const auto backward = bsdf_functions<R>(model.number).value_backward;
        add_parameter_rows<R>(
            count, args.size("N"), rows.shared(), out, [&](std::int64_t n, R* d_row) {
                backward(rows.at(n), vec3_at(o, n), vec3_at(i, n), -1, vec3_at(d, n), d_row);
            });
        return d_parameters;
    });
}

py::array bsdf_jvp(const BoundBsdf& model, const py::array& parameters, const py::array& v,
                   const py::array& wo, const py::array& wi) {
    ArrayArgs args("jvp");
    const double *o = args.in<double>("wo", wo, "N 3"), *i = args.in<double>("wi", wi, "N 3");
    const auto rows = model.read<double>(args, parameters);
    const auto tangents = model.read<double>(args, v);
    const auto tangent = bsdf_tangents[model.number].value;
    return vector_rows<double>(args, [&](std::int64_t n) {
        return tangent(rows.at(n), tangents.at(n), vec3_at(o, n), vec3_at(i, n), -1);
    });
}

py::array bsdf_sample(const BoundBsdf& model, const py::array& parameters, const py::array& wo,
                      const py::array& u2) {
    return dispatch_real("sample", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R *o = args.in<R>("wo", wo, "N 3"), *u = args.in<R>("u2", u2, "N 2");
        const auto rows = model.read<R>(args, parameters);
        const auto direction = bsdf_functions<R>(model.number).sample_direction;
        return vector_rows<R>(args, [&](std::int64_t n) {
            return direction(rows.at(n), vec3_at(o, n), Vec2<R>(u[2 * n], u[2 * n + 1]));
        });
    });
}

py::array bsdf_pdf(const BoundBsdf& model, const py::array& parameters, const py::array& wo,
                   const py::array& wi) {
    return dispatch_real("pdf", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R *o = args.in<R>("wo", wo, "N 3"), *i = args.in<R>("wi", wi, "N 3");
        const auto rows = model.read<R>(args, parameters);
        const auto pdf = bsdf_functions<R>(model.number).pdf;
        return value_rows<R>(
            args, [&](std::int64_t n) { return pdf(rows.at(n), vec3_at(o, n), vec3_at(i, n)); });
    });
}

py::array bsdf_index_inside(const BoundBsdf& model, const py::array& parameters) {
    ArrayArgs args("index_inside");
    const int count = model.parameter_count();
    const double* rows = args.in<double>("parameters", parameters, "N " + std::to_string(count));
    const auto index = bsdf_functions<double>(model.number).index_inside;
    return vector_rows<double>(args, [&](std::int64_t n) { return index(rows + n * count); });
}

/// (wi, weight), (N, L, 3) each, of the L lobes that find(n, lobes) writes.
template <class R, class Find>
py::tuple lobe_rows(const ArrayArgs& args, std::int64_t count, Find&& find) {
    py::array_t<R> wi({args.size("N"), count, std::int64_t(3)}),
        weight({args.size("N"), count, std::int64_t(3)});
    R *to = wi.mutable_data(), *w = weight.mutable_data();
    for_each_row(args.size("N"), [&](std::int64_t n) {
        DeltaLobe<R> found[max_lobes];
        find(n, found);
        for (std::int64_t k = 0; k < count; ++k) {
            put_vec3(to, n * count + k, found[k].wi);
            put_vec3(w, n * count + k, found[k].weight);
        }
    });
    return py::make_tuple(wi, weight);
}

py::tuple delta_lobes(const BoundDelta& model, const py::array& parameters, const py::array& wo) {
    return dispatch_real("lobes", "parameters", parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* o = args.in<R>("wo", wo, "N 3");
        const auto rows = model.read<R>(args, parameters);
        const auto lobes_of = bsdf_functions<R>(model.number).lobes;
        return lobe_rows<R>(args, model.lobe_count(), [&](std::int64_t n, DeltaLobe<R>* found) {
            lobes_of(rows.at(n), vec3_at(o, n), found);
        });
    });
}

py::array delta_lobes_backward(const BoundDelta& model, const py::array& parameters,
                               const py::array& wo, const py::array& d_wi,
                               const py::array& d_weight, py::array d_parameters) {
    return dispatch_real(
        "lobes_backward", "parameters", parameters, [&](auto real, ArrayArgs& args) {
            using R = decltype(real);
            const R* o = args.in<R>("wo", wo, "N 3");
            const R* d_to = args.in<R>("d_wi", d_wi, model.lobe_axes());
            const R* d_w = args.in<R>("d_weight", d_weight, model.lobe_axes());
            const auto rows = model.read<R>(args, parameters);
            const int size = model.parameter_count();
            R* out = args.out<R>("d_parameters", d_parameters, rows.axes(size));
            const auto backward = bsdf_functions<R>(model.number).lobes_backward;
            const std::int64_t count = model.lobe_count();
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

py::tuple delta_jvp(const BoundDelta& model, const py::array& parameters, const py::array& v,
                    const py::array& wo) {
    ArrayArgs args("jvp");
    const double* o = args.in<double>("wo", wo, "N 3");
    const auto rows = model.read<double>(args, parameters);
    const auto tangents = model.read<double>(args, v);
    const auto tangent = bsdf_tangents[model.number].lobes;
    return lobe_rows<double>(args, model.lobe_count(),
                             [&](std::int64_t n, DeltaLobe<double>* found) {
                                 tangent(rows.at(n), tangents.at(n), vec3_at(o, n), found);
                             });
}

/// Kind of the claim, and its bound.
std::pair<std::string, double> bsdf_energy(const BoundBsdf& model) {
    static constexpr const char* kinds[] = {"conserving", "lossy", "gains"};
    const EnergyClaim& claim = model.info().energy;
    return {kinds[static_cast<int>(claim.kind)], claim.most};
}

// module_local: tests load a second module with models of its own.
void bind_densities(py::module_& m) {
    py::class_<BoundBsdf>(
        m, "Bsdf", py::module_local(),
        "A reflectance model. Parameters (N, P), or (1, P) for all rows; directions "
        "(N, 3) in the shading frame, normal +Z.")
        .def("f", &bsdf_f, py::arg("parameters"), py::arg("wo"), py::arg("wi"),
             "Value without the cosine, (N, 3).")
        .def("f_backward", &bsdf_f_backward, py::arg("parameters"), py::arg("wo"), py::arg("wi"),
             py::arg("d_f"), py::arg("d_parameters"),
             "Adds dL/dparameters to d_parameters, shaped like parameters; returns it.")
        .def("jvp", &bsdf_jvp, py::arg("parameters"), py::arg("v"), py::arg("wo"), py::arg("wi"),
             "Exact derivative of f along v, (N, 3), float64.")
        .def("sample", &bsdf_sample, py::arg("parameters"), py::arg("wo"), py::arg("u2"),
             "wi (N, 3) from uniform u2 (N, 2).")
        .def("pdf", &bsdf_pdf, py::arg("parameters"), py::arg("wo"), py::arg("wi"),
             "Density of `sample` over solid angle, (N,).")
        .def(
            "parameters", [](const BoundBsdf& model) { return model.parameters(); },
            "(name, scalars, lo, hi, unit) of each parameter, in the order of a row.")
        .def("energy", &bsdf_energy,
             "What is claimed of the directional albedo: (conserving, lossy or gains; its bound).")
        .def(
            "reciprocal", [](const BoundBsdf& model) { return model.info().reciprocal; },
            "Whether f(wo, wi) / index(wo)^2 = f(wi, wo) / index(wi)^2; outside the index is 1.")
        .def("index_inside", &bsdf_index_inside, py::arg("parameters"),
             "Refractive index below the surface over that above, per channel (N, 3), of "
             "parameters (N, P) float64.")
        .def(
            "transmits", [](const BoundBsdf& model) { return model.info().transmits; },
            "Whether light may pass the surface.")
        .def("__repr__", [](const BoundBsdf& model) { return model.repr(); });
}

void bind_deltas(py::module_& m) {
    py::class_<BoundDelta>(m, "DeltaBsdf", py::module_local(),
                           "A specular surface. Parameters (N, P), or (1, P) for all rows; wo "
                           "(N, 3) in the shading frame, normal +Z, on either side.")
        .def("lobes", &delta_lobes, py::arg("parameters"), py::arg("wo"),
             "(wi, weight), (N, L, 3) each: L(wo) is the sum of weight L(wi).")
        .def("lobes_backward", &delta_lobes_backward, py::arg("parameters"), py::arg("wo"),
             py::arg("d_wi"), py::arg("d_weight"), py::arg("d_parameters"),
             "Adds dL/dparameters to d_parameters, shaped like parameters; returns it.")
        .def("jvp", &delta_jvp, py::arg("parameters"), py::arg("v"), py::arg("wo"),
             "Exact derivatives of (wi, weight) along v, float64.")
        .def(
            "lobe_count", [](const BoundDelta& model) { return model.lobe_count(); }, "L.")
        .def(
            "parameters", [](const BoundDelta& model) { return model.parameters(); },
            "(name, scalars, lo, hi, unit) of each parameter, in the order of a row.")
        .def("__repr__", [](const BoundDelta& model) { return model.repr(); });
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
