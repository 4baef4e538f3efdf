#pragma once
// Stokes radiances of a recipe at exact directions and depths: how a benchmark table is checked.

#include <optional>
#include <string>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/core/progress.h"
#include "patina/rt/solver.h"

namespace patina::jobs {

struct FieldJob {
    double theta_i_deg = 0.0;
    std::vector<double> theta_o_deg;
    std::vector<double> phi_deg;
    optics::Stokes incident{1, 0, 0, 0};
    std::vector<double> optical_depths;   // empty = top upward and bottom downward
    std::optional<double> wavelength_nm;  // needed unless the recipe is wavelength-independent
    int streams = 0;                      // 0 = chosen
    std::string solver = "doubling";
    bool scalar = false;
    std::int64_t samples = 1'000'000;  // photon packets of a statistical solver
    std::uint64_t seed = 1;
};

struct FieldValue {
    double optical_depth;
    bool upward;
    double theta_deg, phi_deg;
    optics::Stokes stokes;  // diffuse radiance for a beam of flux pi through a plane normal to it
    std::optional<optics::Stokes> standard_error;  // of a statistical solver
};

struct FieldResult {
    std::vector<FieldValue> radiance;
    optics::Mueller specular_surface, specular_coherent;  // delta part at theta_i, radiance out / radiance in
    double optical_thickness;
    rt::Diagnostics diagnostics;
    std::vector<std::string> notes;
};

// Throws Error(interrupted) when stopped.
FieldResult field(const coating::Recipe& recipe, const FieldJob& job, const JobControl& control = {});

}  // namespace patina::jobs
