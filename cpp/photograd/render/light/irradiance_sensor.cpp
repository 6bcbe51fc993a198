#include "photograd/render/light/irradiance_sensor.h"

#include "photograd/core/parallel.h"

namespace photograd {
namespace {

constexpr std::int64_t slab_chunks = 32;  // whose contributions are held at a time

struct Contribution {
    std::int64_t cell;
    Vec3<double> flux;
};

class SensorVisitor : public FluxVisitor {
public:
    SensorVisitor(const IrradianceSensor& sensor, double epsilon, std::vector<Contribution>& out)
        : sensor_(sensor), epsilon_(epsilon), out_(out) {}

    double intersect(const Ray<double>& ray, double length) override {
        double t = -1;
        cell_ = sensor_.intersect(ray, length, epsilon_, t);
        return cell_ >= 0 ? t : -1.0;
    }
    void splat(int k, const Vec3<double>& beta) override {
        out_.push_back({cell_, flux[k] * beta});
    }

private:
    const IrradianceSensor& sensor_;
    double epsilon_;
    std::vector<Contribution>& out_;
    std::int64_t cell_ = -1;
};

}  // namespace

double IrradianceSensor::cell_area() const {
    return length(cross(edge_x, edge_y)) / static_cast<double>(height * width);
}

std::int64_t IrradianceSensor::intersect(const Ray<double>& ray, double length, double epsilon,
                                         double& t) const {
    const Vec3<double> normal = normalize(cross(edge_x, edge_y));
    const double above = dot(ray.origin - corner, normal), falling = -dot(ray.direction, normal);
    if (!(above > 0) || !(falling > 0)) return -1;
    if (!(above - falling * length <= epsilon)) return -1;
    t = std::min(above / falling, length);
    const Vec3<double> p = ray.at(t) - corner;
    const double x = dot(p, edge_x) / dot(edge_x, edge_x), y = dot(p, edge_y) / dot(edge_y, edge_y);
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return -1;
    const auto column = static_cast<std::int64_t>(x * static_cast<double>(width)),
               from_below = static_cast<std::int64_t>(y * static_cast<double>(height));
    return (height - 1 - from_below) * width + column;
}

void trace_irradiance(const PathScene<double>& scene, const ParticleOptions& options,
                      const ParticleRange& particles, const IrradianceSensor& sensor,
                      const PathSums& sums) {
    const double epsilon = 2 * scene.geometry->offset, share = 1 / sensor.cell_area();
    const auto chunks =
        static_cast<std::int64_t>((particles.count + chunk_particles - 1) / chunk_particles);
    std::vector<std::vector<Contribution>> found(
        static_cast<std::size_t>(std::min(slab_chunks, chunks)));
    for (std::int64_t start = 0; start < chunks; start += slab_chunks) {
        const std::int64_t count = std::min(slab_chunks, chunks - start);
        parallel_for(count, [&](std::int64_t i) {
            std::vector<Contribution>& own = found[static_cast<std::size_t>(i)];
            own.clear();
            const auto begin = static_cast<std::uint64_t>(start + i) * chunk_particles,
                       end = std::min(begin + chunk_particles, particles.count);
            SensorVisitor visitor(sensor, epsilon, own);
            trace_particles(scene, options, {particles.first + begin, end - begin}, visitor);
        });
        // Chunk by chunk, in their order, by one thread: adding is little work beside tracing.
        for (std::int64_t i = 0; i < count; ++i)
            for (const Contribution& one : found[static_cast<std::size_t>(i)])
                sums.add(one.cell, one.flux * share);
    }
}

}  // namespace photograd
