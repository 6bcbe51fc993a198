// The part of render/path_tangent.h that lies between surfaces: steps through media, and collisions.
#include "photograd/medium/any_phase_tangent.h"
#include "photograd/render/path_tangent.h"

namespace photograd {
namespace {

/// t(x) of one step: step_backward's derivatives, each times how its parameter changes.
Vec3<double> step_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                          const MediumStep<double>& step) {
    const auto m = static_cast<std::size_t>(step.medium);
    const Medium<double>&medium = scene.media[m], &change = along.media[m];
    if (step.kind == StepKind::through) return -change.sigma_t * step.value * step.length;
    const auto density = [&](const Medium<double>& of) {
        return density_at(scene.geometry->media.grids[m], of.density, step.position);
    };
    const double rho = medium.density ? density(medium) : 1.0;
    const double d_rho = medium.density ? density(change) : 0.0;
    const Vec3<double> d_sigma = (change.sigma_t * rho + medium.sigma_t * d_rho) * step.length;
    if (step.kind == StepKind::pass) return -d_sigma;
    return change.albedo * medium.sigma_t * (rho * step.length) + medium.albedo * d_sigma;
}

}  // namespace

Vec3<double> PathTangent::product(const MediaTrail<double>& trail,
                                  const StepProduct<double>& steps) const {
    Vec3<double> t(0);
    for (std::int32_t i = steps.first; i < steps.last; ++i) {
        const MediumStep<double>& step = trail.steps[static_cast<std::size_t>(i)];
        t = t * step.value + step.before * step_tangent(scene_, along_, step);
    }
    return t;
}

Vec3<double> PathTangent::scattered(const PathVertex<double>& v, std::int32_t medium,
                                    const Vec3<double>& ahead, const Vec3<double>& lit) const {
    const auto m = static_cast<std::size_t>(medium);
    const auto t = [&](const Vec3<double>& wi) {
        return phase_tangent(*scene_.media[m].phase, *along_.media[m].phase, dot(v.direction, wi));
    };
    Vec3<double> sum(0);
    if (v.weight > 0) sum += ahead * (t(v.wi) * v.weight);
    if (v.light.weight > 0) sum += lit * (t(v.light.wi) * v.light.weight * v.light.through);
    return sum;
}

PathTangent::Pair PathTangent::gather_through(const Path<double>& path,
                                              const MediaTrail<double>& trail) const {
    Pair L{Vec3<double>(0), Vec3<double>(0)};
    for (std::size_t k = path.size(); k-- > 0;) {
        const PathVertex<double>& v = path[k];
        const MediumVertex<double>& m = trail.vertices[k];
        Pair lit = from_light(v.light);
        if (v.light.weight > 0)
            lit = {lit.value * m.shadow.value,
                   lit.tangent * m.shadow.value + lit.value * product(trail, m.shadow)};
        L = leaving(v, m.medium, L, lit, uncovered(v, m, L.value));
        L.tangent = (L.tangent * m.arrival.value + L.value * product(trail, m.arrival)) * m.weight;
        L.value *= m.arrival.value * m.weight;
    }
    return L;
}

}  // namespace photograd
