#pragma once
// What a solve keeps of each finished wavelength, and what that depends on.

#include <optional>
#include <span>
#include <vector>

#include "patina/coating/recipe.h"
#include "patina/jobs/checkpoint.h"
#include "patina/rt/solver.h"

namespace patina::jobs {

// One wavelength of a table.
struct SolvedWavelength {
    rt::Reflection reflection;  // its diagnostics are not kept
    double scale = 0.0, difference_from_half = 0.0;
};

std::vector<double> to_values(const SolvedWavelength& solved);
// Nothing for numbers that are not such a wavelength's.
std::optional<SolvedWavelength> to_solved_wavelength(std::span<const double> values);

// Everything the results of these problems depend on besides the number of streams.
std::string fingerprint_of(const std::vector<rt::Problem>& problems);

}  // namespace patina::jobs
