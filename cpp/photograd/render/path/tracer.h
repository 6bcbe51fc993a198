// The path tracer: samples sixteen paths side by side and records their vertices.
//
// One loop for all: each round finds what the rays hit, makes a vertex there, samples an emitter
// (next event estimation) and casts its shadow ray, then samples the BSDF or phase function for the
// next segment; Russian roulette [Arvo1990] ends paths of little throughput. What is sampled
// depends on `scene.sampling` and on random numbers that are a function of seed, pixel, sample and
// vertex (sampling/dimensions.h). Nothing is summed up here: see render/path/adjoint.h.
//
// With media, a segment ends at the first of three: a scattering event, which is a vertex; a
// surface, which is one, too; or a boundary between media, which is none: the ray continues behind
// it, and paths reach their vertices in different rounds. Weights of multiple importance sampling
// compare the densities of directions alone: both strategies have to get through the same media,
// and any weights that add up to 1 are right.
//
// With Transport::importance paths start at emitters (render/light/particles.h) and scatter by the
// adjoint BSDF (render/path/scatter.h); a visitor counts them on their way.
#pragma once

#include <algorithm>

#include "photograd/render/path/direct.h"
#include "photograd/render/path/particle_visitor.h"
#include "photograd/render/path/russian_roulette.h"
#include "photograd/render/path/transport.h"

namespace photograd {

/// Media: whether the scene has any; without, their code is not compiled in.
template <Real R, bool Media, Transport Mode = Transport::radiance>
class PathTracer {
    using Dims = PathDimensions<Mode>;
    static constexpr bool radiance = Mode == Transport::radiance;

public:
    static constexpr int width = trace_width;

    /// `pixel_spread`: how much wider what a pixel sees becomes per meter, for mip maps.
    /// `stop_when_black` gives up paths whose throughput is 0: right for a picture, wrong for a
    /// derivative. `stop_at_surfaces`: paths end at the first surface that is not specular, where
    /// no emitter is sampled.
    PathTracer(const PathScene<R>& scene, const PathOptions& options, R pixel_spread,
               bool stop_when_black, bool stop_at_surfaces = false)
        : scene_(scene),
          options_(options),
          direct_(scene, options_, stop_when_black),
          free_path_(scene),
          stop_when_black_(stop_when_black),
          stop_at_surfaces_(stop_at_surfaces),
          mips_(radiance && scene.geometry->textures.any_mips()),
          escape_segment_(escape_segment(scene, options, stop_when_black && !stop_at_surfaces)),
          pixel_spread_(pixel_spread),
          sampler_(options.sampler) {}
    PathTracer(const PathTracer&) = delete;
    PathTracer& operator=(const PathTracer&) = delete;

    /// Samples the paths of `count` <= 16 starts; they are then in path(0), path(1), ...
    void trace(const PathStart<R>* starts, int count, ParticleVisitor* visitor = nullptr) {
        visitor_ = visitor;
        if constexpr (std::is_same_v<R, float> && radiance && !Media)
            trace_inlined(starts, count);
        else
            trace_all(starts, count);
    }
    [[nodiscard]] const Path<R>& path(int k) const { return lanes_[k].path; }
    /// Where path k has ended.
    [[nodiscard]] const Lane<R>& lane(int k) const { return lanes_[k]; }

private:
    const PathGeometry& geometry() const { return *scene_.geometry; }

    void trace_all(const PathStart<R>* starts, int count) {
        for (int k = 0; k < width; ++k) {
            lanes_[k].alive = k < count && starts[k].exists;
            if (lanes_[k].alive) start(lanes_[k], starts[k]);
        }
        for (int segment = 1; segment == escape_segment_ ? escape() : next_vertices(segment);
             ++segment) {
            if (radiance && direct_.has_direct()) direct_.sample(lanes_, sampler_);
            for (Lane<R>& lane : lanes_)
                if (lane.alive && lane.at_vertex) continue_path(lane);
        }
    }
    /// Everything inline. gcc stops by itself when a function has become large, which costs a
    /// seventh of the time; this takes 10 s to compile, so only the usual pictures have it.
    [[gnu::flatten]] void trace_inlined(const PathStart<R>* starts, int count) {
        trace_all(starts, count);
    }

    void start(Lane<R>& lane, const PathStart<R>& at) {
        lane.path.clear();
        lane.key = at.key;
        lane.ray = at.ray;
        lane.previous = at.ray.origin;
        lane.beta = Vec3<R>(R(1));
        lane.pdf = R(0);
        lane.cone = {R(0), pixel_spread_};
        lane.counted = false;
        if (radiance && geometry().bvh.moves())
            lane.time = static_cast<float>(uniform_from<double>(
                sampler_(lane.key, dimensions::shutter_block)[dimensions::shutter]));
        if constexpr (Media) {
            lane.stack = at.stack;
            lane.channel_pdf = Vec3<R>(R(1));
            lane.channel = std::min(2, static_cast<int>(3 * number(lane, Dims::channel())));
            begin_segment(lane, at.ray.origin);
        }
    }
    R number(const Lane<R>& lane, const Dimension& dimension) {
        return uniform_from<R>(sampler_(lane.key, dimension.block)[dimension.word]);
    }

    // Segments -----------------------------------------------------------------------------------

    void begin_segment(Lane<R>& lane, const Vec3<R>& from) {
        const auto k = static_cast<std::uint32_t>(lane.path.vertices.size());
        lane.from = from;
        lane.segment = {};
        lane.segment.channel = lane.channel;
        if constexpr (radiance)
            lane.segment.first_u =
                number(lane, {dimensions::first_distance_block(k), dimensions::first_distance});
        lane.segment.stream = RandomStream(lane.key, Dims::segment_step(k));
        lane.segment.product = lane.path.start_product();
        lane.boundaries = 0;
        lane.counted = false;
    }

    /// The ray of each lane.
    auto rays() const {
        return [this](int k, RayQuery<R>& query) {
            const Lane<R>& lane = lanes_[k];
            if (lane.alive) query = {lane.ray.origin, lane.ray.direction, lane.time};
            return lane.alive;
        };
    }
    /// Follows all rays; false if no path continues.
    bool next_vertices(int segment) {
        PacketHits found;
        const bool coherent = radiance && !Media && segment == 1;
        if (!closest16<R>(geometry().bvh, coherent, rays(), found)) return false;
        for (int k = 0; k < width; ++k) {
            Lane<R>& lane = lanes_[k];
            if (!lane.alive) continue;
            const bool hits = found.primitive[k] >= 0;
            if (hits)
                lane.hit = surface_hit(geometry(), lane.ray, found.instance[k], found.primitive[k],
                                       found.t[k], lane.time);
            follow(k, lane, hits);
        }
        return std::any_of(lanes_, lanes_ + width, [](const Lane<R>& lane) { return lane.alive; });
    }

    /// The last segment of a picture in which no shape emits: only rays that escape find light.
    bool escape() {
        bool blocked[width];
        occluded16<R>(geometry().bvh, rays(), blocked);
        for (int k = 0; k < width; ++k) {
            Lane<R>& lane = lanes_[k];
            if (lane.alive && !blocked[k]) add_escaped_vertex(lane);
            lane.alive = false;
        }
        return false;
    }
    /// On which segment that is, or 0.
    static int escape_segment(const PathScene<R>& scene, const PathOptions& options, bool picture) {
        if (!radiance || Media || !picture || options.max_depth < 2) return 0;
        const R* end = scene.emission + 3 * scene.geometry->shape_count();
        return std::find_if(scene.emission, end, [](R x) { return x != R(0); }) == end
                   ? options.max_depth
                   : 0;
    }

    /// Goes along a ray, up to a surface or without end.
    void follow(int k, Lane<R>& lane, bool hits) {
        lane.at_vertex = false;
        // A ray that hits nothing is in no shape, whatever rounding at edges has made of the stack.
        std::int32_t medium = MediaGeometry::vacuum;
        if constexpr (Media)
            medium = hits ? lane.stack.medium(geometry().media) : geometry().media.world;
        R distance = !Media ? R(0) : hits ? length(lane.hit.position - lane.from) : R(endless);
        if constexpr (!radiance)
            if (visitor_ && !lane.counted && !count(k, lane, hits, medium, distance))
                return add_medium_vertex(lane, medium);
        if (!travel(lane, medium, distance)) return add_medium_vertex(lane, medium);
        if constexpr (Media)
            if (hits && is_boundary(geometry(), lane.hit.shape)) return cross_boundary(lane);
        hits ? add_surface_vertex(k, lane) : add_escaped_vertex(lane);
    }
    /// Goes `distance` on in a medium; false, at a scattering event, if it does not come so far.
    bool travel(Lane<R>& lane, std::int32_t medium, R distance) {
        if (!Media || medium < 0) return true;
        R t = R(0);
        const bool scatters = free_path_.sample_distance(medium, lane.from, lane.ray.direction,
                                                         distance, lane.segment, lane.path, t);
        lane.from += lane.ray.direction * (scatters ? t : distance);
        return !scatters;
    }
    /// Free paths have no memory, so a segment that passes a sensor is sampled in two: up to it,
    /// where what is left is counted, and on from there. False at a scattering event before.
    bool count(int k, Lane<R>& lane, bool hits, std::int32_t medium, R& distance) {
        const R clear =
            hits ? length(lane.hit.position - lane.ray.origin) : std::numeric_limits<R>::infinity();
        R t = visitor_->intersect(lane.ray, clear);
        if (!(t >= R(0))) return true;
        Vec3<R> beta = lane.beta;
        if constexpr (Media) {
            t += dot(lane.ray.origin - lane.from, lane.ray.direction);
            if (!travel(lane, medium, t)) return false;
            distance = std::max(distance - t, R(0));
            const Segment<R> so_far = segment_of(lane);
            beta *= so_far.product.value * so_far.weight;
        }
        visitor_->splat(k, beta);
        lane.counted = Media;  // without media the segment ends here
        return true;
    }
    void cross_boundary(Lane<R>& lane) {
        cross_straight(geometry(), lane.hit, lane.ray.direction, lane.stack, lane.from,
                       lane.ray.origin);
        lane.alive = ++lane.boundaries <= max_boundaries;
    }
    [[nodiscard]] Segment<R> segment_of(const Lane<R>& lane) const {
        const Vec3<R> pdf = lane.channel_pdf * lane.segment.pdf;
        return {lane.segment.product, pdf, R(3) / (pdf.x + pdf.y + pdf.z)};
    }

    // Vertices -----------------------------------------------------------------------------------

    PathVertex<R>& add_vertex(Lane<R>& lane, VertexKind kind, std::int32_t shape) {
        static constexpr PathVertex<R> blank{};  // copied: faster than number by number
        PathVertex<R>& v = lane.path.vertices.emplace_back(blank);
        v.kind = kind;
        v.shape = shape;
        v.direction = lane.ray.direction;
        v.pdf = lane.pdf;
        if constexpr (Media) {
            v.arrival = segment_of(lane);
            lane.channel_pdf = v.arrival.pdf * v.arrival.weight;
            lane.beta *= lane.segment.sampled * v.arrival.weight;
        }
        lane.at_vertex = true;
        lane.alive = static_cast<int>(lane.path.vertices.size()) < options_.max_depth &&
                     !(stop_when_black_ && is_black(lane.beta));
        return v;
    }
    void add_escaped_vertex(Lane<R>& lane) {
        lane.alive = options_.background || !lane.path.vertices.empty();
        if (!lane.alive) return;
        PathVertex<R>& v = add_vertex(lane, VertexKind::escaped, SceneLights::background);
        lane.alive = false;
        if constexpr (radiance) {
            const Background<R> behind = scene_.behind(v.direction);
            v.Le = behind.radiance;
            v.emitter_pdf = behind.pdf;
            v.emission_weight = direct_.hit_weight(v.pdf, v.emitter_pdf);
        }
    }
    void add_medium_vertex(Lane<R>& lane, std::int32_t medium) {
        PathVertex<R>& v = add_vertex(lane, VertexKind::medium, SceneLights::none);
        v.medium = medium;
        v.wo = -v.direction;
        lane.hit = {SceneLights::none, -1, lane.from, Vec3<R>(R(0)), Vec3<R>(R(0))};
    }
    void add_surface_vertex(int k, Lane<R>& lane) {
        PathVertex<R>& v = add_vertex(lane, VertexKind::surface, lane.hit.shape);
        const auto shape = static_cast<std::size_t>(lane.hit.shape);
        const auto material_number = static_cast<std::size_t>(geometry().material[shape]);
        if (mips_ && !geometry().textures.of(material_number).empty())
            v.footprint = lane.cone.footprint(geometry().bvh, lane.hit, lane.ray.direction,
                                              length(lane.hit.position - lane.previous), lane.time);
        lane.material.look_up(scene_, lane.hit, v.footprint);
        if (lane.material.is_textured()) v.uv = lane.hit.uv;
        const Material<R>& material = lane.material.sampling();
        if constexpr (!radiance)
            if (visitor_)
                visitor_->hit(k, lane.vertex(), lane.hit, v.direction, material, lane.beta);
        lane.side = SurfaceSide<R>(lane.hit, -v.direction, material.transmits());
        v.wo = lane.side.wo;
        if (material.has_opacity && test_opacity(lane, v)) return;
        if constexpr (radiance) add_emission(lane, v);
        if (stop_at_surfaces_ && !material.is_specular()) lane.alive = false;
    }
    /// The stochastic alpha test; true if the path continues straight.
    bool test_opacity(Lane<R>& lane, PathVertex<R>& v) {
        const OpacitySample<R> one =
            sample_opacity(lane.material.sampling().alpha, lane.material.eval().alpha,
                           geometry().textures.cutoff(lane.material.number()),
                           number(lane, Dims::opacity(lane.vertex())));
        if (one.is_null) v.kind = VertexKind::null_surface;
        v.opacity_weight = one.weight;
        v.d_opacity = one.d_opacity;
        lane.beta *= one.sampled_weight;
        return one.is_null;
    }
    void add_emission(const Lane<R>& lane, PathVertex<R>& v) {
        const R cosine = -dot(lane.hit.outside, v.direction);
        if (!(cosine > R(0))) return;  // emitters are one-sided
        if (geometry().textures.emission_texture(static_cast<std::size_t>(v.shape)))
            v.uv = lane.hit.uv;
        v.Le = scene_.emitted(v.shape, v.uv);
        if (stop_when_black_ && is_black(v.Le)) return;
        v.emitter_pdf =
            geometry().lights.hit_pdf(geometry().bvh, v.shape, lane.hit.primitive, lane.previous,
                                      length(lane.hit.position - lane.previous), cosine);
        v.emission_weight = direct_.hit_weight(v.pdf, v.emitter_pdf);
    }

    // Continuing ---------------------------------------------------------------------------------

    void continue_path(Lane<R>& lane) {
        PathVertex<R>& v = lane.path.vertices.back();
        if (v.kind == VertexKind::null_surface)
            continue_straight(lane, v);
        else if (v.kind == VertexKind::surface)
            scatter_at_surface(lane, v);
        else
            scatter_in_medium(lane, v);
        if (!Media || !lane.alive) return;
        if (v.kind != VertexKind::medium)
            cross_if_transmitted(geometry(), lane.hit, v.direction, lane.ray.direction, lane.stack);
        begin_segment(lane, lane.hit.position);
    }
    /// Behind a surface that is passed the path is still the one from the vertex before: its
    /// density, and the point that emitters are weighed from, remain those.
    void continue_straight(Lane<R>& lane, PathVertex<R>& v) {
        v.f = Vec3<R>(R(1));
        v.weight = R(1);
        lane.ray.origin = lane.side.start(lane.hit.position, v.direction, geometry().offset);
        lane.alive = !(stop_when_black_ && is_black(lane.beta));
    }
    void scatter_at_surface(Lane<R>& lane, PathVertex<R>& v) {
        const Philox4 words = sampler_(lane.key, Dims::scatter(lane.vertex()));
        const Vec2<R> u2(uniform_from<R>(words[dimensions::direction_u]),
                         uniform_from<R>(words[dimensions::direction_v]));
        const R u = uniform_from<R>(words[dimensions::lobe]);
        Continuation<R> next;
        if constexpr (radiance)
            next = sample_bsdf(lane.material.sampling(), lane.side, u2, u, lane.beta);
        else
            next = sample_adjoint_bsdf(lane.material.sampling(), lane.hit, lane.side, -v.direction,
                                       u2, u);
        lane.alive = false;
        if (!(next.sample.pdf > R(0))) return;
        v.wi = next.sample.wi;
        v.lobe = next.sample.lobe;
        v.f = lane.material.is_attached() ? next.value
                                          : lane.material.eval().value(v.wo, v.wi, v.lobe);
        if (!survives(lane, v, next.value, next.weight, words)) return;
        lane.pdf = v.lobe < 0 ? next.sample.pdf : R(0);
        if (mips_)
            lane.cone =
                lane.cone.onward(geometry(), lane.hit, v.direction, next.direction,
                                 length(lane.hit.position - lane.previous), lane.pdf, lane.time);
        lane.previous = lane.hit.position;
        lane.ray = {lane.side.start(lane.hit.position, next.direction, geometry().offset),
                    next.direction};
        lane.alive = true;
    }
    void scatter_in_medium(Lane<R>& lane, PathVertex<R>& v) {
        const auto m = static_cast<std::size_t>(v.medium);
        const Philox4 words = sampler_(lane.key, Dims::scatter(lane.vertex()));
        const AnyPhase<R>& phase = *scene_.sampling_media[m].phase;
        v.wi = phase.sample(v.direction, {uniform_from<R>(words[dimensions::direction_u]),
                                          uniform_from<R>(words[dimensions::direction_v])});
        const R cosine = dot(v.direction, v.wi), pdf = phase.pdf(cosine);
        v.f = Vec3<R>(scene_.media[m].phase->p(cosine));
        lane.alive = survives(lane, v, Vec3<R>(phase.p(cosine)), R(1) / pdf, words);
        if (!lane.alive) return;
        lane.pdf = pdf;
        lane.cone = lane.cone.scattered(length(lane.hit.position - lane.previous), pdf);
        lane.previous = lane.hit.position;
        lane.ray = {lane.hit.position, v.wi};
    }
    /// Updates the throughput; false where the path ends, black or by Russian roulette.
    bool survives(Lane<R>& lane, PathVertex<R>& v, const Vec3<R>& f, R weight,
                  const Philox4& words) {
        lane.beta *= f * weight;
        if (stop_when_black_ && is_black(lane.beta)) return false;
        if (static_cast<int>(lane.vertex()) >= options_.roulette_from) {
            v.survival = survival_probability(lane.beta);
            if (uniform_from<R>(words[dimensions::roulette]) >= v.survival) return false;
            lane.beta *= R(1) / v.survival;
        }
        v.weight = weight / v.survival;
        return true;
    }

    const PathScene<R>& scene_;
    const PathOptions options_;
    DirectLighting<R, Media> direct_;
    FreePathSampler<R> free_path_;
    bool stop_when_black_, stop_at_surfaces_, mips_;
    int escape_segment_;
    R pixel_spread_;
    PathSampler sampler_;
    ParticleVisitor* visitor_ = nullptr;
    Lane<R> lanes_[width];
};

}  // namespace photograd
