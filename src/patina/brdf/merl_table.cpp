#include "patina/brdf/merl_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "patina/brdf/interpolation.h"
#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/parallel.h"

namespace patina::brdf {

namespace {

// f00 of the three colours: all there is in a MERL table, so only these 3 of the modes' elements are kept.
class RgbIntensity {
  public:
    RgbIntensity(const MuellerTable& table, const Eigen::Matrix3Xd& weights)
        : weights_(weights),
          nodes_(Eigen::VectorXd::Map(table.mu.data(), static_cast<Eigen::Index>(table.mu.size()))),
          interpolation_(table.mu) {
        for (std::size_t w = 0; w < table.once_scattered.size(); ++w)
            for (const OnceScattered& layer : table.once_scattered[w])
                once_scattered_.emplace_back(static_cast<Eigen::Index>(w),
                                             OnceScatteredLight(layer, table.specular_theta_deg, 1'000'000));
        std::size_t orders = 0;
        for (const BodyModes& body : table.body) orders = std::max(orders, body.modes.size());
        const auto n = static_cast<Eigen::Index>(nodes_.size());
        modes_.assign(3, std::vector<Eigen::MatrixXd>(orders, Eigen::MatrixXd::Zero(n, n)));
        for (int color = 0; color < 3; ++color)
            for (std::size_t w = 0; w < table.body.size(); ++w)
                for (std::size_t m = 0; m < table.body[w].modes.size(); ++m)
                    modes_[color][m] += weights(color, static_cast<Eigen::Index>(w)) *
                                        table.body[w].modes[m](Eigen::seqN(0, n, 4), Eigen::seqN(0, n, 4));
    }

    Eigen::Vector3d operator()(double mu_o, double mu_i, double phi) const {
        // Odd modes are interpolated without their factor sin(theta_o) sin(theta_i), as MuellerTable::evaluate does.
        const Eigen::VectorXd even_o = interpolation_.weights(mu_o), even_i = interpolation_.weights(mu_i);
        const Eigen::ArrayXd sine = (1 - nodes_.array().square()).sqrt();
        const Eigen::VectorXd odd_o = even_o.array() / sine * std::sqrt(1 - mu_o * mu_o);
        const Eigen::VectorXd odd_i = even_i.array() / sine * std::sqrt(1 - mu_i * mu_i);
        Eigen::Vector3d result = Eigen::Vector3d::Zero();
        for (std::size_t m = 0; m < modes_[0].size(); ++m) {
            const double factor = (m == 0 ? 1.0 : 2.0) * std::cos(static_cast<double>(m) * phi);
            for (int color = 0; color < 3; ++color)
                result[color] +=
                    factor * (m % 2 == 0 ? even_o.dot(modes_[color][m] * even_i) : odd_o.dot(modes_[color][m] * odd_i));
        }
        for (const auto& [w, light] : once_scattered_) result += weights_.col(w) * light(mu_o, mu_i, phi)(0, 0);
        return result;
    }

  private:
    const Eigen::Matrix3Xd& weights_;
    std::vector<std::pair<Eigen::Index, OnceScatteredLight>> once_scattered_;  // with their wavelength
    Eigen::VectorXd nodes_;
    BarycentricInterpolation interpolation_;
    std::vector<std::vector<Eigen::MatrixXd>> modes_;  // [color][m] (N x N)
};

}  // namespace

std::size_t MerlTable::cell(const HalfAngles& angles) {
    const double phi = angles.phi_d < 0 ? angles.phi_d + pi : angles.phi_d;
    const auto index = [](double fraction, int count) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(fraction * count), 0, count - 1));
    };
    const std::size_t h = index(std::sqrt(std::max(0.0, angles.theta_h / (pi / 2))), theta_h_count);
    const std::size_t d = index(angles.theta_d / (pi / 2), theta_d_count), p = index(phi / pi, phi_d_count);
    return (h * theta_d_count + d) * phi_d_count + p;
}

HalfAngles MerlTable::middle(int theta_h, int theta_d, int phi_d) {
    const double root = (theta_h + 0.5) / theta_h_count;
    return {root * root * pi / 2, (theta_d + 0.5) / theta_d_count * pi / 2, (phi_d + 0.5) / phi_d_count * pi};
}

Eigen::Vector3d MerlTable::evaluate(const HalfAngles& angles) const {
    PATINA_EXPECT(rgb.size() == 3 * plane_size);
    const std::size_t place = cell(angles);
    return {rgb[place], rgb[plane_size + place], rgb[2 * plane_size + place]};
}

MerlTable to_merl(const MuellerTable& table, const Eigen::Matrix3Xd& rgb_weights, std::size_t* clamped) {
    PATINA_EXPECT(rgb_weights.cols() == static_cast<Eigen::Index>(table.wavelengths_nm.size()));
    const RgbIntensity intensity(table, rgb_weights);
    MerlTable result;
    result.rgb.resize(3 * MerlTable::plane_size);
    std::atomic<std::size_t> negative{0};
    parallel_for(0, MerlTable::theta_h_count * MerlTable::theta_d_count, [&](std::ptrdiff_t row) {
        const int h = static_cast<int>(row) / MerlTable::theta_d_count,
                  d = static_cast<int>(row) % MerlTable::theta_d_count;
        // The second half of phi_d is the first one seen backwards in a mirror: reciprocity and isotropy.
        for (int p = 0; p < MerlTable::phi_d_count / 2; ++p) {
            const DirectionPair pair = directions(MerlTable::middle(h, d, p));
            const Eigen::Vector3d color =
                intensity(std::clamp(pair.o.z(), 0.0, 1.0), std::clamp(pair.i.z(), 0.0, 1.0), relative_azimuth(pair));
            for (int twin : {p, MerlTable::phi_d_count - 1 - p})
                for (std::size_t c = 0; c < 3; ++c) {
                    const double value = color[static_cast<Eigen::Index>(c)];
                    if (value < 0) ++negative;
                    result.rgb[c * MerlTable::plane_size + row * MerlTable::phi_d_count + twin] = std::max(value, 0.0);
                }
        }
    });
    if (clamped) *clamped = negative;
    return result;
}

}  // namespace patina::brdf
