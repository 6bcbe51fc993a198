// Free paths in media: distance sampling for a path, transmittance for a shadow ray.
//
// Homogeneous medium. One of the three channels, h, is chosen for a path; distances are sampled as
// t = -ln(1 - u) / sigma_t,h. Each channel could have sampled the same path, so its density is the
// mean over channels (one-sample MIS [Veach1995], spectral MIS [Wilkie2014]) of the product over
// all segments of
//
//   pdf_c = sigma_t,c exp(-sigma_t,c t)  for a scattering event,   exp(-sigma_t,c d)  to get past d
//
// and not the product of means: the throughput is then at most three times that of a path in its
// own channel, however long the path is. `pdf` collects the product on a segment, which may cross
// several media.
//
// Medium with a density grid. Delta tracking [Woodcock1965]: tentative collisions are sampled with
// the majorant sigma_maj everywhere; then exp(-sigma_maj t) is both in density and value and
// cancels. One is a scattering event with probability a_h, a null collision otherwise,
//
//   a_c = clamp(sigma_t,c rho / sigma_maj, 1/20, 19/20)
//
// and the values of the events, divided by a or 1 - a, keep the estimate unbiased. Without the
// clamp no collision would ever be sampled in empty regions, and none passed in saturated ones,
// though a little more or less density there would change the picture: the derivative with respect
// to it would have infinite variance, or be lost. Shadow rays multiply 1 - sigma_t rho / sigma_maj
// at every tentative collision (ratio tracking [Novak2018]).
//
// A medium that only absorbs needs no sampling: homogeneous, exp(-sigma_t t); with a grid, ratio
// tracking.
#pragma once

#include <limits>

#include "photograd/core/log.h"
#include "photograd/core/random.h"
#include "photograd/render/path/record.h"

namespace photograd {

inline constexpr double endless = 1e8;  // meters that light travels where it hits nothing

/// Uniform numbers of one segment: as many as needed, apart from those of the vertices by `step`.
class RandomStream {
public:
    RandomStream() = default;
    RandomStream(RandomKey key, std::uint32_t step) : key_(key) { key_.step = step; }
    template <class R>
    R next() {
        if (used_ % 4 == 0) words_ = random_block(key_, used_ / 4);
        return uniform_from<R>(words_[used_++ % 4]);
    }

private:
    RandomKey key_;
    Philox4 words_{};
    std::uint32_t used_ = 0;
};

/// Density at a point; 1 in a medium without a grid.
template <Real R>
R density_in(const PathGeometry& geometry, const Medium<R>& medium, std::int32_t number,
             const Vec3<R>& position) {
    if (!medium.density) return R(1);
    return density_at(geometry.media.grids[static_cast<std::size_t>(number)], medium.density,
                      position);
}

/// The value of an event in `medium`, with the density `rho` there.
template <Real R>
Vec3<R> event_value(const Medium<R>& medium, const MediumEvent<R>& event, R rho) {
    if (event.kind == EventKind::transmit) return transmittance(medium.sigma_t, event.length);
    const R scale = event.length * rho;
    return event.kind == EventKind::scatter ? medium.albedo * medium.sigma_t * scale
                                            : Vec3<R>(R(1)) - medium.sigma_t * scale;
}

template <Real R>
class FreePathSampler {
public:
    explicit FreePathSampler(const PathScene<R>& scene)
        : scene_(scene), attached_(scene.sampling_is_attached()) {}

    /// A segment under way.
    struct State {
        int channel = 0;
        R first_u = R(-1);  // the number of the first distance; negative: from the stream
        RandomStream stream;
        Vec3<R> pdf{R(1)};      // of what has been sampled, per channel
        Vec3<R> sampled{R(1)};  // product of the events, by the media that are sampled
        EventProduct<R> product;

        R next() {
            const R u = first_u;
            first_u = R(-1);
            return u >= R(0) ? u : stream.template next<R>();
        }
    };

    /// Samples whether and where light is scattered on a stretch of a medium: true with the
    /// distance t.
    bool sample_distance(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction,
                         R distance, State& state, Path<R>& path, R& t) const {
        const Medium<R>& m = scene_.sampling_media[static_cast<std::size_t>(medium)];
        if (!m.phase) {
            add_transmittance(medium, from, direction, distance, state, path);
            return false;
        }
        if (m.density) return delta_tracking(medium, from, direction, distance, state, path, t);
        const R sigma = m.sigma_t[state.channel];
        const R depth = -log(R(1) - state.next());
        t = sigma > R(0) ? depth / sigma : std::numeric_limits<R>::infinity();
        const bool scatters = t < distance;
        const R l = scatters ? t : distance;
        state.pdf *= transmittance(m.sigma_t, l);
        if (scatters) state.pdf *= m.sigma_t;
        add({medium, EventKind::transmit, l}, R(1), state, path);
        if (scatters) add({medium, EventKind::scatter, R(1)}, R(1), state, path);
        return scatters;
    }

    /// The transmittance of a stretch, for a shadow ray.
    void add_transmittance(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction,
                           R distance, State& state, Path<R>& path) const {
        const Medium<R>& m = scene_.sampling_media[static_cast<std::size_t>(medium)];
        if (!m.density) return add({medium, EventKind::transmit, distance}, R(1), state, path);
        R t = R(0);
        clip(medium, from, direction, t, distance);
        if (!(m.sigma_maj > R(0))) return;
        for (t += to_next(m, state); t < distance; t += to_next(m, state)) {
            const Vec3<R> x = from + direction * t;
            add({medium, EventKind::null_collision, R(1) / m.sigma_maj, R(1), x},
                density_in(*scene_.geometry, m, medium, x), state, path);
        }
    }

private:
    bool delta_tracking(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction,
                        R distance, State& state, Path<R>& path, R& t) const {
        const Medium<R>& m = scene_.sampling_media[static_cast<std::size_t>(medium)];
        if (!(m.sigma_maj > R(0))) return false;
        t = R(0);
        clip(medium, from, direction, t, distance);
        for (t += to_next(m, state); t < distance; t += to_next(m, state)) {
            const Vec3<R> x = from + direction * t;
            const R rho = density_in(*scene_.geometry, m, medium, x);
            Vec3<R> a = m.sigma_t * (rho / m.sigma_maj);
            for (int c = 0; c < 3; ++c) a[c] = clamped(a[c], R(0.05), R(0.95));
            const bool scatters = state.next() < a[state.channel];
            state.pdf *= scatters ? a : Vec3<R>(R(1)) - a;
            const EventKind kind = scatters ? EventKind::scatter : EventKind::null_collision;
            add({medium, kind, R(1) / m.sigma_maj, R(1), x}, rho, state, path);
            if (scatters) return true;
        }
        return false;
    }
    /// There are no collisions outside the grid's box.
    void clip(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction, R& t0,
              R& t1) const {
        const auto& grids = scene_.geometry->media.grids;
        grids[static_cast<std::size_t>(medium)].clip(from, direction, t0, t1);
    }
    /// The distance to the next tentative collision.
    static R to_next(const Medium<R>& m, State& state) {
        return -log(R(1) - state.next()) / m.sigma_maj;
    }
    /// `sampled_rho`: density of the medium that is sampled, which may differ from the evaluated
    /// one.
    void add(MediumEvent<R> event, R sampled_rho, State& state, Path<R>& path) const {
        const auto m = static_cast<std::size_t>(event.medium);
        event.density =
            attached_ || event.kind == EventKind::transmit
                ? sampled_rho
                : density_in(*scene_.geometry, scene_.media[m], event.medium, event.position);
        event.value = event_value(scene_.media[m], event, event.density);
        path.add(state.product, event);
        state.sampled *=
            attached_ ? event.value : event_value(scene_.sampling_media[m], event, sampled_rho);
    }

    const PathScene<R>& scene_;
    bool attached_;
};

}  // namespace photograd
