// A path through media: what happens between its vertices, and the derivative of that.
//
// Vertices are those of path_vertex.h, and a new kind, collisions with a medium's particles, whose value f is the phase
// function. On its way from vertex k - 1 to vertex k, and on its way from a light, radiance is multiplied by a product of
// steps,
//
//   through    exp(-sigma_t l)                 a stretch of length l in an even medium
//   collide    albedo sigma_t rho c            scattered here; the phase function is the vertex's
//   pass       1 - sigma_t rho c               in a medium with a grid: a collision that was none [Novak2018]
//
// (rho: density, 1 without a grid; c: 1, or 1 / sigma_maj with a grid.) With P_k the product on the segment that arrives
// at vertex k, s'_k its weight, P^l_k the product on the way from the light, the sum of path_vertex.h becomes [Kajiya1984]
//
//   L_k = w_k Le_k + w^l_k f^l_k P^l_k L^l_k + s_k f_k s'_{k+1} P_{k+1} L_{k+1},        L = s'_0 P_0 L_0
//
// and, as there, a surface that covers only in part gives L_k a factor c_k, and veils before a light give L^l_k one.
// s' is 1 / pdf of where the segment ended (free_flight.h), detached as all weights are. The derivatives, for d = dL/d(product):
//
//   dL/dstep_i = d (product of the other steps), from both ends, without a division: a step may be 0
//   through:  dstep/dsigma_t = -l step
//   collide:  dstep/dsigma_t = albedo rho c,    dstep/dalbedo = sigma_t rho c,    dstep/drho = sum over channels albedo sigma_t c
//   pass:     dstep/dsigma_t = -rho c,          dstep/drho = -sum over channels sigma_t c
#pragma once

#include "photograd/render/path_vertex.h"

namespace photograd {

enum class StepKind : std::int8_t { through = 0, collide = 1, pass = 2 };

template <class R>
struct MediumStep {
    std::int32_t medium;
    StepKind kind;
    R length;  // metres, of `through`; c of the others
    Vec3<R> position{R(0)}, value{R(0)};
    Vec3<R> before{R(1)};  // product of the steps before it
};

/// A product of steps, which stand one after another in the path's list.
template <class R>
struct StepProduct {
    Vec3<R> value{R(1)};
    std::int32_t first = 0, last = 0;
};

/// What media do to vertex k of a path.
template <class R>
struct MediumVertex {
    std::int32_t medium = MediaGeometry::vacuum;  // that scatters here, if it is no surface
    StepProduct<R> arrival, shadow;
    /// That a path which has come so far ends its segment here, by the channel that draws.
    Vec3<R> chance{R(1)};
    R weight = R(1);  // 1 / mean of `chance`
};

template <class R>
struct MediaTrail {
    std::vector<MediumVertex<R>> vertices;  // of the path's vertices
    std::vector<MediumStep<R>> steps;

    void clear() {
        vertices.clear();
        steps.clear();
    }
    [[nodiscard]] StepProduct<R> start() const {
        const auto now = static_cast<std::int32_t>(steps.size());
        return {Vec3<R>(R(1)), now, now};
    }
    /// Appends a step to the product that is under way.
    void add(StepProduct<R>& product, MediumStep<R> step) {
        step.before = product.value;
        product.value *= step.value;
        steps.push_back(step);
        product.last = static_cast<std::int32_t>(steps.size());
    }
};

/// Density where a step is; 1 in a medium without a grid.
template <Real R>
R density_in(const PathGeometry& geometry, const Medium<R>& medium, std::int32_t number,
             const Vec3<R>& position) {
    if (!medium.density) return R(1);
    return density_at(geometry.media.grids[static_cast<std::size_t>(number)], medium.density,
                      position);
}

/// The value of a step in `medium`, which has this number.
template <Real R>
Vec3<R> step_value(const PathGeometry& geometry, const Medium<R>& medium,
                   const MediumStep<R>& step) {
    if (step.kind == StepKind::through) return transmittance(medium.sigma_t, step.length);
    const R scale = step.length * density_in(geometry, medium, step.medium, step.position);
    return step.kind == StepKind::collide ? medium.albedo * medium.sigma_t * scale
                                          : Vec3<R>(R(1)) - medium.sigma_t * scale;
}
template <Real R>
void step_backward(const PathScene<R>& scene, const MediumStep<R>& step, const Vec3<R>& d_value,
                   PathGradient<R>& d_scene) {
    const auto m = static_cast<std::size_t>(step.medium);
    const Medium<R>& medium = scene.media[m];
    Medium<R>& d_medium = d_scene.media[m];
    if (step.kind == StepKind::through) {
        d_medium.sigma_t -= d_value * step.value * step.length;
        return;
    }
    const R scale = step.length * density_in(*scene.geometry, medium, step.medium, step.position);
    Vec3<R> d_density = -d_value * medium.sigma_t;
    if (step.kind == StepKind::collide) {
        d_medium.sigma_t += d_value * medium.albedo * scale;
        d_medium.albedo += d_value * medium.sigma_t * scale;
        d_density *= -medium.albedo;
    } else {
        d_medium.sigma_t -= d_value * scale;
    }
    if (!medium.density) return;
    DensityAdjoint<R>& seen = d_scene.densities[m];
    for (int k = 0; k < 3; ++k) seen.world.push_back(step.position[k]);
    seen.d_density.push_back((d_density.x + d_density.y + d_density.z) * step.length);
}

/// Adds the derivatives of <d_product, product of the steps>.
template <Real R>
void product_backward(const PathScene<R>& scene, const MediaTrail<R>& trail,
                      const StepProduct<R>& product, const Vec3<R>& d_product,
                      PathGradient<R>& d_scene) {
    Vec3<R> d = d_product;  // times the steps behind the one at hand
    for (std::int32_t i = product.last; i-- > product.first;) {
        const MediumStep<R>& step = trail.steps[static_cast<std::size_t>(i)];
        step_backward(scene, step, d * step.before, d_scene);
        d *= step.value;
    }
}

/// What a vertex has but for c_k, as in path_vertex.h. `ahead` is s'_{k+1} P_{k+1} L_{k+1}.
template <Real R>
Vec3<R> uncovered(const PathVertex<R>& v, const MediumVertex<R>& m, const Vec3<R>& ahead) {
    Vec3<R> L = ahead * (v.value * v.weight);
    if (v.light.weight > R(0))
        L += v.light.f * v.light.sent * m.shadow.value * (v.light.weight * v.light.through);
    if (v.emission_weight > R(0)) L += v.emitted * v.emission_weight;
    return L;
}

/// L. Fills leaving[k] with L_k, which the derivative needs, unless it is null.
template <Real R>
Vec3<R> gather_through(const Path<R>& path, const MediaTrail<R>& trail, Vec3<R>* leaving) {
    Vec3<R> L(R(0));
    for (std::size_t k = path.size(); k-- > 0;) {
        const MediumVertex<R>& m = trail.vertices[k];
        L = uncovered(path[k], m, L) * path[k].coverage;
        if (leaving) leaving[k] = L;
        L *= m.arrival.value * m.weight;
    }
    return L;
}

/// The same as `surface_backward` where a medium scatters: f is p of the angle between two directions of travel.
template <Real R>
void collision_backward(const PathScene<R>& scene, const PathVertex<R>& v, std::int32_t number,
                        const Vec3<R>& d_light, const Vec3<R>& d_onward, PathGradient<R>& d_scene) {
    const auto m = static_cast<std::size_t>(number);
    const AnyPhase<R>& phase = *scene.media[m].phase;
    AnyPhase<R>& d_phase = *d_scene.media[m].phase;
    if (v.light.weight > R(0))
        phase.p_backward(dot(v.direction, v.light.wi), d_light.x + d_light.y + d_light.z, d_phase);
    if (v.weight > R(0))
        phase.p_backward(dot(v.direction, v.wi), d_onward.x + d_onward.y + d_onward.z, d_phase);
}

/// Adds the derivatives of <d_L, L> to d_scene; `leaving` as gather_through has filled it.
template <Real R>
void gather_through_backward(const PathScene<R>& scene, const Path<R>& path,
                             const MediaTrail<R>& trail, const Vec3<R>* leaving, Vec3<R> d_L,
                             PathGradient<R>& d_scene) {
    for (std::size_t k = 0; k < path.size(); ++k) {
        const PathVertex<R>& v = path[k];
        const MediumVertex<R>& m = trail.vertices[k];
        product_backward(scene, trail, m.arrival, d_L * leaving[k] * m.weight, d_scene);
        d_L *= m.arrival.value * m.weight;
        const bool goes_on = v.weight > R(0) && k + 1 < path.size();
        Vec3<R> ahead(R(0));
        if (goes_on) {
            const MediumVertex<R>& next = trail.vertices[k + 1];
            ahead = leaving[k + 1] * next.arrival.value * next.weight;
        }
        const R d_coverage =
            v.coverage_slope == R(0) ? R(0) : dot(d_L, uncovered(v, m, ahead)) * v.coverage_slope;
        d_L *= v.coverage;
        if (v.emission_weight > R(0))
            emitted_backward(scene, v.shape, v.uv, v.direction, d_L * v.emission_weight, d_scene);
        if (v.shape == SceneLights::background) return;
        Vec3<R> d_light = d_L * (v.light.weight * v.light.through);
        if (v.light.weight > R(0)) {
            if (!v.light.veils.empty())
                veils_backward(scene, v.light,
                               dot(d_L, v.light.f * v.light.sent * m.shadow.value) * v.light.weight,
                               d_scene);
            product_backward(scene, trail, m.shadow, d_light * v.light.f * v.light.sent, d_scene);
            d_light *= m.shadow.value;
            sent_backward(scene, v.light, d_light * v.light.f, d_scene);
            d_light *= v.light.sent;
        }
        const Vec3<R> d_onward = d_L * v.weight * ahead;
        if (v.shape >= 0)
            surface_backward(scene, v, d_light, d_onward, d_coverage, d_scene);
        else
            collision_backward(scene, v, m.medium, d_light, d_onward, d_scene);
        if (!goes_on) return;
        d_L *= v.value * v.weight;
    }
}

}  // namespace photograd
