// Common to the bindings of all marches: settings, and rays from arrays.
#pragma once

#include <optional>

#include "array_groups.h"
#include "photograd/render/march/lattice.h"
#include "photograd/render/march/march.h"

namespace photograd {

struct MarchSettings {
    FieldOptions field;
    MarchOptions march;
    Lattice lattice = Lattice::origin;
};

using RayArrays = Arrays<4>;  // origins (R, 3), directions (R, 3), t0 (R,), samples (R,) int32

template <class R>
RayBatch<R> ray_batch(ArrayArgs& args, const RayArrays& from) {
    RayBatch<R> rays{};
    rays.origins = args.within<R>("origins", from[0], "R 3", world_limit);
    rays.directions = args.within<R>("directions", from[1], "R 3", world_limit);
    rays.t0 = args.within<R>("t0", from[2], "R", world_limit);
    rays.samples = args.in<std::int32_t>("samples", from[3], "R");
    rays.count = args.size("R");
    for (std::int64_t ray = 0; ray < rays.count; ++ray)
        if (rays.samples[ray] < 0 || rays.samples[ray] > max_samples)
            args.range("samples", "0 to " + std::to_string(max_samples) + " samples of a ray",
                       std::to_string(rays.samples[ray]) + " in row " + std::to_string(ray));
    return rays;
}

/// Arguments of the backward pass of every march besides the field and the rays.
struct MarchCotangentArrays {
    Arrays<3> outputs;  // color, transmittance, depth: what march returned
    Arrays<3> d_outputs;
    std::optional<Arrays<2>> d_rays;  // d_origins, d_directions

    template <class R>
    [[nodiscard]] MarchOutputs<R> read(ArrayArgs& args, MarchAdjoint<R>& adjoint) {
        adjoint = cotangents_from<R, MarchAdjoint<R>>(args, d_outputs, "d_transmittance", "R");
        if (d_rays) {
            adjoint.d_origins = args.out<R>("d_origins", (*d_rays)[0], "R 3");
            adjoint.d_directions = args.out<R>("d_directions", (*d_rays)[1], "R 3");
        }
        return image_from<R, MarchOutputs<R>>(args, outputs, "transmittance", "R");
    }
};

}  // namespace photograd
