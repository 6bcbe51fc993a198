// Structural similarity of two images, and its derivative with respect to the first [Wang2004].
//
// In every 11 x 11 window that lies inside, with Gaussian weights w of sigma 1.5 that add up to
// one, and for each channel on its own:
//
//   m_x = sum w x,   v_x = sum w x^2 - m_x^2,   c = sum w x y - m_x m_y     (m_y, v_y likewise)
//
//   S = l s,   l = A1 / B1 = (2 m_x m_y + C1) / (m_x^2 + m_y^2 + C1)
//              s = A2 / B2 = (2 c + C2) / (v_x + v_y + C2)
//
// The value is the mean of S over windows and channels. With the moments m = sum w x, p = sum w x^2
// and q = sum w x y taken as independent:
//
//   dS/dq = 2 A1 / (B1 B2)        dS/dp = -S / B2
//   dS/dm = 2 m_y (A2 - A1) / (B1 B2) + 2 m_x S (1 / B2 - 1 / B1)
//
// and each pixel takes part in m, p and q of the windows around it with w, 2 x w and y w.
// C1 = 0.01^2 and C2 = 0.03^2, for pictures in 0 .. 1.
#pragma once

#include "photograd/texture/image.h"

namespace photograd {

inline constexpr int ssim_window = 11;

/// Mean structural similarity of x and y (H, W, C), at least 11 x 11, of one shape.
template <Real R>
[[nodiscard]] double ssim(const ImageView<const R>& x, const R* y);

/// d_x (H, W, C) += d_value dS/dx. Returns the value, which costs nothing more.
template <Real R>
double ssim_backward(const ImageView<const R>& x, const R* y, double d_value, R* d_x);

}  // namespace photograd
