// What the bindings of all marches share: settings, and rays from arrays.
#pragma once

#include <array>

#include "array_args.h"
#include "photograd/render/march.h"

namespace photograd {

using Box = std::array<std::array<double, 3>, 2>;

struct MarchSettings {
    Box box{{{-1, -1, -1}, {1, 1, 1}}};
    double dt = 0.01, stop = 0.0;
    int lattice = 0, quadrature = 0, border = 0, density_activation = 2, color_activation = 4;
    double density_scale = 1.0;

    [[nodiscard]] FieldOptions field() const {
        FieldOptions options;
        for (std::size_t end = 0; end < 2; ++end)
            std::copy(box[end].begin(), box[end].end(), options.box[end]);
        options.border = static_cast<Border>(border);
        options.density_activation = static_cast<Activation>(density_activation);
        options.color_activation = static_cast<Activation>(color_activation);
        options.density_scale = density_scale;
        return options;
    }
    [[nodiscard]] MarchOptions march() const {
        return {dt, stop, static_cast<Quadrature>(quadrature)};
    }
};

template <class R>
RayBatch<R> ray_batch(ArrayArgs& args, const py::array& origins, const py::array& directions,
                      const py::array& t0, const py::array& samples) {
    RayBatch<R> rays{};
    rays.origins = args.in<R>("origins", origins, "R 3");
    rays.directions = args.in<R>("directions", directions, "R 3");
    rays.t0 = args.in<R>("t0", t0, "R");
    rays.samples = args.in<std::int32_t>("samples", samples, "R");
    rays.count = args.size("R");
    return rays;
}

}  // namespace photograd
