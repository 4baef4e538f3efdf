#include "patina/render/integrators/subsurface_probe.h"

#include <array>

namespace patina::render {

namespace {

constexpr int most_hits = 16;         // a line meets no sensible body more often; further ones are left out
constexpr float farthest_decay = 30;  // exp(-30) is nothing in single precision

constexpr std::array<float, 3> axis_share = {0.25f, 0.25f, 0.5f};  // of s, t, n

// Density per area of a disk, of one wavelength chosen by its share.
float disk_density(const DipoleProfile& profile, Float4 share, float r) {
    return sum(share * profile.at(r) / max(profile.total, splat(1e-30f)));
}

}  // namespace

bool sample_subsurface(const Geometry& geometry, const DipoleProfile& profile, const SurfacePoint& from, Float4 share,
                       float u_axis, const Vec2& u_disk, float u_hit, SubsurfaceEntry& entry, float time) {
    // Choose an axis, a wavelength, and a place on the disk.
    const Frame frame(from.geometric_normal);
    const std::array<Vec3, 3> axes = {frame.s, frame.t, frame.n};
    int axis = 2;
    float u = u_axis;
    for (int i = 0; i < 2 && axis == 2; ++i) {
        if (u < axis_share[i])
            axis = i;
        else
            u -= axis_share[i];
    }
    u = std::min(u / axis_share[axis], 0x1.fffffep-1f);
    int lane = 0;
    while (lane + 1 < wavelengths_per_path && u >= share[lane]) u -= share[lane++];
    const float radius = profile.sample_radius(lane, u_disk.x()), azimuth = 2 * pi_f * u_disk.y();
    const float size = 2 * geometry.radius();
    if (!(radius < size)) return false;
    const Vec3 foot =
        from.position + radius * (axes[(axis + 1) % 3] * std::cos(azimuth) + axes[(axis + 2) % 3] * std::sin(azimuth));

    // Meet the surface along the line through it.
    const float decay = std::min(std::min(profile.sigma_tr[0], profile.sigma_tr[1]),
                                 std::min(profile.sigma_tr[2], profile.sigma_tr[3]));
    const float reach = std::min(size, farthest_decay / std::max(decay, 1e-30f));
    Ray ray{foot - reach * axes[axis], axes[axis], 2 * reach, time};
    std::array<SurfacePoint, most_hits> found;
    int count = 0;
    for (Hit hit; count < most_hits && geometry.intersect(ray, hit); hit = Hit{}) {
        const SurfacePoint point = geometry.surface(ray, hit);
        if (hit.shape == from.shape) found[count++] = point;
        ray.origin = point.origin(ray.direction);
        ray.t_max -= hit.t;
        if (!(ray.t_max > 0)) break;
    }
    if (count == 0) return false;
    entry.point = found[std::min(static_cast<int>(u_hit * count), count - 1)];

    // Weigh it by all the ways in which it might have been found.
    const Vec3 d = entry.point.position - from.position;
    float density = 0;
    for (int i = 0; i < 3; ++i) {
        const float along = d.dot(axes[i]);
        if (std::abs(along) > reach) continue;
        const float across = safe_sqrt(d.squaredNorm() - along * along);
        density +=
            axis_share[i] * std::abs(axes[i].dot(entry.point.geometric_normal)) * disk_density(profile, share, across);
    }
    if (!(density > 0)) return false;
    entry.weight = profile.at(d.norm()) * (static_cast<float>(count) / density);
    return true;
}

}  // namespace patina::render
