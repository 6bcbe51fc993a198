// How far light goes in a medium: sampled for a path, estimated for a shadow ray.
//
// Even medium. One of the three channels, h, is chosen for a path; collisions are drawn at t = -ln(1 - u) / sigma_t,h. The
// other channels could have drawn the same path as well, so its density is the mean over channels (one-sample multiple
// importance sampling [Veach1995, Wilkie2014]): the mean of products over all segments,
//
//   q_c = sigma_t,c exp(-sigma_t,c t)  for a collision,     exp(-sigma_t,c d)  to get past d
//
// and not the product of means: what a path carries is then at most three times what it would in its own channel,
// however long it is. `chance` collects the product on a segment, which may cross several media.
//
// Medium with a grid. Delta tracking [Woodcock1965]: collisions are drawn as if sigma_maj were everywhere; then
// exp(-sigma_maj t) is both in density and value and cancels. One is real with probability a_h, null otherwise,
//
//   a_c = clamp(sigma_t,c rho / sigma_maj, 1/20, 19/20)
//
// and the steps' values, divided by a or 1 - a, keep the mean right. Without the clamp nothing would ever be drawn in
// empty places, nor pass in saturated ones, though a little more or less density there would change the picture:
// derivatives by it would have an infinite variance, or be lost. Shadow rays multiply 1 - sigma_t rho / sigma_maj
// at every collision (ratio tracking [Novak2018]).
//
// A medium that only absorbs has nothing to draw: even, it is exp(-sigma_t t); with a grid, ratio tracking.
#pragma once

#include <limits>

#include "photograd/core/log.h"
#include "photograd/render/volume_vertex.h"

namespace photograd {

inline constexpr double endless = 1e8;  // metres that light goes where it meets nothing

/// Uniform numbers of one segment: as many as needed, apart from those of the vertices by `step`.
class FlightNumbers {
public:
    FlightNumbers() = default;
    FlightNumbers(RandomKey key, std::uint32_t step) : key_(key) { key_.step = step; }
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

template <Real R>
class FreeFlight {
public:
    explicit FreeFlight(const PathScene<R>& scene) : scene_(scene) {}

    /// A segment under way.
    struct State {
        int channel = 0;
        R first_u = R(0);  // the number of the first distance; negative once used
        FlightNumbers numbers;
        Vec3<R> chance{R(1)};   // of what has been drawn, by each channel
        Vec3<R> carried{R(1)};  // product of the steps, as `sampling` has it
        StepProduct<R> product;

        R next() {
            const R u = first_u;
            first_u = R(-1);
            return u >= R(0) ? u : numbers.template next<R>();
        }
    };

    /// Draws where on a stretch of a medium light is scattered: true with the distance, or false if nowhere.
    bool fly(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction, R distance,
             State& state, MediaTrail<R>& trail, R& t) const {
        const Medium<R>& m = scene_.sampling_media[static_cast<std::size_t>(medium)];
        if (!m.phase) {
            absorb(medium, from, direction, distance, state, trail);
            return false;
        }
        if (m.density) return track(medium, from, direction, distance, state, trail, t);
        const R sigma = m.sigma_t[state.channel];
        const R depth = -log(R(1) - state.next());
        t = sigma > R(0) ? depth / sigma : std::numeric_limits<R>::infinity();
        const bool collides = t < distance;
        const R l = collides ? t : distance;
        state.chance *= transmittance(m.sigma_t, l);
        if (collides) state.chance *= m.sigma_t;
        step({medium, StepKind::through, l}, state, trail);
        if (collides) step({medium, StepKind::collide, R(1)}, state, trail);
        return collides;
    }

    /// What a shadow ray loses on a stretch.
    void absorb(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction, R distance,
                State& state, MediaTrail<R>& trail) const {
        const Medium<R>& m = scene_.sampling_media[static_cast<std::size_t>(medium)];
        if (!m.density) return step({medium, StepKind::through, distance}, state, trail);
        R at = R(0);
        clip(medium, from, direction, at, distance);
        if (!(m.sigma_maj > R(0))) return;
        for (at += to_next(m, state); at < distance; at += to_next(m, state))
            step({medium, StepKind::pass, R(1) / m.sigma_maj, from + direction * at}, state, trail);
    }

private:
    bool track(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction, R distance,
               State& state, MediaTrail<R>& trail, R& t) const {
        const Medium<R>& m = scene_.sampling_media[static_cast<std::size_t>(medium)];
        if (!(m.sigma_maj > R(0))) return false;
        t = R(0);
        clip(medium, from, direction, t, distance);
        for (t += to_next(m, state); t < distance; t += to_next(m, state)) {
            const Vec3<R> x = from + direction * t;
            const R scale = density_in(*scene_.geometry, m, medium, x) / m.sigma_maj;
            Vec3<R> a = m.sigma_t * scale;
            for (int c = 0; c < 3; ++c) a[c] = clamped(a[c], R(0.05), R(0.95));
            const bool real = state.next() < a[state.channel];
            state.chance *= real ? a : Vec3<R>(R(1)) - a;
            step({medium, real ? StepKind::collide : StepKind::pass, R(1) / m.sigma_maj, x}, state,
                 trail);
            if (real) return true;
        }
        return false;
    }
    /// Nothing collides outside the grid's box.
    void clip(std::int32_t medium, const Vec3<R>& from, const Vec3<R>& direction, R& t0,
              R& t1) const {
        scene_.geometry->media.grids[static_cast<std::size_t>(medium)].clip(from, direction, t0,
                                                                            t1);
    }
    /// How far it is to the next collision, real or null.
    static R to_next(const Medium<R>& m, State& state) {
        return -log(R(1) - state.next()) / m.sigma_maj;
    }
    void step(MediumStep<R> one, State& state, MediaTrail<R>& trail) const {
        const auto m = static_cast<std::size_t>(one.medium);
        one.value = step_value(*scene_.geometry, scene_.media[m], one);
        trail.add(state.product, one);
        state.carried *= scene_.drawn_as_sampled()
                             ? one.value
                             : step_value(*scene_.geometry, scene_.sampling_media[m], one);
    }

    const PathScene<R>& scene_;
};

}  // namespace photograd
