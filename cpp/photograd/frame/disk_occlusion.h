// Ambient occlusion by disks that stand for surfaces [Bunnell2005].
//
// A disk of area A at distance d hides of what a surface receives, by the cosine,
//
//   A max(0, cos emitter) max(0, cos receiver) / (pi d^2 + A),
//
// the form factor of a coaxial disk, exact there. Sums count what lies behind other disks as well;
// so each disk's part is multiplied by how much of the sky it sees itself, found in a pass before.
// Disks that are far away, compared with the box around them, count as one.
#pragma once

#include <cstdint>
#include <vector>

#include "photograd/core/real.h"
#include "photograd/core/vec.h"

namespace photograd {

/// Rows (E, 3) of meters, unit normals, and (E,) square meters; front sides hide, backs do not.
struct Disks {
    std::int64_t count;
    const double *centers, *normals, *areas;
};

/// Disks in a tree of boxes; holds what `Disks` pointed to only while it is built.
class DiskTree {
public:
    explicit DiskTree(const Disks& disks);

    /// How open the sky is, (N,) 0 to 1, at points with unit normals (N, 3). `parts` (E,) are
    /// factors of the disks. A box counts as one disk from `opening` times its radius on; what is
    /// further away than `radius` hides nothing.
    template <Real R>
    void look_up(const double* parts, double opening, double radius, std::int64_t count,
                 const R* points, const R* normals, R* visible) const;

private:
    struct Node {
        Vec3<double> center{0.0}, normal{0.0};  // mean by area; the normal is no unit vector
        double radius = 0.0, area = 0.0;
        std::int32_t first = 0, last = 0, right = 0;  // right 0: a leaf
    };
    struct Disk {
        Vec3<double> center{0.0}, normal{0.0};
        double area = 0.0;
        std::int32_t number = 0;
    };
    std::int32_t build(std::int32_t first, std::int32_t last);
    [[nodiscard]] std::vector<double> mean_parts(const double* parts) const;

    std::vector<Disk> disks_;
    std::vector<Node> nodes_;
};

}  // namespace photograd
