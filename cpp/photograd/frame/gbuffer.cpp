#include "photograd/frame/gbuffer.h"

#include "photograd/frame/chunk_sums.h"
#include "photograd/render/path/lane.h"
#include "photograd/render/path/scatter.h"

namespace photograd {
namespace {

template <class R>
void put(R* rows, std::int64_t i, const Vec3<R>& v) {
    if (rows)
        for (int k = 0; k < 3; ++k) rows[3 * i + k] = v[k];
}
template <class R>
Vec3<R> vector_at(const R* rows, std::int64_t i) {
    return {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
}

/// Where the ray meets a sphere, or passes it most closely: its triangles lie within it.
template <class R>
R distance_to(const Ray<R>& ray, const Sphere& sphere) {
    const auto chord = SphereChord<R>::of(ray, sphere.center<R>(), R(sphere.radius), R(1));
    const R half = chord.half_squared > R(0) ? std::sqrt(chord.half_squared) : R(0);
    return chord.middle - half > R(0) ? chord.middle - half : chord.middle + half;
}

template <Real R>
void fill_pixel(const PathScene<R>& scene, const Ray<R>& ray, const RayCone<R>& cone,
                std::int32_t shape, std::int32_t primitive, std::int64_t i, const GBuffer<R>& out) {
    const PathGeometry& geometry = *scene.geometry;
    const Bvh& bvh = geometry.bvh;
    const bool sphere = shape >= bvh.sphere_instance();
    const R t = sphere ? distance_to(ray, bvh.sphere(primitive, 0)) : R(0);
    const SurfaceHit<R> hit = surface_hit(
        geometry, ray, sphere ? static_cast<std::int32_t>(bvh.sphere_instance()) : shape, primitive,
        float(t));
    Footprint<R> footprint;
    if (!sphere && geometry.textures.any_mips())
        footprint = cone.footprint(bvh, hit, ray.direction, length(hit.position - ray.origin));
    HitMaterial<R> looked_up;
    looked_up.look_up(scene, hit, footprint);
    const Material<R>& material = looked_up.eval();
    const SurfaceSide<R> side(hit, -ray.direction, material.transmits());
    out.material[i] = static_cast<std::int32_t>(looked_up.number());
    put(out.position, i, hit.position);
    put(out.normal, i, side.normal);
    put(out.shading, i, side.frame.normal);
    put(out.tangent, i, dot(hit.along, hit.along) > R(0) ? side.frame.tangent : Vec3<R>(R(0)));
    const bool front = -dot(hit.outside, ray.direction) > R(0);
    put(out.emission, i, front ? scene.emitted(hit.shape, hit.uv) : Vec3<R>(R(0)));
    const double cutoff = geometry.textures.cutoff(looked_up.number());
    out.alpha[i] = cutoff < 0 ? material.alpha : R(double(material.alpha) >= cutoff ? 1 : 0);
    if (out.row_size == 0) return;
    R row[max_parameters] = {};
    material.get(row);
    std::copy_n(row, out.row_size, out.rows + i * out.row_size);
}

/// The side of the surface as `fill_pixel` left it.
template <Real R>
SurfaceSide<R> side_of(const GBuffer<R>& in, std::int64_t i, const Vec3<R>& viewer) {
    SurfaceHit<R> hit;
    hit.outside = vector_at(in.normal, i);
    hit.shading = vector_at(in.shading, i);
    hit.along = vector_at(in.tangent, i);
    return {hit, viewer, true};
}

template <Real R>
Vec3<R> reflected(const Material<R>& material, const SurfaceSide<R>& side, const Vec3<R>& wi) {
    const Vec3<R> local = side.frame.to_local(wi);
    if (material.is_specular() || !side.agrees(wi, local)) return Vec3<R>(R(0));
    if (!(side.wo.z * local.z > R(0)) && !material.transmits()) return Vec3<R>(R(0));
    return material.f(side.wo, local) * std::abs(local.z);
}

/// visit(i, material, side) for each pixel that shows a surface and is `wanted`.
template <Real R, class Wanted, class Visit>
void for_surfaces(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                  const GBuffer<R>& in, Wanted&& wanted, Visit&& visit) {
    for_chunks(count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
        for (std::int64_t i = first; i < last; ++i) {
            if (in.material[i] < 0 || !wanted(i)) continue;
            const SurfaceSide<R> side = side_of(in, i, normalize(eye - vector_at(in.position, i)));
            const Material<R>& shared = scene.materials[static_cast<std::size_t>(in.material[i])];
            if (in.row_size == 0) {
                visit(i, shared, side);
            } else {
                Material<R> own = shared;
                own.set(in.rows + i * in.row_size);
                visit(i, own, side);
            }
        }
    });
}

constexpr auto everywhere = [](std::int64_t) { return true; };

}  // namespace

template <Real R>
void fill_gbuffer(const PathScene<R>& scene, const Pinhole& camera, const FaceTable& table,
                  const GBuffer<R>& out) {
    const RayCone<R> cone{R(0), R(2 / (camera.fx + camera.fy))};
    parallel_for(camera.height, [&](std::int64_t y) {
        for (int x = 0; x < camera.width; ++x) {
            const std::int64_t i = y * camera.width + x;
            if (const std::int32_t face = table.face[i]; face >= 0) {
                fill_pixel(scene, camera.ray(R(x) + R(0.5), R(y) + R(0.5)), cone, table.shape[face],
                           table.primitive[face], i, out);
                continue;
            }
            out.material[i] = -1;
            for (R* rows : {out.position, out.normal, out.shading, out.tangent, out.emission})
                put(rows, i, Vec3<R>(R(0)));
            out.alpha[i] = R(0);
            std::fill_n(out.rows + i * out.row_size, out.row_size, R(0));
        }
    });
}

template <Real R>
void light_gbuffer(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                   const GBuffer<R>& in, const R* wi, const R* irradiance, R* out) {
    const auto lit = [&](std::int64_t i) { return vector_at(irradiance, i) != Vec3<R>(R(0)); };
    for_surfaces(scene, eye, count, in, lit,
                 [&](std::int64_t i, const Material<R>& material, const SurfaceSide<R>& side) {
                     const Vec3<R> light = reflected(material, side, vector_at(wi, i));
                     put(out, i, vector_at(out, i) + light * vector_at(irradiance, i));
                 });
}

template <Real R>
void light_gbuffer_parallel(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                            const GBuffer<R>& in, std::int64_t directions, const R* wi,
                            const R* irradiance, const R* visible, R* out) {
    const auto lit = [&](std::int64_t i) { return visible[i] != R(0); };
    for_surfaces(scene, eye, count, in, lit,
                 [&](std::int64_t i, const Material<R>& material, const SurfaceSide<R>& side) {
                     Vec3<R> sum(R(0));
                     for (std::int64_t k = 0; k < directions; ++k)
                         sum +=
                             reflected(material, side, vector_at(wi, k)) * vector_at(irradiance, k);
                     put(out, i, vector_at(out, i) + sum * visible[i]);
                 });
}

template <Real R>
void sample_gbuffer(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                    const GBuffer<R>& in, const R* u, R* wi, R* weight, R* pdf) {
    std::fill_n(wi, 3 * count, R(0));
    std::fill_n(weight, 3 * count, R(0));
    std::fill_n(pdf, count, R(0));
    for_surfaces(scene, eye, count, in, everywhere,
                 [&](std::int64_t i, const Material<R>& material, const SurfaceSide<R>& side) {
                     const Vec3<R> numbers = vector_at(u, i);
                     const Continuation<R> found = sample_bsdf(
                         material, side, {numbers.x, numbers.y}, numbers.z, Vec3<R>(R(1)));
                     put(wi, i, found.direction);
                     put(weight, i, found.value * found.weight);
                     pdf[i] = found.sample.lobe < 0 ? found.sample.pdf : R(0);
                 });
}

template <Real R>
void gbuffer_pdf(const PathScene<R>& scene, const Vec3<R>& eye, std::int64_t count,
                 const GBuffer<R>& in, const R* wi, R* pdf) {
    std::fill_n(pdf, count, R(0));
    for_surfaces(scene, eye, count, in, everywhere,
                 [&](std::int64_t i, const Material<R>& material, const SurfaceSide<R>& side) {
                     const Vec3<R> local = side.frame.to_local(vector_at(wi, i));
                     if (!material.is_specular()) pdf[i] = material.pdf(side.wo, local);
                 });
}

template void fill_gbuffer(const PathScene<float>&, const Pinhole&, const FaceTable&,
                           const GBuffer<float>&);
template void fill_gbuffer(const PathScene<double>&, const Pinhole&, const FaceTable&,
                           const GBuffer<double>&);
template void light_gbuffer(const PathScene<float>&, const Vec3<float>&, std::int64_t,
                            const GBuffer<float>&, const float*, const float*, float*);
template void light_gbuffer(const PathScene<double>&, const Vec3<double>&, std::int64_t,
                            const GBuffer<double>&, const double*, const double*, double*);

template void light_gbuffer_parallel(const PathScene<float>&, const Vec3<float>&, std::int64_t,
                                     const GBuffer<float>&, std::int64_t, const float*,
                                     const float*, const float*, float*);
template void light_gbuffer_parallel(const PathScene<double>&, const Vec3<double>&, std::int64_t,
                                     const GBuffer<double>&, std::int64_t, const double*,
                                     const double*, const double*, double*);

template void sample_gbuffer(const PathScene<float>&, const Vec3<float>&, std::int64_t,
                             const GBuffer<float>&, const float*, float*, float*, float*);
template void gbuffer_pdf(const PathScene<float>&, const Vec3<float>&, std::int64_t,
                          const GBuffer<float>&, const float*, float*);
template void sample_gbuffer(const PathScene<double>&, const Vec3<double>&, std::int64_t,
                             const GBuffer<double>&, const double*, double*, double*, double*);
template void gbuffer_pdf(const PathScene<double>&, const Vec3<double>&, std::int64_t,
                          const GBuffer<double>&, const double*, double*);

}  // namespace photograd
