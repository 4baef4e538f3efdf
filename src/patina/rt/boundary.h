#pragma once
// Interfaces between media and the base under a stack, acting ray by ray, and the coherent light they pass on.
//
// Variables are those of TransferSystem: upward radiance is multiplied by Delta = diag(1,1,-1,-1), and
// sqrt(flux_weight) I / n^2 makes refraction the plain matrix of transmitted flux.

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "patina/optics/stokes.h"
#include "patina/rt/kernel.h"
#include "patina/rt/nodes.h"
#include "patina/rt/problem.h"

namespace patina::rt {

// 4x4 Mueller matrices, one a ray, from the rays of one medium (`columns`) to those of another (`rows`).
class RayMatrix {
  public:
    struct Entry {
        int row, column;  // positions in the media
        optics::Mueller mueller;
    };
    RayMatrix(int rows, int columns) : rows_(rows), columns_(columns) {}
    void add(int row, int column, const optics::Mueller& mueller) { entries_.push_back({row, column, mueller}); }

    // The product with a dense operator of the given components, the matrix itself, and the sum.
    Eigen::MatrixXd times(const Eigen::MatrixXd& dense, Components components) const;
    Eigen::MatrixXd dense(Components components) const;
    void add_to(Eigen::MatrixXd& dense, Components components) const;

  private:
    int rows_, columns_;
    std::vector<Entry> entries_;
};

// A smooth interface between an upper and a lower medium.
struct Interface {
    RayMatrix reflection_above, reflection_below;  // seen from above, from below
    RayMatrix transmission_down, transmission_up;
};
Interface interface_between(const std::vector<Ray>& rays, const Medium& upper, const Medium& lower);

// The same for one ray: zero where the ray does not exist, and no interface where the indices are equal.
struct RayInterface {
    optics::Mueller reflection_above = optics::Mueller::Zero(), reflection_below = optics::Mueller::Zero();
    optics::Mueller transmission_down = optics::Mueller::Zero(), transmission_up = optics::Mueller::Zero();
};
RayInterface interface_of_ray(const Ray& ray, double upper, double lower);
// What a base reflects as a mirror at cosine mu in the medium of `index`: a smooth metal, the delta part of a table;
// zero for other bases. Upward light is not multiplied by Delta.
optics::Mueller mirror_reflection(const Base& base, double mu, double index);

// The same ray by ray, upward light times Delta; nothing for bases that are no mirror.
std::optional<RayMatrix> mirror(const Base& base, const Medium& medium);
// Adds the reflection of a Lambertian base at m = 0.
void add_lambertian(const Base& base, const Medium& medium, Components components, Eigen::MatrixXd& reflection);

// Mueller matrix of the whole stack for light that is never scattered, without the reflection at its top interface; for
// the ray of given cosine in the medium above. Zero when nothing reflects below the top.
optics::Mueller coherent_reflection(const Problem& problem, const Ray& ray);

}  // namespace patina::rt
