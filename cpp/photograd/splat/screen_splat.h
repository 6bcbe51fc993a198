// A Gaussian projected to the screen, and its cut-offs. Plain data, the same in every instruction
// set.
#pragma once

namespace photograd {

/// Sixteen numbers: one cache line of floats.
template <class R>
struct ScreenSplat {
    R x, y;      // mean, pixels
    R conic[3];  // A, B, C
    R opacity;   // with compensation
    R color[3];
    R depth;
    int x0, x1, y0, y1;  // it may be visible in [x0, x1) x [y0, y1); x0 == x1: culled
    R sigma_max;  // where the exponent is larger, alpha is below alpha_min; a little too large
    R unused;
};

/// Discontinuities of blending. Each can be switched off, or finite differences would mean nothing.
template <class R>
struct SplatCutoffs {
    R alpha_min;       // fainter contributions are dropped; 0: off
    R alpha_max;       // opacity of one splat in one pixel is held here; 1: off
    R stop;            // a pixel ends before the splat that would leave T below this; 0: off
    int pass_clamped;  // derivative at alpha_max: 1, as in the original code, instead of 0
};

/// Derivatives of one splat that one tile sums up, in this order.
enum SplatPartial {
    partial_x,
    partial_y,
    partial_a,
    partial_b,
    partial_c,
    partial_opacity,
    partial_red,
    partial_green,
    partial_blue,
    partial_depth,
    partial_count
};

}  // namespace photograd
