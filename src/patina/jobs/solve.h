#pragma once
// Recipe in, Mueller BRDF table out: every wavelength's problem is set up and solved.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "patina/brdf/mueller_table.h"
#include "patina/coating/recipe.h"
#include "patina/core/progress.h"
#include "patina/rt/solver.h"

namespace patina::jobs {

struct SolveRequest {
    std::vector<double>
        wavelengths_nm;  // ascending; empty = 380 to 780 nm every 5 nm, or one for a recipe without colour
    // With no wavelengths given: chosen between these two, so that linear interpolation between them errs by less than
    // the tolerance.
    std::optional<std::pair<double, double>> automatic_range_nm;
    int streams = 0;  // quadrature nodes per hemisphere in air; 0 = chosen from the tolerance
    // Largest error of any element of the body BRDF between zenith angles of 0 and 85 deg, both ways, in units of the
    // largest f00 there at the same wavelength.
    double tolerance = 1e-3;
    std::string solver = "doubling";
    std::string command;  // for provenance
    // Where finished wavelengths are kept while the job runs; empty: nowhere. The caller removes the file when the
    // result is safe.
    std::filesystem::path checkpoint;
    bool resume = false;  // go on with the checkpoint of the same job, if there is one; the same bits come out
};

struct SolvePlan {
    std::vector<double> wavelengths_nm;
    // Of linear interpolation between chosen wavelengths, in the units of `tolerance`; nothing when they were given.
    std::optional<double> wavelength_error;
    int streams = 0;
    int largest_expansion_order = 0;
    std::vector<std::string> notes;      // sorted, each once
    std::vector<std::string> citations;  // of the materials, likewise
};

struct SolveResult {
    brdf::MuellerTable table;  // with its error estimate, an upper bound in 1/sr; statistical solvers give none
    SolvePlan plan;
    bool interrupted = false;     // the table holds the wavelengths that were done
    bool converged = true;        // every wavelength's error estimate is within the tolerance
    double relative_error = 0.0;  // largest error estimate in the units of `tolerance`
    std::size_t resumed = 0;      // results taken from the checkpoint
};

// What solve() would do, without solving.
SolvePlan plan_solve(const coating::Recipe& recipe, const SolveRequest& request);

// Wavelengths run in parallel; the result does not depend on the number of threads.
// Throws Error(input) for what the recipe or the solver cannot do and for a checkpoint of another job,
// Error(interrupted) when stopped before anything is done, Error(runtime) when the checkpoint cannot be written.
SolveResult solve(const coating::Recipe& recipe, const SolveRequest& request, const JobControl& control = {});

}  // namespace patina::jobs
