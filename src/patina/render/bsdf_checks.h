#pragma once
// The laws every reflection model obeys, tried on the models of a scene: what `patina check` does with them.

#include <string>
#include <vector>

#include "patina/core/properties.h"
#include "patina/render/scene_resources.h"

namespace patina::render {

struct BsdfCheck {
    std::string name, explanation;  // the law, and in what `worst` is measured
    double worst = 0, tolerance = 0;
    double wavelength_nm = 0, theta_o_deg = 0;  // where the worst was seen; theta_o > 90: from behind
    bool passed() const { return worst <= tolerance; }
};

struct BsdfReport {
    std::string type, id;
    SourceLocation where;
    std::vector<BsdfCheck> checks;
    bool passed() const;
};

// Every model below `root` once, in the order of the file, each by
//   energy         in unpolarized surroundings of radiance 1 nothing brighter than 1 is seen through any polarizer
//   twice
//                  over (I + degree of polarization I), transmission scaled by the index squared
//   realizability  no matrix makes light with more than 100 % polarization (Cloude 1986)
//   reciprocity    f(i, o) = D f(o, i)^T D, D = diag(1, 1, -1, 1), of pairs on one side
//   sampling       the density of a drawn direction is the density that evaluation gives it
// at eight wavelengths and twenty directions of view. Throws Error(input) for models that cannot be built.
std::vector<BsdfReport> check_bsdfs(const Properties& root, const SceneResources& resources);

}  // namespace patina::render
