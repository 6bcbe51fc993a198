// A camera that moves while its shutter is open, from time 0 to 1, at one speed:
//
//   position(s) = position + s shift
//   axis(s) = cos(s w) axis + sin(s w) a x axis + (1 - cos(s w)) a <a, axis>,    turn = w a
//
// a straight line, and a rotation about one axis: that of slerp [Shoemake1985] between two
// rotations, by Rodrigues' formula.
#pragma once

#include "photograd/core/sincos.h"
#include "photograd/core/vec.h"

namespace photograd {

struct CameraMotion {
    Vec3<double> shift{0.0},
        turn{0.0};  // meters; radians about an axis of the world, below half a turn
    bool moves = false;

    /// Moves a pose, rows of world_from_camera, to where it is at a time from 0 to 1.
    void apply(double time, double (&pose)[3][4]) const {
        const double angle = length(turn);
        const Vec3<double> a = angle > 0 ? turn * (1 / angle) : turn;
        const SinCos<double> w = sin_cos(time * angle);
        for (int k = 0; k < 3; ++k) {
            const Vec3<double> axis(pose[0][k], pose[1][k], pose[2][k]);
            const Vec3<double> turned =
                w.cos * axis + w.sin * cross(a, axis) + a * ((1 - w.cos) * dot(a, axis));
            for (int i = 0; i < 3; ++i) pose[i][k] = turned[i];
        }
        for (int i = 0; i < 3; ++i) pose[i][3] += time * shift[i];
    }
};

}  // namespace photograd
