// The table of random-number dimensions. A number is a function of seed, step, pixel, sample, block
// and word (core/random.h): four words a block. Two decisions of one path must not share a number,
// so everything that is random about a path, a particle or a ray has its place here.
//
//   camera paths, step 0: k is the vertex, from 0
//     block         word 0          word 1         word 2        word 3
//     0             film x          film y         lens u        lens v
//     1 + 2k        which emitter   point on it u  point v       opacity
//     2 + 2k        direction u     direction v    lobe          Russian roulette
//     2^14 - 1      color channel
//     2^14 + k      distance to the first collision on the segment that ends in vertex k
//     2^16          shutter time
//   further distances, blocks 0, 1, ... as many as needed
//     step 1 + 2k   on the segment that ends in vertex k
//     step 2 + 2k   on the shadow ray of vertex k
//
//   photon gathering, step 0
//     1 + k         lobe            opacity
//   ambient occlusion, step 0
//     1             direction u     direction v
//
//   particles, step 1: k is the vertex, from 0
//     0             which emitter   point on it u  point v
//     1             direction u     direction v    color channel
//     2 + k         direction u     direction v    lobe          Russian roulette
//     2^20 + k      opacity
//   distances to collisions
//     step 2^31 + k on the segment that ends in vertex k
//     step 2^30     between a light at infinity and where its particle starts
#pragma once

#include <cstddef>
#include <cstdint>

namespace photograd::dimensions {

/// Words of a block.
inline constexpr std::size_t film_x = 0, film_y = 1, lens_u = 2, lens_v = 3;  // of block camera
inline constexpr std::size_t emitter = 0, emitter_u = 1, emitter_v = 2, opacity = 3;    // light
inline constexpr std::size_t direction_u = 0, direction_v = 1, lobe = 2, roulette = 3;  // scatter
inline constexpr std::size_t channel = 0;                          // of block channel_block
inline constexpr std::size_t first_distance = 0;                   // of first_distance_block
inline constexpr std::size_t shutter = 0;                          // of block shutter_block
inline constexpr std::size_t gather_lobe = 0, gather_opacity = 1;  // of gather_block
inline constexpr std::size_t particle_channel = 2;                 // of particle_direction_block
inline constexpr std::size_t particle_opacity = 0;                 // of particle_opacity_block

/// Of the keys. Particles share step 1 with the first segment of a camera path in a medium: there
/// alone, a picture and particles of one seed are not independent.
inline constexpr std::uint32_t path_step = 0, particle_step = 1;

inline constexpr std::uint32_t camera_block = 0;
/// Sampling of an emitter, and the opacity of the surface, at a vertex.
constexpr std::uint32_t light_block(std::uint32_t vertex) { return 1 + 2 * vertex; }
/// Sampling of the BSDF or phase function, and Russian roulette, at a vertex.
constexpr std::uint32_t scatter_block(std::uint32_t vertex) { return 2 + 2 * vertex; }
inline constexpr std::uint32_t channel_block = (1u << 14) - 1;
/// Of the segment that ends in a vertex. Behind what vertices own: paths are shorter than 2^13.
constexpr std::uint32_t first_distance_block(std::uint32_t vertex) { return (1u << 14) + vertex; }
inline constexpr std::uint32_t shutter_block = 1u << 16;

/// Steps whose blocks hold the distances after the first one.
constexpr std::uint32_t segment_step(std::uint32_t vertex) { return 1 + 2 * vertex; }
constexpr std::uint32_t shadow_step(std::uint32_t vertex) { return 2 + 2 * vertex; }

constexpr std::uint32_t gather_block(std::uint32_t vertex) { return 1 + vertex; }
inline constexpr std::uint32_t occlusion_block = 1;

inline constexpr std::uint32_t particle_emitter_block = 0, particle_direction_block = 1;
constexpr std::uint32_t particle_scatter_block(std::uint32_t vertex) { return 2 + vertex; }
constexpr std::uint32_t particle_opacity_block(std::uint32_t vertex) { return (1u << 20) + vertex; }
constexpr std::uint32_t particle_segment_step(std::uint32_t vertex) { return (1u << 31) + vertex; }

inline constexpr std::uint32_t particle_start_step = 1u << 30;

/// All numbers of a path of the reference but those of its camera ray.
inline constexpr std::uint32_t reference_step = 1u << 29;

static_assert(scatter_block(4096) < channel_block);  // the longest path that options allow

}  // namespace photograd::dimensions
