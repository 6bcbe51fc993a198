// Limits of Embree, checked before it is called: it aborts on numbers out of range.
#pragma once

#include <string>
#include <vector>

#include "photograd/geometry/bvh.h"

namespace photograd {

/// Refuses (SceneError) spheres without extent, not finite or beyond `world_limit`.
void check_spheres(const std::vector<Sphere>& spheres);

/// The largest |x|, |y| and |z| of the vertices.
Vec3<double> extent_of(const Mesh& mesh);

/// Refuses (SceneError) a transform that takes a mesh of this extent beyond `world_limit`.
void check_transform(const char* argument, const Affine& transform, const Vec3<double>& extent,
                     const std::string& name);

/// How far rays may reach so that Embree takes them also in the object's space. The inverse in
/// float brings them there, adjugate / determinant; an entry of the adjugate is at most twice the
/// largest entry squared. Refuses (SceneError) what cannot be inverted so, at any time.
double reach_into(const Instance& it, const std::string& name);

/// Refuses (SceneError) a scene that is larger than that.
void check_reach(double reach, const Box& bounds);

}  // namespace photograd
