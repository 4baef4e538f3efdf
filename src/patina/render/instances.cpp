#include "patina/render/instances.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "patina/core/contract.h"

namespace patina::render {

namespace {

struct Pose {
    Eigen::Quaterniond rotation;
    Eigen::Matrix3d stretch;
    Eigen::Vector3d place;
};

Pose pose_of(const Eigen::Matrix4d& m) {
    Eigen::Affine3d affine(m);
    Eigen::Matrix3d rotation, stretch;
    affine.computeRotationScaling(&rotation, &stretch);
    return {Eigen::Quaterniond(rotation), stretch, m.block<3, 1>(0, 3)};
}

Eigen::Matrix4d between(const Eigen::Matrix4d& a, const Eigen::Matrix4d& b, double share) {
    const Pose from = pose_of(a), to = pose_of(b);
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 3>(0, 0) =
        from.rotation.slerp(share, to.rotation).toRotationMatrix() * ((1 - share) * from.stretch + share * to.stretch);
    m.block<3, 1>(0, 3) = (1 - share) * from.place + share * to.place;
    return m;
}

}  // namespace

Eigen::Matrix4f Instance::at(float time) const {
    if (to_world.size() == 1) return to_world.front();
    const float x = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(to_world.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), to_world.size() - 2);
    const float share = x - static_cast<float>(i);
    return (1 - share) * to_world[i] + share * to_world[i + 1];
}

Eigen::AlignedBox3f Instance::bounds(const Eigen::AlignedBox3f& group_box) const {
    Eigen::AlignedBox3f box;
    for (const Eigen::Matrix4f& m : to_world)
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 p = group_box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner));
            box.extend(Vec3(m.block<3, 3>(0, 0) * p + m.block<3, 1>(0, 3)));
        }
    return box;
}

std::vector<Eigen::Matrix4f> sample_animation(const std::vector<double>& times_s,
                                              const std::vector<Eigen::Matrix4d>& transforms, double open, double close,
                                              int count) {
    PATINA_EXPECT(!times_s.empty() && times_s.size() == transforms.size() && count >= 1);
    std::vector<Eigen::Matrix4f> samples;
    for (int i = 0; i < count; ++i) {
        const double t = count > 1 ? open + (close - open) * i / (count - 1) : open;
        const auto after =
            static_cast<std::size_t>(std::upper_bound(times_s.begin(), times_s.end(), t) - times_s.begin());
        Eigen::Matrix4d m;
        if (after == 0)
            m = transforms.front();
        else if (after == times_s.size())
            m = transforms.back();
        else
            m = between(transforms[after - 1], transforms[after],
                        (t - times_s[after - 1]) / (times_s[after] - times_s[after - 1]));
        samples.push_back(m.cast<float>());
    }
    return samples;
}

}  // namespace patina::render
