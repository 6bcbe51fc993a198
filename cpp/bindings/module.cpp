#include "module.h"

PYBIND11_MODULE(_core, m) {
    m.doc() = "photograd's C++ core. Use the typed faces in the package photograd instead.";
    m.attr("__version__") = PHOTOGRAD_VERSION;
    photograd::bind_errors(m);
    photograd::bind_core(m);
    photograd::bind_ops(m);
    photograd::bind_march(m);
    photograd::bind_geometry(m);
    photograd::bind_reference(m);
    photograd::bind_raster(m);
    photograd::bind_frame(m);
    photograd::bind_vector(m);
    photograd::bind_sdf(m);
    photograd::bind_bsdf(m);
    photograd::bind_principled(m);
    photograd::bind_light(m);
    photograd::bind_phase(m);
    photograd::bind_diffusion(m);
    photograd::bind_scene(m);
    photograd::bind_path(m);
    photograd::bind_gbuffer(m);
    photograd::bind_path_tangent(m);
    photograd::bind_particles(m);
    photograd::bind_sampling(m);
    photograd::bind_network(m);
    photograd::bind_neural(m);
    photograd::bind_sh(m);
    photograd::bind_texture(m);
    photograd::bind_octree(m);
    photograd::bind_octree_sh(m);
    photograd::bind_voxel_hash(m);
    photograd::bind_sparse(m);
    photograd::bind_bricks(m);
    photograd::bind_splat(m);
    photograd::bind_sparse_sh(m);
    photograd::bind_samples(m);
}
