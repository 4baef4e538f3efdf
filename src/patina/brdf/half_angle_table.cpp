#include "patina/brdf/half_angle_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/brdf/interpolation.h"
#include "patina/brdf/meridian_frame.h"
#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/parallel.h"

namespace patina::brdf {

using Eigen::Vector3d;
using optics::Mueller;

namespace {

using RowMajorMueller = Eigen::Matrix<float, 4, 4, Eigen::RowMajor>;

// Axes rounded to float may overshoot pi by this.
constexpr double float_slack = 1e-6;

// The azimuth of a horizontal part; 0 along the normal.
double azimuth(const Vector3d& v) {
    return std::hypot(v.x(), v.y()) < 1e-12 ? 0.0 : std::atan2(v.y(), v.x());
}

// Stokes in the meridian frame -> Stokes in the frame with the axis x, for one ray. The meridian frame has s x p = k,
// so the right-handed frame about k that starts at p has its second axis along -s: U changes sign, V does not, because
// V tells the sense of rotation and no frame. Then the frame is turned by alpha from p to x.
Mueller frame_change(const MeridianFrame& frame, const Vector3d& x) {
    const double cosine = frame.p.dot(x), sine = frame.propagation.cross(frame.p).dot(x);
    const double c = cosine * cosine - sine * sine, s = 2 * sine * cosine;
    Mueller rotation = Mueller::Identity();
    rotation.block<2, 2>(1, 1) << c, s, -s, c;
    return rotation * optics::reversal();
}

struct FramePair {
    Mueller in, out;  // meridian -> table
};

FramePair frame_changes(const DirectionPair& pair) {
    const MeridianFrame in = meridian_frame(-pair.i.z(), azimuth(-pair.i));
    const MeridianFrame out = meridian_frame(pair.o.z(), azimuth(pair.o));
    return {frame_change(in, pair.stokes_x), frame_change(out, pair.stokes_x)};
}

void require_axis(const SourceLocation& where, const char* name, const std::vector<double>& axis, double lower,
                  double upper) {
    if (axis.size() < 2)
        throw input_error(where, fmt::format("axis {} has {} values", name, axis.size()), "at least 2");
    for (std::size_t k = 0; k < axis.size(); ++k) {
        if (!(axis[k] >= lower - float_slack && axis[k] <= upper + float_slack))
            throw input_error(where, fmt::format("axis {} holds {}", name, axis[k]),
                              fmt::format("it must lie in {:.4f} .. {:.4f} rad", lower, upper));
        if (k > 0 && !(axis[k] > axis[k - 1])) throw input_error(where, fmt::format("axis {} does not ascend", name));
    }
}

std::vector<double> equally_spaced(double lower, double upper, int count) {
    std::vector<double> values(count);
    for (int k = 0; k < count; ++k) values[k] = lower + (upper - lower) * k / (count - 1);
    return values;
}

}  // namespace

DirectionPair directions(const HalfAngles& angles) {
    // By isotropy h lies in the x-z plane; b = y and t = b x h are their limits where h is along z.
    const Vector3d h(std::sin(angles.theta_h), 0, std::cos(angles.theta_h)), b(0, 1, 0), t = b.cross(h);
    const Vector3d across = std::cos(angles.phi_d) * t + std::sin(angles.phi_d) * b;
    const Vector3d along = std::cos(angles.theta_d) * h, aside = std::sin(angles.theta_d) * across;
    // i x o = 2 cos(theta_d) sin(theta_d) across x h.
    return {along + aside, along - aside, across.cross(h)};
}

HalfAngles half_angles(const Vector3d& i, const Vector3d& o) {
    const Vector3d h = (i + o).normalized();
    const Vector3d normal_cross_h(-h.y(), h.x(), 0.0);
    const Vector3d b = normal_cross_h.norm() > 1e-12 ? normal_cross_h.normalized() : Vector3d(0, 1, 0);
    const Vector3d t = b.cross(h), across = i - i.dot(h) * h;
    return {std::acos(std::clamp(h.z(), -1.0, 1.0)), std::atan2(across.norm(), h.dot(i)),
            across.norm() > 1e-12 ? std::atan2(b.dot(across), t.dot(across)) : 0.0};
}

Mueller to_half_angle_frames(const Mueller& meridian, const DirectionPair& pair) {
    const FramePair frames = frame_changes(pair);
    return frames.out * meridian * frames.in.transpose();  // orthogonal matrices
}

Mueller to_meridian_frames(const Mueller& half_angle, const DirectionPair& pair) {
    const FramePair frames = frame_changes(pair);
    return frames.out.transpose() * half_angle * frames.in;
}

double relative_azimuth(const DirectionPair& pair) {
    return azimuth(pair.o) - azimuth(-pair.i);
}

void HalfAngleTable::validate(const SourceLocation& where) const {
    require_axis(where, "theta_h", theta_h, 0.0, pi / 2);
    require_axis(where, "theta_d", theta_d, 0.0, pi / 2);
    require_axis(where, "phi_d", phi_d, -pi, pi);
    if (wavelengths_nm.empty()) throw input_error(where, "there is no wavelength");
    for (std::size_t k = 0; k < wavelengths_nm.size(); ++k)
        if (!(wavelengths_nm[k] > 0) || (k > 0 && wavelengths_nm[k] <= wavelengths_nm[k - 1]))
            throw input_error(where, fmt::format("the wavelengths do not ascend at {} nm", wavelengths_nm[k]));
    const std::size_t expected = 16 * theta_h.size() * theta_d.size() * phi_d.size() * wavelengths_nm.size();
    if (mueller.size() != expected)
        throw input_error(where, fmt::format("M holds {} numbers", mueller.size()),
                          fmt::format("its axes make {}", expected));
    if (std::ranges::any_of(mueller, [](float value) { return std::isinf(value); }))
        throw input_error(where, "M holds an infinity");
}

Mueller HalfAngleTable::evaluate(double wavelength_nm, const HalfAngles& angles) const {
    const LinearInterval axes[4] = {linear_interval(phi_d, angles.phi_d), linear_interval(theta_d, angles.theta_d),
                                    linear_interval(theta_h, angles.theta_h),
                                    linear_interval(wavelengths_nm, wavelength_nm)};
    const std::size_t sizes[4] = {phi_d.size(), theta_d.size(), theta_h.size(), wavelengths_nm.size()};
    Mueller result = Mueller::Zero();
    for (int corner = 0; corner < 16; ++corner) {
        std::size_t index = 0;
        double weight = 1.0;
        for (int axis = 0; axis < 4; ++axis) {
            const bool upper = (corner >> axis) & 1;
            index = index * sizes[axis] + (upper ? axes[axis].upper : axes[axis].lower);
            weight *= upper ? axes[axis].upper_weight : 1 - axes[axis].upper_weight;
        }
        if (weight > 0) result += weight * RowMajorMueller::Map(mueller.data() + 16 * index).cast<double>();
    }
    if (result.hasNaN()) return Mueller::Zero();
    result(0, 0) = std::max(result(0, 0), 0.0);
    return result;
}

Mueller HalfAngleTable::evaluate_meridian(double wavelength_nm, double mu_o, double mu_i, double phi) const {
    // The light arrives with azimuth 0, so the source lies at azimuth pi.
    const Vector3d i = -meridian_frame(-mu_i, 0.0).propagation, o = meridian_frame(mu_o, phi).propagation;
    const HalfAngles angles = half_angles(i, o);

    // Where i x o vanishes the table's own axis, at the same phi_d, is brought to these directions by a turn about z.
    DirectionPair pair{i, o, i.cross(o)};
    if (pair.stokes_x.norm() > 1e-9) {
        pair.stokes_x.normalize();
    } else {
        const double turn = azimuth((i + o).normalized());
        pair.stokes_x = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * directions(angles).stokes_x;
    }

    // The meridian plane of a ray along the normal is the one at the azimuth asked for.
    const Mueller value = evaluate(wavelength_nm, angles);
    const Mueller in = frame_change(meridian_frame(-mu_i, 0.0), pair.stokes_x);
    const Mueller out = frame_change(meridian_frame(mu_o, phi), pair.stokes_x);
    return out.transpose() * value * in;
}

std::vector<double> five_wavelengths(const MuellerTable& table) {
    PATINA_EXPECT(!table.wavelengths_nm.empty());
    const double first = table.wavelengths_nm.front(), last = table.wavelengths_nm.back();
    if (first <= 450 && last >= 650) return {450, 500, 550, 600, 650};
    // A table of one wavelength is constant around it: five distinct numbers keep readers from dividing by zero.
    const double middle = (first + last) / 2, reach = std::max(2.0, (last - first) / 2);
    std::vector<double> values = equally_spaced(middle - reach, middle + reach, 5);
    for (double& value : values) value = std::round(value);
    return values;
}

HalfAngleTable to_half_angles(const MuellerTable& table, const HalfAngleGrid& grid) {
    PATINA_EXPECT(grid.theta_h >= 2 && grid.theta_d >= 2 && grid.phi_d >= 2);
    HalfAngleTable result;
    result.theta_h = equally_spaced(0, pi / 2, grid.theta_h);
    result.theta_d = equally_spaced(0, pi / 2, grid.theta_d);
    result.phi_d = equally_spaced(-pi, pi, grid.phi_d);
    result.wavelengths_nm = grid.wavelengths_nm.empty() ? five_wavelengths(table) : grid.wavelengths_nm;
    const std::size_t wavelengths = result.wavelengths_nm.size();
    result.mueller.resize(std::size_t{16} * grid.phi_d * grid.theta_d * grid.theta_h * wavelengths);
    const auto place = [&](int p, int d, int h, std::size_t w) {
        const std::size_t direction = (static_cast<std::size_t>(p) * grid.theta_d + d) * grid.theta_h + h;
        return result.mueller.data() + 16 * (direction * wavelengths + w);
    };

    // One half of the azimuths; the mirror image of the other half turns U and V round.
    const int half = (grid.phi_d + 1) / 2;
    const Mueller mirror = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
    parallel_for(0, half * grid.theta_d, [&](std::ptrdiff_t row) {
        const int p = grid.phi_d - 1 - static_cast<int>(row) / grid.theta_d, d = static_cast<int>(row) % grid.theta_d;
        for (int h = 0; h < grid.theta_h; ++h) {
            const DirectionPair pair = directions({result.theta_h[h], result.theta_d[d], result.phi_d[p]});
            const FramePair frames = frame_changes(pair);
            const double mu_o = std::clamp(pair.o.z(), 0.0, 1.0), mu_i = std::clamp(pair.i.z(), 0.0, 1.0);
            for (std::size_t w = 0; w < wavelengths; ++w) {
                const Mueller value = frames.out *
                                      table.evaluate(result.wavelengths_nm[w], mu_o, mu_i, relative_azimuth(pair)) *
                                      frames.in.transpose();
                RowMajorMueller::Map(place(p, d, h, w)) = value.cast<float>();
                RowMajorMueller::Map(place(grid.phi_d - 1 - p, d, h, w)) = (mirror * value * mirror).cast<float>();
            }
        }
    });
    return result;
}

}  // namespace patina::brdf
