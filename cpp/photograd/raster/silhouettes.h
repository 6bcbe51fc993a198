// Which edges of a mesh a camera may see against something behind them.
//
// Of an edge from Va to Vb in homogeneous pixels (triangle.h), E = Va x Vb is the line in the
// image, and the sign of <E, V> says on which side of it a vertex V, and with it a face, lies, also
// behind the camera. An edge is a silhouette where both of its faces lie on one side, that is where
// the camera sees the front of one and the back of the other, and where it has not two faces.
#pragma once

#include <cstdint>
#include <span>

namespace photograd {

/// positions (V, 3); ends (E, 2); opposite (E, 2): the third vertices of the two faces, -1 where
/// there are not two. Writes 1 or 0 to `silhouette` (E,).
void find_silhouettes(std::span<const double> positions, std::span<const std::uint32_t> ends,
                      std::span<const std::int32_t> opposite, std::uint8_t* silhouette);

}  // namespace photograd
