#include "patina/rt/monte_carlo/stack.h"

#include <array>
#include <cmath>

namespace patina::rt::monte_carlo {

InterfaceGains Stack::interface(double cos_i, double n1, double n2) const {
    InterfaceGains gains = dielectric_interface(cos_i, n1, n2);
    if (scalar) {
        gains.reflect = unpolarized(gains.reflect);
        gains.transmit = unpolarized(gains.transmit);
    }
    return gains;
}

Gain Stack::mirror(double cos_i) const {
    const Gain gain = metal_mirror(cos_i, layers.back().index, std::get<MetalBase>(base).refractive_index);
    return scalar ? unpolarized(gain) : gain;
}

double Stack::lambertian_reflectance() const {
    const auto* lambertian = std::get_if<LambertianBase>(&base);
    return lambertian ? lambertian->reflectance : 0.0;
}

Stack make_stack(const Problem& problem, bool scalar, double deepest_level) {
    Stack stack{problem.refractive_index_above, {}, problem.base, scalar};
    double above = 0.0;
    for (const Layer& layer : problem.layers) {
        const double w = layer.single_scattering_albedo, g = layer.expansion.asymmetry();
        double thickness = layer.optical_thickness;
        if (std::isinf(thickness)) {
            stack.base = BlackBase{};
            if (1.0 - w < 1e-6) {
                thickness = std::max(0.0, deepest_level - above) + 20.0 / (1.0 - std::clamp(g, 0.0, 0.999));
                stack.base = LambertianBase{std::exp(-4.0 * std::sqrt((1.0 - w) / (3.0 * (1.0 - w * g))))};
            }
        }
        above += thickness;
        stack.layers.push_back({thickness, w, layer.refractive_index, ScatteringTable(layer.expansion, scalar)});
    }
    if (problem.has_rough_top())
        stack.rough_top.emplace(*problem.top_roughness, stack.index_above, stack.index(0), scalar);
    return stack;
}

SpecularStack::SpecularStack(const Stack& stack, double snell_invariant) : stack_(stack) {
    const auto cosine = [&](int layer) {
        const double sine = snell_invariant / stack.index(layer);
        return sine < 1.0 ? std::sqrt((1.0 - sine) * (1.0 + sine)) : 0.0;
    };
    const int count = stack.size();
    for (int l = 0; l < count; ++l) {
        mu_.push_back(cosine(l));
        attenuation_.push_back(mu_.back() > 0.0 ? std::exp(-stack.thickness(l) / mu_.back()) : 0.0);
    }

    // Amplitudes of every interface, from both sides; none where the wave does not propagate.
    faces_.resize(static_cast<std::size_t>(count) + 1);
    for (int j = stack.rough_top ? 1 : 0; j < count; ++j) {  // no light passes a rough top unscattered
        Face& face = faces_[static_cast<std::size_t>(j)];
        const double mu_above = j == 0 ? cosine(-1) : mu(j - 1), mu_below = mu(j);
        if (mu_above > 0.0) {
            const InterfaceGains gains = stack.interface(mu_above, stack.index(j - 1), stack.index(j));
            face.reflect_down = channels(gains.reflect);
            if (mu_below > 0.0) face.transmit_down = channels(gains.transmit);
        }
        if (mu_below > 0.0) {
            const InterfaceGains gains = stack.interface(mu_below, stack.index(j), stack.index(j - 1));
            face.reflect_up = channels(gains.reflect);
            if (mu_above > 0.0) face.transmit_up = channels(gains.transmit);
        }
    }
    if (stack.has_metal() && mu(count - 1) > 0.0) faces_.back().reflect_down = channels(stack.mirror(mu(count - 1)));
}

namespace {

// Solves x = A x + b for each of the three channels; rows are 2 layer (first unknown of a layer) and 2 layer + 1
// (second).
struct ChannelSystem {
    std::array<Eigen::MatrixXcd, 3> matrix;
    std::array<Eigen::VectorXcd, 3> source;

    explicit ChannelSystem(int layers) {
        for (auto& m : matrix) m = Eigen::MatrixXcd::Identity(2 * layers, 2 * layers);
        for (auto& s : source) s = Eigen::VectorXcd::Zero(2 * layers);
    }
    void couple(int row, int column, const Eigen::Array3cd& factor) {
        for (std::size_t c = 0; c < 3; ++c) matrix[c](row, column) -= factor[static_cast<Eigen::Index>(c)];
    }
    void drive(int row, const Eigen::Array3cd& value) {
        for (std::size_t c = 0; c < 3; ++c) source[c](row) += value[static_cast<Eigen::Index>(c)];
    }
    // Splits the solution into first and second unknowns.
    void solve(std::vector<Gain>& first, std::vector<Gain>& second) const {
        std::array<Eigen::VectorXcd, 3> x;
        for (std::size_t c = 0; c < 3; ++c) x[c] = matrix[c].partialPivLu().solve(source[c]);
        for (Eigen::Index row = 0; row < x[0].size(); ++row)
            (row % 2 == 0 ? first : second).push_back({x[0](row).real(), x[1](row).real(), x[2](row)});
    }
};

}  // namespace

SpecularStack::Importance SpecularStack::importance(const Level& level) const {
    const int count = stack_.size();
    ChannelSystem system(count);

    // Light that enters the detecting layer at its far face is detected on its way through.
    std::vector<double> from_bottom(static_cast<std::size_t>(count), 0.0), from_top(from_bottom);
    if (level.layer >= 0 && mu(level.layer) > 0.0) {
        const double m = mu(level.layer);
        (level.up ? from_bottom : from_top)[static_cast<std::size_t>(level.layer)] =
            level.up ? std::exp(-(stack_.thickness(level.layer) - level.tau) / m) : std::exp(-level.tau / m);
    }

    // Light at a face goes on by transmission (radiance scales with n^2) or comes back by reflection.
    for (int l = 0; l < count; ++l) {
        const std::size_t i = static_cast<std::size_t>(l);
        const Face &top = faces_[i], &bottom = faces_[i + 1];
        const double squeeze_up = std::pow(stack_.index(l - 1) / stack_.index(l), 2);
        if (l > 0) {
            system.couple(2 * l, 2 * (l - 1), squeeze_up * attenuation_[i - 1] * top.transmit_up);
            system.drive(2 * l, squeeze_up * from_bottom[i - 1] * top.transmit_up);
        } else if (level.layer < 0) {
            system.drive(0, squeeze_up * top.transmit_up);
        }
        system.couple(2 * l, 2 * l + 1, attenuation_[i] * top.reflect_up);
        system.drive(2 * l, from_top[i] * top.reflect_up);

        if (l + 1 < count) {
            const double squeeze_down = std::pow(stack_.index(l + 1) / stack_.index(l), 2);
            system.couple(2 * l + 1, 2 * (l + 1) + 1, squeeze_down * attenuation_[i + 1] * bottom.transmit_down);
            system.drive(2 * l + 1, squeeze_down * from_top[i + 1] * bottom.transmit_down);
        }
        system.couple(2 * l + 1, 2 * l, attenuation_[i] * bottom.reflect_down);
        system.drive(2 * l + 1, from_bottom[i] * bottom.reflect_down);
    }
    Importance result;
    system.solve(result.up_at_top, result.down_at_bottom);
    return result;
}

SpecularStack::Beam SpecularStack::beam() const {
    const int count = stack_.size();
    ChannelSystem system(count);
    for (int l = 0; l < count; ++l) {
        const std::size_t i = static_cast<std::size_t>(l);
        const Face &top = faces_[i], &bottom = faces_[i + 1];
        if (l > 0)
            system.couple(2 * l, 2 * (l - 1), attenuation_[i - 1] * top.transmit_down);
        else
            system.drive(0, top.transmit_down);
        system.couple(2 * l, 2 * l + 1, attenuation_[i] * top.reflect_up);
        if (l + 1 < count) system.couple(2 * l + 1, 2 * (l + 1) + 1, attenuation_[i + 1] * bottom.transmit_up);
        system.couple(2 * l + 1, 2 * l, attenuation_[i] * bottom.reflect_down);
    }
    Beam result;
    system.solve(result.down_at_top, result.up_at_bottom);
    return result;
}

}  // namespace patina::rt::monte_carlo
