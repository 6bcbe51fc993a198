// The second pass of photon mapping: camera paths to the first surface that is not specular.
#include "photograd/render/light/photon_map.h"
#include "photograd/render/path/adjoint.h"
#include "photograd/render/path/camera_tracer.h"
#include "photograd/render/path/samples.h"

namespace photograd {
namespace {

/// The radiance that the photons around a surface reflect to a viewer.
Vec3<double> reflected(const PhotonMap& map, const Material<double>& material,
                       const SurfaceHit<double>& hit, const SurfaceSide<double>& side) {
    Vec3<double> sum(0);
    const bool transmits = material.transmits();
    map.for_each_near(hit.position, [&](const Photon& photon) {
        const bool across = dot(photon.back, side.normal) < 0;
        if (!lies_on(photon, across ? -side.normal : side.normal)) return;
        const Vec3<double> wi = side.frame.to_local(photon.back);
        if (!side.agrees(photon.back, wi) || (!transmits && !(side.wo.z * wi.z > 0))) return;
        const double slope = std::abs(wi.z / dot(photon.back, side.normal));
        sum += material.f(side.wo, wi) * photon.flux * slope;
    });
    return sum * map.density();
}

/// The path's radiance, with the estimate of the photon map at its last surface as that surface's
/// emission.
Vec3<double> radiance_of(const PhotonMap& map, const Lane<double>& lane) {
    Path<double> path = lane.path;
    if (path.vertices.empty()) return Vec3<double>(0);
    PathVertex<double>& end = path.vertices.back();
    if (end.kind == VertexKind::surface && !lane.material.sampling().is_specular()) {
        end.Le = end.Le * end.emission_weight +
                 reflected(map, lane.material.sampling(), lane.hit, lane.side);
        end.emission_weight = 1;
    }
    return radiance<double>(path, nullptr);
}

template <bool Media>
void trace_with(const PathScene<double>& scene, const PhotonMap& map, const ThinLens& camera,
                const PathOptions& options, const SampleRange& samples, const PathSums& sums) {
    for_each_chunk(camera, [&](std::int64_t begin, std::int64_t end) {
        PathTracer<double, Media> tracer(scene, options, pixel_spread(camera), true, true);
        trace_samples<double, Media>(
            tracer, scene, camera, options, samples, {}, begin, end,
            [&](std::int64_t pixel, int k) { sums.add(pixel, radiance_of(map, tracer.lane(k))); });
    });
}

}  // namespace

void trace_photons(const PathScene<double>& scene, const PhotonMap& map, const ThinLens& camera,
                   const PathOptions& options, const SampleRange& samples, const PathSums& sums) {
    (scene.geometry->media.any() ? trace_with<true> : trace_with<false>)(scene, map, camera,
                                                                         options, samples, sums);
}

}  // namespace photograd
