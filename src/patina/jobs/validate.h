#pragma once
// Every published benchmark against every solver that can do it: the numbers to judge the program by.

#include <array>
#include <string>
#include <vector>

#include "patina/core/progress.h"

namespace patina::jobs {

struct ValidateRequest {
    std::string solver;  // empty = every registered one
};

struct ValidatedCase {
    std::string name, source, quantity, tolerance;
    std::string solver;                     // empty where no solver takes part
    std::array<std::string, 4> components;  // what the four columns of `largest` are
    std::array<double, 4> largest{};        // largest absolute difference; negative where nothing was compared
    int count = 0;                          // values compared
    double worst = 0.0;                     // largest difference in units of what is allowed
    double seconds = 0.0;                   // wall clock
    std::string skipped;                    // why the solver did not run it; empty when it did

    bool passed() const { return !skipped.empty() || worst <= 1.0; }
};

// Intensity leaving the top of Siewert's problem IIA: published, solved with and without polarization.
struct ScalarError {
    double zenith_deg, phi_deg;
    double published, vector, scalar;
    double vector_percent() const { return 100.0 * (vector - published) / published; }
    double scalar_percent() const { return 100.0 * (scalar - published) / published; }
};

struct ValidationReport {
    std::string software;
    std::vector<ValidatedCase> cases;
    std::vector<ScalarError> cost_of_ignoring_polarization;  // by the default solver

    bool passed() const;
    int failures() const;
};

// Throws Error(usage) for an unknown solver, Error(interrupted) when stopped.
ValidationReport validate(const ValidateRequest& request, const JobControl& control = {});

// The report as one self-contained page, and as Markdown.
std::string to_html(const ValidationReport& report);
std::string to_markdown(const ValidationReport& report);

}  // namespace patina::jobs
