#include "patina/rt/adding.h"

namespace patina::rt {

Added add_layer(const LayerOperators<double>& layer, const Eigen::MatrixXd& below) {
    if (layer.transmission.size() == 0) return {layer.reflection, {}};
    if (below.size() == 0) return {layer.reflection, layer.transmission};
    const Eigen::Index n = layer.reflection.rows();
    Added result;
    Eigen::MatrixXd bounce = Eigen::MatrixXd::Identity(n, n);
    bounce.noalias() -= layer.reflection * below;
    result.downward = bounce.partialPivLu().solve(layer.transmission);
    const Eigen::MatrixXd upward = below * result.downward;
    result.reflection = layer.reflection;
    result.reflection.noalias() += layer.transmission * upward;
    return result;
}

Added add_interface(const Interface& interface, const Eigen::MatrixXd& below, Components components, int rays_below,
                    bool specular) {
    const Eigen::Index n = static_cast<Eigen::Index>(rays_below) * components.count;
    const Eigen::MatrixXd transmitted = interface.transmission_down.dense(components);
    Added result;
    if (below.size() == 0) {
        result.downward = transmitted;
        result.reflection = Eigen::MatrixXd::Zero(transmitted.cols(), transmitted.cols());
    } else {
        Eigen::MatrixXd bounce = -interface.reflection_below.times(below, components);
        bounce += Eigen::MatrixXd::Identity(n, n);
        result.downward = bounce.partialPivLu().solve(transmitted);
        result.reflection = interface.transmission_up.times(below * result.downward, components);
    }
    if (specular) interface.reflection_above.add_to(result.reflection, components);
    return result;
}

Added add_rough_interface(const RoughInterface::Operators& interface, const Eigen::MatrixXd& below) {
    if (below.size() == 0) return {interface.reflection_above, interface.transmission_down};
    const Eigen::Index n = interface.reflection_below.rows();
    Eigen::MatrixXd bounce = Eigen::MatrixXd::Identity(n, n);
    bounce.noalias() -= interface.reflection_below * below;
    Added result;
    result.downward = bounce.partialPivLu().solve(interface.transmission_down);
    const Eigen::MatrixXd upward = below * result.downward;
    result.reflection = interface.reflection_above;
    result.reflection.noalias() += interface.transmission_up * upward;
    return result;
}

Eigen::MatrixXd base_reflection(const Base& base, const Medium& medium, int m, Components components) {
    if (std::holds_alternative<BlackBase>(base)) return {};
    const Eigen::Index n = static_cast<Eigen::Index>(medium.size()) * components.count;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    if (const auto metal = mirror(base, medium)) metal->add_to(result, components);
    if (m == 0) add_lambertian(base, medium, components, result);
    return result;
}

}  // namespace patina::rt
