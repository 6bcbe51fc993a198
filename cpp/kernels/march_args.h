// Arguments common to the fused marches (float). Plain data only, because every instruction set's
// translation unit includes it.
#pragma once

#include "photograd/ops/march_data.h"

namespace photograd {

struct MarchArgs {
    RayBatch<float> rays;
    MarchOutputs<float> out;
    float lo[3], scale[3];  // voxel coordinate q = (p - lo) * scale - 0.5
    int density_activation, color_activation, quadrature;
    float density_scale;
    float dt;
    float tau_stop;  // a ray ends behind the sub-block in which its optical depth exceeds this
};

}  // namespace photograd
