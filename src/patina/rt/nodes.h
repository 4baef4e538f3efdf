#pragma once
// The directions a solver works with, the same rays in every medium of the stack.
//
// A ray keeps its Snell invariant nu = n sin(theta) through all parallel interfaces. Quadrature nodes are Gauss nodes
// on segments of nu bounded by the refractive indices present, so that every medium integrates its hemisphere with the
// rays that exist in it and each refraction maps node to node: flux is conserved and reciprocity holds to rounding.
// View and beam directions are extra rays of zero weight: they receive (view) or emit (beam) light and take no part in
// the quadrature (de Haan, Bosma & Hovenier 1987, A&A 183, 371, section 4).

#include <vector>

#include <Eigen/Dense>

#include "patina/rt/problem.h"

namespace patina::rt {

enum class Role { quadrature, view, beam };

struct Ray {
    double cosine = 1.0;       // in the medium of `index`, (0, 1]
    double index = 1.0;        // refractive index of the medium `cosine` is given in
    double flux_weight = 1.0;  // n^2 mu w, the same in every medium; 1 for view and beam rays
    Role role = Role::quadrature;

    // Cosine in a medium of refractive index n; 0 when the ray is totally reflected before it gets there.
    double cosine_in(double n) const;
};

// The rays that propagate in one medium, in the order of the whole list.
struct Medium {
    double index = 1.0;
    std::vector<int> rays;  // positions in the list of rays
    Eigen::VectorXd mu;     // cosines, one a ray
    Eigen::VectorXd scale;  // sqrt(flux_weight)/n = sqrt(mu w) of a quadrature ray
    std::vector<Role> roles;

    int size() const { return static_cast<int>(rays.size()); }
    // Quadrature weight of d mu; 0 for view and beam rays.
    double weight(int i) const { return roles[i] == Role::quadrature ? scale[i] * scale[i] / mu[i] : 0.0; }
};

// Quadrature rays for a problem: `streams` Gauss nodes in the cosine of the lowest-index medium on (0, 1), and for each
// further distinct index n Gauss nodes in the cosine of that medium on (0, sqrt(1 - (n_previous/n)^2)), in proportion.
std::vector<Ray> quadrature_rays(const Problem& problem, int streams);

Medium medium_of(const std::vector<Ray>& rays, double index);

}  // namespace patina::rt
