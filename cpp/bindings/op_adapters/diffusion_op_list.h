// Diffusion profiles as flat functions, for the proofs (see op_list.h).
#pragma once

#include <array>

#include "input_group.h"
#include "photograd/ops/dipole.h"
#include "photograd/ops/normalized_diffusion.h"

namespace photograd {

/// R_d at three distances and the whole of what comes back.
struct DipoleOp {
    static constexpr const char* name = "dipole";
    static constexpr std::array<InputGroup, 4> inputs{{{"radius", 3, 0.2, 3.0},
                                                       {"sigma_s", 1, 0.5, 2.0},
                                                       {"sigma_a", 1, 0.05, 0.5},
                                                       {"eta", 1, 1.05, 1.6}}};
    static constexpr int outputs = 4;

    template <class R>
    static void forward(const R* in, R* out) {
        const Dipole<R> m{in[3], in[4], in[5]};
        for (int i = 0; i < 3; ++i) out[i] = dipole(m, in[i]);
        out[3] = dipole_albedo(m);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const Dipole<R> m{in[3], in[4], in[5]};
        Dipole<R> d_m{R(0), R(0), R(0)};
        for (int i = 0; i < 3; ++i) dipole_backward(m, in[i], d_out[i], d_m, d_in[i]);
        dipole_albedo_backward(m, d_out[3], d_m);
        d_in[3] += d_m.sigma_s;
        d_in[4] += d_m.sigma_a;
        d_in[5] += d_m.eta;
    }
};

/// Profile and cdf at one distance, and a sampled distance, of one fit of s.
template <DiffusionFit Fit>
struct NormalizedDiffusionOp {
    static constexpr const char* name = Fit == DiffusionFit::searchlight ? "diffusion_searchlight"
                                        : Fit == DiffusionFit::diffuse
                                            ? "diffusion_diffuse"
                                            : "diffusion_diffuse_free_path";
    static constexpr std::array<InputGroup, 4> inputs{{{"radius", 1, 0.2, 3.0},
                                                       {"albedo", 1, 0.1, 0.98},
                                                       {"mean_free_path", 1, 0.5, 2.0},
                                                       {"u", 1, 0.05, 0.95}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* in, R* out) {
        const NormalizedDiffusion<R> m{in[1], in[2]};
        out[0] = normalized_diffusion(Fit, m, in[0]);
        out[1] = diffusion_cdf(Fit, m, in[0]);
        out[2] = sample_diffusion_radius(Fit, m, in[3]);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const NormalizedDiffusion<R> m{in[1], in[2]};
        NormalizedDiffusion<R> d_m{R(0), R(0)};
        normalized_diffusion_backward(Fit, m, in[0], d_out[0], d_m, d_in[0]);
        diffusion_cdf_backward(Fit, m, in[0], d_out[1], d_m, d_in[0]);
        sample_diffusion_radius_backward(Fit, m, in[3], d_out[2], d_m, d_in[3]);
        d_in[1] += d_m.albedo;
        d_in[2] += d_m.mean_free_path;
    }
};

}  // namespace photograd
