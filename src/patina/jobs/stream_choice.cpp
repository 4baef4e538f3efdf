#include "patina/jobs/stream_choice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/jobs/unit_progress.h"

namespace patina::jobs {

References::References(const rt::Solver& solver, const coating::Recipe& recipe,
                       const std::vector<double>& wavelengths_nm, double tolerance, double scattering_tolerance,
                       double fourier_tolerance, Checkpoint& checkpoint)
    : solver_(solver),
      recipe_(recipe),
      wavelengths_nm_(wavelengths_nm),
      tolerance_(tolerance),
      scattering_tolerance_(0.1 * scattering_tolerance),
      fourier_tolerance_(0.1 * fourier_tolerance),
      checkpoint_(checkpoint) {}

const brdf::MuellerGrid& References::at(std::size_t w, int streams) const {
    return grids_.at({w, streams});
}

void References::prepare(const std::vector<std::size_t>& wavelengths, int streams, const JobControl& control,
                         const std::string& stage) {
    std::vector<std::size_t> missing;
    for (const std::size_t w : wavelengths)
        if (!grids_.contains({w, streams})) missing.push_back(w);
    std::vector<brdf::MuellerGrid> solved(missing.size());
    UnitProgress progress(control, stage, missing.size());
    parallel_for(0, std::ssize(missing), [&](std::ptrdiff_t k) {
        stop_if_requested(control.cancel);
        const std::string at = fmt::format("{:g} nm", wavelengths_nm_[missing[k]]);
        solved[k] = solve(missing[k], {.streams = streams,
                                       .fourier_tolerance = fourier_tolerance_,
                                       .cancel = control.cancel,
                                       .progress = [&](double share) { progress.tell(k, 0.999 * share, at); }});
        progress.tell(k, 1.0, at);
    });
    for (std::size_t k = 0; k < missing.size(); ++k) grids_[{missing[k], streams}] = std::move(solved[k]);
}

brdf::MuellerGrid References::solve(std::size_t w, rt::SolveOptions options) const {
    const std::string key = fmt::format("reference of {} streams at {} nm", options.streams, wavelengths_nm_[w]);
    if (const auto kept = checkpoint_.find(key, judged_values)) return to_grid(*kept);
    const coating::OpticalProblem optical =
        coating::optical_problem(recipe_, wavelengths_nm_[w], scattering_tolerance_);
    const brdf::MuellerGrid grid = between_nodes(solve_body(solver_, optical.problem, options, tolerance_));
    checkpoint_.add(key, to_values(grid));
    return grid;
}

int finer_streams(int streams) {
    return (3 * streams + 1) / 2;
}
int half_streams(int streams) {
    return std::max(3, (streams + 1) / 2);
}

double error_bound(double difference_from_half, double difference_from_finer) {
    const double q = difference_from_half > 0.0 ? std::min(0.5, difference_from_finer / difference_from_half) : 0.5;
    return 2.0 * (1.0 + 4.0 * q) * difference_from_finer;
}

namespace {

// The error bound of `streams`, in units of what is allowed, at the worst wavelength.
double excess(References& references, const std::vector<std::size_t>& wavelengths, int streams, int finer,
              double tolerance, const JobControl& control) {
    for (const int needed : {half_streams(streams), streams, finer}) references.prepare(wavelengths, needed, control);
    double worst = 0.0;
    for (const std::size_t w : wavelengths) {
        const brdf::MuellerGrid &grid = references.at(w, streams), &fine = references.at(w, finer);
        const double bound = error_bound(largest_difference(references.at(w, half_streams(streams)), grid),
                                         largest_difference(grid, fine));
        if (bound > 0.0) worst = std::max(worst, bound / (tolerance * intensity_scale(fine)));
    }
    return worst;
}

}  // namespace

int choose_streams(References& references, const std::vector<std::size_t>& wavelengths, double tolerance,
                   const JobControl& control) {
    // Climb in steps of one half until the next step changes nothing that matters.
    int streams = fewest_streams, before = 0;
    double now = 0.0, last = 0.0;
    for (;; before = streams, last = now, streams = std::min(finer_streams(streams), most_streams)) {
        control.report({"choosing streams", streams, 0, ""});
        now = excess(references, wavelengths, streams, finer_streams(streams), tolerance, control);
        if (now <= 1.0 || streams == most_streams) break;
    }
    if (before == 0 || now > 1.0) return streams;

    // Fewer may do: errors fall geometrically between the steps. Aim at 0.7 of what is allowed.
    const double part = now > 0.0 ? std::log(last / 0.7) / std::log(last / now) : 0.0;
    const int fewer = before + std::max(1, static_cast<int>(std::ceil((streams - before) * part)));
    if (fewer >= streams) return streams;
    return excess(references, wavelengths, fewer, finer_streams(streams), tolerance, control) <= 1.0 ? fewer : streams;
}

}  // namespace patina::jobs
