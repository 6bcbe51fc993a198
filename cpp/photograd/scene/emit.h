// Particles as they leave the lights of a scene: where, which way, and how many watts each stands
// for.
//
// Light that leaves a point x of a surface along w carries L cos dA dw watts. A particle sampled
// with density p(x, w) stands for L cos / p: the mean of what particles of a set carry is then the
// power of that set. A light is chosen with probability pmf, in proportion to its power
// (scene_lights.h), then
//
//   point          w uniform over the sphere                              4 pi I / pmf
//   spot           w uniform over the cone                 2 pi (1 - cos_outer) I s / pmf
//   directional    x uniform over a disc of radius r across w             pi r^2 E / pmf
//   at infinity    w as the light samples it, then x as above       pi r^2 L(w) / (pdf pmf)
//   surface        x uniform over the primitive, w with density cos / pi    pi A L / pmf
//
// The disc faces the light and is as wide as the sphere around the scene's box (and the box of the
// world's density grid, if there is one), outside of which it stands: it covers the shadow of the
// box, whatever the direction. Particles beside the box hit nothing.
#pragma once

#include "photograd/scene/path_scene.h"

namespace photograd {

struct Particle {
    Vec3<double> origin{0.0}, direction{0.0};  // unit direction, the way the light goes
    Vec3<double> flux{0.0};                    // W; 0: nothing leaves here
    std::int64_t entry = -1;                   // which light, in the table of scene_lights.h
    Vec3<double> normal{0.0};                  // of the surface that it leaves; 0 if none
    bool far = false;                          // it comes from infinity
};

/// One particle: `u` chooses the light, the others position and direction. There must be a light.
Particle emit(const PathScene<double>& scene, double u, const Vec2<double>& u_position,
              const Vec2<double>& u_direction);

}  // namespace photograd
