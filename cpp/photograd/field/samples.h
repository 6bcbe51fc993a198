// Samples as a marcher hands them to a field: groups of lane_count consecutive samples of one ray.
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "photograd/core/lanes.h"
#include "photograd/core/real.h"
#include "photograd/ops/activation.h"
#include "photograd/ops/trilinear.h"

namespace photograd {

/// One batch of samples. Lanes from used[g] on are padding behind the end of a ray: they are
/// evaluated, their extinction is then set to zero, and nothing is accumulated for them.
template <Real R>
struct SampleBatch {
    std::vector<Lanes<R>> t;
    std::vector<Lanes<R>> position[3];
    std::vector<R> direction[3];  // of the ray: unit, away from the camera
    std::vector<int> used;
    std::vector<std::uint32_t> ray;  // which of the chunk's, from 0 on

    [[nodiscard]] std::size_t groups() const { return t.size(); }
    void resize(std::size_t groups) {
        t.resize(groups);
        for (auto& axis : position) axis.resize(groups);
        for (auto& axis : direction) axis.resize(groups);
        used.resize(groups);
        ray.resize(groups);
    }
};

/// Extinction (1/m) and radiance of a batch.
template <Real R>
struct SampleValues {
    std::vector<Lanes<R>> sigma_t;
    std::vector<Lanes<R>> rgb[3];

    void assign_zero(std::size_t groups) {
        sigma_t.assign(groups, Lanes<R>{});
        for (auto& channel : rgb) channel.assign(groups, Lanes<R>{});
    }
};

/// Options of all fields; a field may ignore some.
struct FieldOptions {
    double box[2][3] = {{-1, -1, -1}, {1, 1, 1}};  // world, meters
    Border border = Border::clamp;
    Activation density_activation = Activation::softplus;
    Activation color_activation = Activation::sigmoid;
    double density_scale = 1.0;  // 1/m: sigma_t = density_scale * density_activation(raw)
};

/// A radiance field: batch calls, never virtual per sample. `Cache` is what backward needs of eval,
/// and `Sink` collects parameter gradients for a slab of rays; the marcher calls sink.finish()
/// after it. backward adds to d_position[axis] (a set of lanes a group) and, if the color depends
/// on the direction, to d_direction[axis] (a number a group), unless they are null.
template <class F>
concept Field =
    requires(const F field, const SampleBatch<typename F::Scalar>& batch, typename F::Cache& cache,
             SampleValues<typename F::Scalar>& values, typename F::Sink& sink, int chunk,
             std::vector<Lanes<typename F::Scalar>>* d_position,
             std::vector<typename F::Scalar>* d_direction) {
        { F::name } -> std::convertible_to<const char*>;
        field.eval(batch, cache, values);
        field.backward(batch, cache, values, sink, chunk, d_position, d_direction);
        sink.begin(int{});
        sink.finish();
    };

}  // namespace photograd
