#include "photograd/raster/rasterize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/kernels.h"
#include "photograd/core/parallel.h"
#include "photograd/raster/owner_sums.h"

namespace photograd {
namespace {

/// One tile's pixels [x0, x1) x [y0, y1).
struct TileBounds {
    int x0, x1, y0, y1;
};

bool is_culled(Cull cull, bool front) { return cull == (front ? Cull::front : Cull::back); }

/// The tests of one fragment at a pixel, in their order; whether it is seen.
bool survives(const FragmentRules& rules, double z, const VisibilityBuffers& out,
              std::size_t pixel) {
    if (!(z >= rules.near && z <= rules.far)) return false;
    if (out.behind && !(z > out.behind[pixel])) return false;
    if (out.overdraw) ++out.overdraw[pixel];
    const StencilRules& stencil = rules.stencil;
    if (out.stencil && !stencil.allows(out.stencil[pixel])) {
        stencil.apply(stencil.fail, out.stencil[pixel]);
        return false;
    }
    const bool nearer = passes(rules.depth, z, out.depth[pixel]);
    if (out.stencil) stencil.apply(nearer ? stencil.pass : stencil.depth_fail, out.stencil[pixel]);
    return nearer;
}

/// What a depth buffer alone decides: by lanes.
void draw_spans(const ScreenTriangle& triangle, std::int32_t number, const FragmentRules& rules,
                const TileBounds& tile, int width, const VisibilityBuffers& out) {
    DrawSpan span{};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) span.line[i][k] = triangle.edges.line[i][k];
        span.least[i] = triangle.least[i];
    }
    span.det = triangle.edges.det;
    span.near = rules.near, span.far = rules.far;
    span.number = number;
    span.x0 = std::max(tile.x0, triangle.x0), span.x1 = std::min(tile.x1, triangle.x1);
    span.y0 = std::max(tile.y0, triangle.y0), span.y1 = std::min(tile.y1, triangle.y1);
    span.width = width;
    span.depth = out.depth, span.face = out.face, span.overdraw = out.overdraw;
    kernels().draw_span(span);
}

void draw_triangle(const ScreenTriangle& triangle, std::int32_t number, const FragmentRules& rules,
                   const TileBounds& tile, int width, const VisibilityBuffers& out) {
    const int x0 = std::max(tile.x0, triangle.x0), x1 = std::min(tile.x1, triangle.x1);
    for (int y = std::max(tile.y0, triangle.y0); y < std::min(tile.y1, triangle.y1); ++y) {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        for (int x = x0; x < x1; ++x) {
            const double z = triangle.depth_at(x + 0.5, y + 0.5);
            const std::size_t pixel = row + static_cast<std::size_t>(x);
            if (z < 0 || !survives(rules, z, out, pixel)) continue;
            if (out.face) out.face[pixel] = number;
            if (rules.depth_write) out.depth[pixel] = z;
        }
    }
}

/// Barycentrics of the faces that this call has drawn.
void fill_barycentrics(const ScreenMesh& mesh, const TileBounds& tile,
                       const VisibilityBuffers& out) {
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) {
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(mesh.width) +
                static_cast<std::size_t>(x);
            const std::int64_t face = std::int64_t{out.face[pixel]} - out.first_face;
            if (face < 0 || face >= mesh.face_count()) continue;
            const auto point = screen_point(mesh.edges(static_cast<std::uint32_t>(face)),
                                            Vec3<double>(x + 0.5, y + 0.5, 1));
            out.barycentrics[2 * pixel] = point.b[1];
            out.barycentrics[2 * pixel + 1] = point.b[2];
        }
}

}  // namespace

void rasterize(const ScreenMesh& mesh, const FragmentRules& rules, const VisibilityBuffers& out) {
    const PreparedTriangles triangles(mesh, rules.near, Reach::centers);
    const bool by_depth_alone =
        rules.depth == Compare::less && rules.depth_write && !out.stencil && !out.behind;
    const auto draw = by_depth_alone ? &draw_spans : &draw_triangle;
    parallel_for(std::int64_t{triangles.columns()} * triangles.rows(), [&](std::int64_t number) {
        const int x = static_cast<int>(number % triangles.columns()) * raster_tile;
        const int y = static_cast<int>(number / triangles.columns()) * raster_tile;
        const TileBounds tile{x, std::min(x + raster_tile, mesh.width), y,
                              std::min(y + raster_tile, mesh.height)};
        if (out.cleared)
            for (int row = tile.y0; row < tile.y1; ++row)
                std::fill_n(out.depth + std::int64_t{row} * mesh.width + tile.x0, tile.x1 - tile.x0,
                            std::numeric_limits<double>::infinity());
        for (const std::uint32_t slot : triangles.in_tile(static_cast<std::size_t>(number))) {
            const ScreenTriangle& triangle = triangles.triangle(slot);
            if (!is_culled(rules.cull, triangle.front))
                draw(triangle, out.first_face + static_cast<std::int32_t>(triangle.face), rules,
                     tile, mesh.width, out);
        }
        if (out.face) fill_barycentrics(mesh, tile, out);
    });
}

void rasterize_backward(const ScreenMesh& mesh, const std::int32_t* face,
                        const double* d_barycentrics, const double* d_depth, double* d_positions) {
    const std::int64_t pixels = std::int64_t{mesh.width} * mesh.height, faces = mesh.face_count();
    // Three vectors a pixel, of the corners of its face; then three a face, of its vertices.
    std::vector<double> by_pixel(static_cast<std::size_t>(9 * pixels));
    std::vector<std::uint32_t> owner(static_cast<std::size_t>(pixels));
    parallel_for(mesh.height, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < mesh.width; ++x) {
            const auto pixel = static_cast<std::size_t>(y * mesh.width + x);
            const bool visible = face[pixel] >= 0 && face[pixel] < faces;
            owner[pixel] = static_cast<std::uint32_t>(visible ? face[pixel] : faces);
            if (!visible) continue;
            const Vec3<double> v[3] = {mesh.corner(owner[pixel], 0), mesh.corner(owner[pixel], 1),
                                       mesh.corner(owner[pixel], 2)};
            const auto edges = TriangleEdges<double>::of(v[0], v[1], v[2]);
            const Vec3<double> p(double(x) + 0.5, double(y) + 0.5, 1);
            const double *d_b = d_barycentrics + 2 * pixel, d_z = d_depth[pixel];
            Vec3<double> d_v[3] = {};
            screen_point_backward(v, edges, p, screen_point(edges, p),
                                  ScreenPoint<double>{{0, d_b[0], d_b[1]}, d_z}, d_v);
            for (int i = 0; i < 9; ++i)
                by_pixel[9 * pixel + static_cast<std::size_t>(i)] = d_v[i / 3][i % 3];
        }
    });
    std::vector<double> by_face(static_cast<std::size_t>(9 * faces), 0.0);
    add_to_owners(owner, faces, by_pixel.data(), 9, by_face.data());
    add_to_owners(mesh.faces, static_cast<std::int64_t>(mesh.positions.size() / 3), by_face.data(),
                  3, d_positions);
}

}  // namespace photograd
