// What the bindings of all marches share: settings, and rays from arrays.
#pragma once

#include <array>

#include "array_args.h"
#include "photograd/render/march/lattice.h"
#include "photograd/render/march/march.h"

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
    rays.origins = args.within<R>("origins", origins, "R 3", world_limit);
    rays.directions = args.within<R>("directions", directions, "R 3", world_limit);
    rays.t0 = args.within<R>("t0", t0, "R", world_limit);
    rays.samples = args.in<std::int32_t>("samples", samples, "R");
    rays.count = args.size("R");
    for (std::int64_t ray = 0; ray < rays.count; ++ray)
        if (rays.samples[ray] < 0 || rays.samples[ray] > most_samples)
            args.range("samples", "0 to " + std::to_string(most_samples) + " samples of a ray",
                       std::to_string(rays.samples[ray]) + " in row " + std::to_string(ray));
    return rays;
}

}  // namespace photograd
