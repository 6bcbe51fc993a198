// Diffusion profiles on arrays; photograd.transport.subsurface is the typed face.
#include "model_args.h"
#include "module.h"
#include "photograd/ops/dipole.h"
#include "photograd/ops/normalized_diffusion.h"

namespace photograd {
namespace {

/// values (N,) of rows (N, K).
template <int K, class Value>
py::array profile_values(const char* function, const py::array& rows, Value&& value) {
    ArrayArgs args(function);
    const double* row = args.in<double>("rows", rows, "N " + std::to_string(K));
    return value_rows<double>(args, [&](std::int64_t n) { return value(row + K * n); });
}

/// Adds to d_rows (N, K) for d_values (N,).
template <int K, class Backward>
void profile_backward(const char* function, const py::array& rows, const py::array& d_values,
                      py::array d_rows, Backward&& backward) {
    ArrayArgs args(function);
    const std::string axes = "N " + std::to_string(K);
    const double* row = args.in<double>("rows", rows, axes);
    const double* d = args.in<double>("d_values", d_values, "N");
    double* to = args.out<double>("d_rows", d_rows, axes);
    for_each_row(args.size("N"), [&](std::int64_t n) { backward(row + K * n, d[n], to + K * n); });
}

DiffusionFit fit_of(const char* function, const std::string& name) {
    if (name == "searchlight") return DiffusionFit::searchlight;
    if (name == "diffuse") return DiffusionFit::diffuse;
    if (name != "diffuse_free_path")
        ArrayArgs(function).range("fit", "searchlight, diffuse or diffuse_free_path", name);
    return DiffusionFit::diffuse_free_path;
}

void add(const Dipole<double>& d_m, double* to) {
    to[0] += d_m.sigma_s;
    to[1] += d_m.sigma_a;
    to[2] += d_m.eta;
}

void def_dipole(py::module_& m) {
    m.def(
        "dipole",
        [](const py::array& rows) {
            return profile_values<4>("dipole", rows, [](const double* row) {
                return dipole(Dipole<double>{row[1], row[2], row[3]}, row[0]);
            });
        },
        py::arg("rows"), "R_d (N,) in 1/m^2 of rows (N, 4): radius, sigma_s', sigma_a, eta.");
    m.def(
        "dipole_backward",
        [](const py::array& rows, const py::array& d_values, py::array d_rows) {
            profile_backward<4>("dipole_backward", rows, d_values, std::move(d_rows),
                                [](const double* row, double d, double* to) {
                                    Dipole<double> d_m{0, 0, 0};
                                    dipole_backward({row[1], row[2], row[3]}, row[0], d, d_m,
                                                    to[0]);
                                    add(d_m, to + 1);
                                });
        },
        py::arg("rows"), py::arg("d_values"), py::arg("d_rows"),
        "Adds to d_rows (N, 4) for d_values (N,).");
    m.def(
        "dipole_albedo",
        [](const py::array& rows) {
            return profile_values<3>("dipole_albedo", rows, [](const double* row) {
                return dipole_albedo(Dipole<double>{row[0], row[1], row[2]});
            });
        },
        py::arg("rows"), "Integrals (N,) of R_d over the plane; rows (N, 3) without the radius.");
    m.def(
        "dipole_albedo_backward",
        [](const py::array& rows, const py::array& d_values, py::array d_rows) {
            profile_backward<3>("dipole_albedo_backward", rows, d_values, std::move(d_rows),
                                [](const double* row, double d, double* to) {
                                    Dipole<double> d_m{0, 0, 0};
                                    dipole_albedo_backward({row[0], row[1], row[2]}, d, d_m);
                                    add(d_m, to);
                                });
        },
        py::arg("rows"), py::arg("d_values"), py::arg("d_rows"),
        "Adds to d_rows (N, 3) for d_values (N,).");
}

using DiffusionValue = double (*)(DiffusionFit, const NormalizedDiffusion<double>&, double);
using DiffusionBackward = void (*)(DiffusionFit, const NormalizedDiffusion<double>&, double, double,
                                   NormalizedDiffusion<double>&, double&);

/// `name` and `name`_backward, of rows (N, 3): x, albedo, mean free path.
template <DiffusionValue Value, DiffusionBackward Backward>
void def_diffusion(py::module_& m, const char* name, const char* text) {
    m.def(
        name,
        [name](const py::array& rows, const std::string& fit) {
            const DiffusionFit which = fit_of(name, fit);
            return profile_values<3>(name, rows, [which](const double* row) {
                return Value(which, {row[1], row[2]}, row[0]);
            });
        },
        py::arg("rows"), py::arg("fit"), text);
    const std::string backward = std::string(name) + "_backward";
    m.def(
        backward.c_str(),
        [backward](const py::array& rows, const std::string& fit, const py::array& d_values,
                   py::array d_rows) {
            const DiffusionFit which = fit_of(backward.c_str(), fit);
            profile_backward<3>(backward.c_str(), rows, d_values, std::move(d_rows),
                                [which](const double* row, double d, double* to) {
                                    NormalizedDiffusion<double> d_m{0, 0};
                                    Backward(which, {row[1], row[2]}, row[0], d, d_m, to[0]);
                                    to[1] += d_m.albedo;
                                    to[2] += d_m.mean_free_path;
                                });
        },
        py::arg("rows"), py::arg("fit"), py::arg("d_values"), py::arg("d_rows"),
        "Adds to d_rows (N, 3) for d_values (N,).");
}

}  // namespace

void bind_diffusion(py::module_& m) {
    def_dipole(m);
    def_diffusion<&normalized_diffusion<double>, &normalized_diffusion_backward<double>>(
        m, "normalized_diffusion",
        "R (N,) in 1/m^2 of rows (N, 3): radius, albedo, mean free path.");
    def_diffusion<&diffusion_cdf<double>, &diffusion_cdf_backward<double>>(
        m, "diffusion_cdf", "Part of the light within the radius, (N,) of rows (N, 3).");
    def_diffusion<&sample_diffusion_radius<double>, &sample_diffusion_radius_backward<double>>(
        m, "sample_diffusion_radius", "Radii (N,) of rows (N, 3): u, albedo, mean free path.");
}

}  // namespace photograd
