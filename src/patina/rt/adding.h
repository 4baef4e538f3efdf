#pragma once
// Adding: what a layer or an interface makes of the reflection of all that lies below it.

#include <Eigen/Dense>

#include "patina/rt/boundary.h"
#include "patina/rt/layer_operators.h"
#include "patina/rt/rough_interface.h"

namespace patina::rt {

// Light between a layer (or interface) and what is below it: the reflection of both together, and the operator that
// gives the downward light between them from the downward light above. An empty matrix `below` reflects nothing.
struct Added {
    Eigen::MatrixXd reflection;
    Eigen::MatrixXd downward;
};

// downward = (1 - R below)^-1 T, reflection = R + T below downward.
Added add_layer(const LayerOperators<double>& layer, const Eigen::MatrixXd& below);
// The same for an interface. `specular` includes the reflection at the interface itself.
Added add_interface(const Interface& interface, const Eigen::MatrixXd& below, Components components, int rays_below,
                    bool specular);

// The same for a rough interface; what it reflects itself is no delta and always included.
Added add_rough_interface(const RoughInterface::Operators& interface, const Eigen::MatrixXd& below);

// Reflection of the base below a medium; empty when black.
Eigen::MatrixXd base_reflection(const Base& base, const Medium& medium, int m, Components components);

}  // namespace patina::rt
