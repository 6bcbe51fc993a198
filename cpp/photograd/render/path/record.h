// A path as it was sampled: vertices, and what happened on the segments between them.
//
// Vertices hold ranges into two lists of the path, so that they are trivially copyable and a path
// is cleared without visiting them. What a path carries follows from this record alone
// (render/path/adjoint.h); the code that samples it is render/path/tracer.h.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "photograd/scene/path_scene.h"

namespace photograd {

/// The end of a segment: a surface; a scattering event in a medium; a surface that the alpha test
/// let the ray through (a null interaction); or none, where lights at infinity are seen.
enum class VertexKind : std::int8_t { surface, medium, null_surface, escaped };

/// An event on a segment. Its value is a factor of the radiance along the segment:
///   transmit         exp(-sigma_t l)                over a length l in a homogeneous medium
///   scatter          albedo sigma_t rho c           the phase function is the vertex's
///   null_collision   1 - sigma_t rho c              in a medium with a density grid [Novak2018]
/// with the density rho, 1 without a grid, and c = 1, or 1 / sigma_maj with a grid.
enum class EventKind : std::int8_t { transmit = 0, scatter = 1, null_collision = 2 };

template <class R>
struct MediumEvent {
    std::int32_t medium;
    EventKind kind;
    R length;          // meters, of `transmit`; c of the others
    R density = R(1);  // rho of what is evaluated
    Vec3<R> position{R(0)}, value{R(0)};
    Vec3<R> before{R(1)};  // product of the events before it
};

/// [first, last) of a list of the path.
struct Range {
    std::int32_t first = 0, last = 0;
    [[nodiscard]] bool empty() const { return first == last; }
};

/// The product of successive events.
template <class R>
struct EventProduct {
    Vec3<R> value{R(1)};
    Range events;
};

template <class R>
struct Segment {
    EventProduct<R> product;
    Vec3<R> pdf{R(1)};  // of a path that has come so far to end its segment here, per channel
    R weight = R(1);    // 1 / mean of pdf: spectral MIS [Wilkie2014]
};

/// A partially opaque surface on a shadow ray.
template <class R>
struct Occluder {
    std::int32_t material;
    Vec2<R> uv;
    R transmittance;  // 1 - alpha
};

/// The sample of next event estimation at a vertex.
template <class R>
struct EmitterSample {
    std::int32_t shape = SceneLights::none;  // that emits, or SceneLights::background or ::delta
    std::int32_t light = -1;                 // number of a light that is no shape
    Vec3<R> point{R(0)};                     // that is lit
    Vec3<R> direction{R(0)}, wi{R(0)};       // world, shading frame
    Vec2<R> uv{R(0)};                        // of the shape that emits, where it has a texture
    Vec3<R> f{R(0)};
    Vec3<R> Le{R(0)};  // radiance, or the irradiance of a delta light
    Range occluders;
    R alpha_transmittance = R(1);   // product over the occluders
    EventProduct<R> shadow;         // transmittance of the media on the shadow ray
    R weight = R(0);                // 0: not sampled, or blocked
    R pdf = R(0), bsdf_pdf = R(0);  // of this direction: by emitter sampling, by the BSDF
};

template <class R>
struct PathVertex {
    VertexKind kind = VertexKind::escaped;
    std::int32_t shape = SceneLights::background;
    std::int32_t medium = MediaGeometry::vacuum;  // that scatters here
    Segment<R> arrival;
    Vec3<R> direction{R(0)};   // world, of the ray that arrived here
    Vec2<R> uv{R(0)};          // where the material or the emission has a texture
    Footprint<R> footprint{};  // around it, where any texture has mip maps
    Vec3<R> Le{R(0)};          // emitted towards the vertex before
    R emission_weight = R(0);
    R pdf = R(0);          // of `direction` by the BSDF before; 0: no density (camera, specular)
    R emitter_pdf = R(0);  // of it by emitter sampling; 0: nothing to be sampled
    EmitterSample<R> nee;
    Vec3<R> wo{R(0)}, wi{R(0)};  // shading frame; wi: where the path continues
    Vec3<R> f{R(0)};             // value of the BSDF or phase function, or a specular lobe's weight
    int lobe = -1;
    R opacity_weight = R(1), d_opacity = R(0);  // c of everything here, dc/dalpha
    R weight = R(0);                            // of f; 0: the path ends here
    R survival = R(1);  // probability of Russian roulette, which `weight` is divided by
};

template <class R>
struct Path {
    std::vector<PathVertex<R>> vertices;
    std::vector<MediumEvent<R>> events;
    std::vector<Occluder<R>> occluders;

    void clear() {
        vertices.clear();
        events.clear();
        occluders.clear();
    }
    [[nodiscard]] EventProduct<R> start_product() const {
        const auto now = static_cast<std::int32_t>(events.size());
        return {Vec3<R>(R(1)), {now, now}};
    }
    /// Appends an event to the product that is under way.
    void add(EventProduct<R>& product, MediumEvent<R> event) {
        event.before = product.value;
        product.value *= event.value;
        events.push_back(event);
        product.events.last = static_cast<std::int32_t>(events.size());
    }
};

static_assert(std::is_trivially_copyable_v<PathVertex<float>>);

}  // namespace photograd
