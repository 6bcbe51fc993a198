#include "photograd/raster/prepared_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"

namespace photograd {
namespace {

// Pieces of the list of faces that are counted by themselves; not a number of threads.
constexpr std::int64_t list_pieces = 16;

/// Of the positions x and y of what lies beyond the near plane.
struct Bounds {
    double lo[2] = {std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
    double hi[2] = {-std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};

    void add(const Vec3<double>& v) {
        for (int k = 0; k < 2; ++k) {
            lo[k] = std::min(lo[k], v[k] / v.z);
            hi[k] = std::max(hi[k], v[k] / v.z);
        }
    }
    static Bounds of(const Vec3<double> (&v)[3], double near) {
        Bounds out;
        for (int i = 0; i < 3; ++i) {
            const Vec3<double>&a = v[i], &b = v[(i + 1) % 3];
            if (a.z >= near) out.add(a);
            if ((a.z < near) == (b.z < near)) continue;
            const double t = (near - a.z) / (b.z - a.z);
            out.add({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), near});
        }
        return out;
    }
};

/// Of two triangles with one edge, whose lines are opposite numbers, exactly one owns the points
/// on it: that with the edge on its left or, if it is level, on top.
bool owns_its_edge(const Vec3<double>& line) { return line.x > 0 || (line.x == 0 && line.y > 0); }

/// floor and ceil of numbers that are cut to [-1, high + 1] first.
int floor_within(double x, int high) {
    const double cut = x > -1 ? std::min(x, high + 1.0) : -1;
    const int whole = static_cast<int>(cut);
    return whole - (cut < whole ? 1 : 0);
}
int ceil_within(double x, int high) {
    const double cut = x > -1 ? std::min(x, high + 1.0) : -1;
    const int whole = static_cast<int>(cut);
    return whole + (cut > whole ? 1 : 0);
}

/// Pixels [box[k][0], box[k][1]) along each axis in which points may lie that are asked for.
void find_box(const Bounds& bounds, const int (&sizes)[2], Reach reach, int (&box)[2][2]) {
    for (int k = 0; k < 2; ++k) {
        const double slack = 1e-9 * (1 + std::max(std::abs(bounds.lo[k]), std::abs(bounds.hi[k])));
        const double lo = bounds.lo[k] - slack, hi = bounds.hi[k] + slack;
        const bool centers = reach == Reach::centers;
        const int first = centers ? ceil_within(lo - 0.5, sizes[k]) : floor_within(lo, sizes[k]);
        const int last = floor_within(centers ? hi - 0.5 : hi, sizes[k]);
        box[k][0] = std::clamp(first, 0, sizes[k]);
        box[k][1] = std::clamp(last + 1, box[k][0], sizes[k]);
    }
}

/// False, with `out` not written whole, for a triangle that is not drawn.
bool set_up(const ScreenMesh& mesh, std::uint32_t face, double near, Reach reach,
            ScreenTriangle& out) {
    const Vec3<double> v[3] = {mesh.corner(face, 0), mesh.corner(face, 1), mesh.corner(face, 2)};
    if (std::max({v[0].z, v[1].z, v[2].z}) < near) return false;
    int box[2][2];
    find_box(Bounds::of(v, near), {mesh.width, mesh.height}, reach, box);
    if (box[0][0] == box[0][1] || box[1][0] == box[1][1]) return false;
    out.edges = TriangleEdges<double>::of(v[0], v[1], v[2]);
    if (out.edges.det == 0) return false;
    out.front = out.edges.det < 0;
    if (out.front) {
        out.edges.det = -out.edges.det;
        for (Vec3<double>& line : out.edges.line) line = -line;
    }
    // w > -tiny is w >= 0: no number lies between.
    for (int i = 0; i < 3; ++i)
        out.least[i] =
            owns_its_edge(out.edges.line[i]) ? -std::numeric_limits<double>::denorm_min() : 0.0;
    out.x0 = box[0][0], out.x1 = box[0][1], out.y0 = box[1][0], out.y1 = box[1][1];
    out.face = face;
    return true;
}

/// visit(tile) for each tile that the box touches.
template <class Visit>
void for_tiles_of(const ScreenTriangle& t, int columns, Visit&& visit) {
    for (int y = t.y0 / raster_tile; y <= (t.y1 - 1) / raster_tile; ++y)
        for (int x = t.x0 / raster_tile; x <= (t.x1 - 1) / raster_tile; ++x)
            visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x));
}

}  // namespace

PreparedTriangles::PreparedTriangles(const ScreenMesh& mesh, double near, Reach reach)
    : width_(mesh.width),
      height_(mesh.height),
      columns_((mesh.width + raster_tile - 1) / raster_tile),
      rows_((mesh.height + raster_tile - 1) / raster_tile),
      triangles_(std::make_unique_for_overwrite<ScreenTriangle[]>(
          static_cast<std::size_t>(mesh.face_count()))) {
    const std::int64_t faces = mesh.face_count(), piece = (faces + list_pieces - 1) / list_pieces;
    const std::size_t tiles = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    std::vector<std::uint64_t> next(tiles * list_pieces, 0);
    std::int64_t filled[list_pieces] = {};
    parallel_for(list_pieces, [&](std::int64_t p) {
        std::uint64_t* own = next.data() + static_cast<std::size_t>(p) * tiles;
        for (std::int64_t i = p * piece; i < std::min(faces, (p + 1) * piece); ++i) {
            if (mesh.face_mask && !mesh.face_mask[i]) continue;
            ScreenTriangle& next_one = triangles_[static_cast<std::size_t>(p * piece + filled[p])];
            if (!set_up(mesh, static_cast<std::uint32_t>(i), near, reach, next_one)) continue;
            ++filled[p];
            for_tiles_of(next_one, columns_, [&](std::size_t tile) { ++own[tile]; });
        }
    });
    begin_.resize(tiles + 1);
    std::uint64_t sum = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        begin_[tile] = static_cast<std::uint32_t>(sum);
        for (std::size_t p = 0; p < list_pieces; ++p)
            sum += std::exchange(next[p * tiles + tile], sum);
        if (sum > 0xffffffff)
            fail(ErrorKind::range, "rasterize", "faces", "fewer than 2^32 pairs of face and tile",
                 "more", "render a smaller picture, or fewer triangles at a time");
    }
    begin_[tiles] = static_cast<std::uint32_t>(sum);
    listed_.resize(sum);
    parallel_for(list_pieces, [&](std::int64_t p) {
        std::uint64_t* own = next.data() + static_cast<std::size_t>(p) * tiles;
        for (std::int64_t i = p * piece; i < p * piece + filled[p]; ++i) {
            const auto slot = static_cast<std::uint32_t>(i);
            for_tiles_of(triangles_[slot], columns_,
                         [&](std::size_t tile) { listed_[own[tile]++] = slot; });
        }
    });
}

template <class Visit>
void PreparedTriangles::at_points(std::span<const double> points, Visit&& visit) const {
    const auto count = static_cast<std::int64_t>(points.size() / 2);
    constexpr std::int64_t piece = 256;
    parallel_for((count + piece - 1) / piece, [&](std::int64_t p) {
        for (std::int64_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
            const double x = points[2 * static_cast<std::size_t>(i)];
            const double y = points[2 * static_cast<std::size_t>(i) + 1];
            if (!(x >= 0 && x < width_ && y >= 0 && y < height_)) continue;
            const auto column = static_cast<std::size_t>(x) / raster_tile;
            const auto row = static_cast<std::size_t>(y) / raster_tile;
            for (const std::uint32_t slot :
                 in_tile(row * static_cast<std::size_t>(columns_) + column))
                visit(i, triangles_[slot].face, triangles_[slot].depth_at(x, y));
        }
    });
}

void PreparedTriangles::nearest(std::span<const double> points, double near, double far,
                                std::int32_t* face, double* depth) const {
    std::fill_n(face, points.size() / 2, -1);
    std::fill_n(depth, points.size() / 2, std::numeric_limits<double>::infinity());
    at_points(points, [&](std::int64_t i, std::uint32_t k, double z) {
        if (!(z >= near && z <= far && z < depth[i])) return;
        depth[i] = z;
        face[i] = static_cast<std::int32_t>(k);
    });
}

void PreparedTriangles::count(std::span<const double> points, double near, const double* depth,
                              std::int32_t* counts) const {
    std::fill_n(counts, points.size() / 2, 0);
    at_points(points, [&](std::int64_t i, std::uint32_t, double z) {
        counts[i] += z >= near && z <= depth[i];
    });
}

}  // namespace photograd
