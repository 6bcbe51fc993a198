// The parts of the module _core: one bind_<part> function a file. No mathematics in this folder.
#pragma once

#include "pybind.h"

namespace photograd {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_core(py::module_& m);
void bind_ops(py::module_& m);
void bind_march(py::module_& m);
void bind_frame(py::module_& m);
void bind_gbuffer(py::module_& m);
void bind_geometry(py::module_& m);
void bind_bsdf(py::module_& m);
void bind_light(py::module_& m);
void bind_phase(py::module_& m);
void bind_diffusion(py::module_& m);
void bind_scene(py::module_& m);
void bind_path_tangent(py::module_& m);
void bind_particles(py::module_& m);
void bind_principled(py::module_& m);
void bind_raster(py::module_& m);
void bind_reference(py::module_& m);
void bind_sdf(py::module_& m);
void bind_path(py::module_& m);
void bind_sampling(py::module_& m);
void bind_samples(py::module_& m);
void bind_network(py::module_& m);
void bind_neural(py::module_& m);
void bind_sh(py::module_& m);
void bind_texture(py::module_& m);
void bind_vector(py::module_& m);
void bind_octree(py::module_& m);
void bind_octree_sh(py::module_& m);
void bind_voxel_hash(py::module_& m);
void bind_sparse(py::module_& m);
void bind_bricks(py::module_& m);
void bind_splat(py::module_& m);
void bind_sparse_sh(py::module_& m);

}  // namespace photograd
