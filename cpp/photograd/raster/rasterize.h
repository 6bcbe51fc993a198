// The rasterizer: which triangle each pixel sees, and where on it; a visibility buffer [Burns2013].
//
// The image is cut into tiles, and a tile is drawn by one thread, its triangles in the order of
// their numbers: the same bits on any number of threads. Everything is calculated in double.
#pragma once

#include <cstdint>

#include "photograd/raster/fragment_tests.h"
#include "photograd/raster/prepared_triangles.h"

namespace photograd {

/// The buffers, (H, W) each; drawn onto, so that several meshes may follow one another. Those that
/// are not `cleared` hold a picture, or the numbers of an empty one.
struct VisibilityBuffers {
    std::int32_t* face;       // -1 where nothing is seen; null with `barycentrics` for depth alone
    double* barycentrics;     // (H, W, 2): weights of the second and third corner
    double* depth;            // z in the camera's frame; infinite where nothing is seen
    std::uint8_t* stencil;    // null without a stencil buffer
    std::int32_t first_face;  // added to the numbers of faces
    std::int32_t* overdraw;   // null, or how many fragments lay within [near, far]
    const double* behind;     // null, or depths (H, W): only what lies further away is drawn
    bool cleared;             // whether `depth` is infinite everywhere before anything is drawn
};

void rasterize(const ScreenMesh& mesh, const FragmentRules& rules, const VisibilityBuffers& out);

/// Where each pixel that sees a face of `mesh` meets it: the adjoint of the barycentrics and the
/// depth. Adds to d_positions (V, 3). Which face is seen is held constant.
void rasterize_backward(const ScreenMesh& mesh, const std::int32_t* face,
                        const double* d_barycentrics, const double* d_depth, double* d_positions);

}  // namespace photograd
