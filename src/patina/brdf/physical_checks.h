#pragma once
// What every table must obey whatever the coating: the laws `patina check` tries on it.

#include <string>
#include <vector>

#include "patina/brdf/mueller_table.h"

namespace patina::brdf {

struct PhysicalCheck {
    std::string name;         // "positivity", ...
    std::string explanation;  // the law, and in what `worst` is measured
    bool passed = false;
    double worst = 0.0;      // the measured violation, 0 or negative where there is none
    double tolerance = 0.0;  // passed = worst <= tolerance
    // Where the worst was seen; angles that have no meaning for the check are NaN.
    double wavelength_nm = 0.0, theta_o_deg = 0.0, theta_i_deg = 0.0, phi_deg = 0.0;
};

struct PhysicalCheckOptions {
    // Violations allowed for rounding and the solver's own tolerance, relative to the values compared. The laws hold at the
    // nodes however few there are; energy alone is allowed the table's own error estimate on top.
    double relative_tolerance = 1e-5;
    // Undershoot of f00 allowed between the nodes, relative to the largest f00 for the same incidence.
    double interpolation_tolerance = 1e-2;
    int azimuths = 13;  // on 0 .. 180 deg; the other half follows by mirror symmetry
};

// Checks, in this order: positivity (f00 at the nodes), realizability (no Mueller matrix at the nodes makes light with
// more than 100 % polarization out of any; Cloude 1986), reciprocity, mirror symmetry, energy (body + specular, for the
// incident polarization that reflects most), interpolation (f00 between the nodes). The table must be valid.
std::vector<PhysicalCheck> check_physics(const MuellerTable& table, const PhysicalCheckOptions& options = {});

// Eigenvalues, ascending, of Cloude's coherency matrix H = 1/4 sum_jk M_jk (sigma_j x sigma_k*): all >= 0 exactly when
// M is a sum of Jones matrices' Mueller matrices. Their sum is M00.
Eigen::Vector4d coherency_eigenvalues(const optics::Mueller& mueller);

}  // namespace patina::brdf
