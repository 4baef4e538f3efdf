#include "patina/jobs/wavelength_choice.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/jobs/stream_choice.h"
#include "patina/jobs/table_accuracy.h"

namespace patina::jobs {

namespace {

constexpr double widest_nm = 25.0, narrowest_nm = 1.0;

// The BRDF between nodes at the wavelengths asked for so far.
class Samples {
  public:
    Samples(const coating::Recipe& recipe, double tolerance, const JobControl& control)
        : recipe_(recipe), tolerance_(tolerance), control_(control) {}

    void prepare(const std::vector<double>& wavelengths_nm) {
        std::vector<brdf::MuellerGrid> grids(wavelengths_nm.size());
        parallel_for(0, std::ssize(wavelengths_nm), [&](std::ptrdiff_t k) {
            if (!control_.stop_requested()) grids[k] = solve(wavelengths_nm[k]);
        });
        if (control_.stop_requested()) throw Error(ErrorKind::interrupted, "stopped before anything was solved");
        for (std::size_t k = 0; k < grids.size(); ++k) grids_[wavelengths_nm[k]] = std::move(grids[k]);
        control_.report({"choosing wavelengths", std::ssize(grids_), 0, ""});
    }
    const brdf::MuellerGrid& at(double wavelength_nm) const { return grids_.at(wavelength_nm); }

  private:
    brdf::MuellerGrid solve(double wavelength_nm) const {
        const coating::OpticalProblem optical =
            coating::optical_problem(recipe_, wavelength_nm, std::clamp(0.01 * tolerance_, 1e-7, 1e-4));
        return between_nodes(
            solve_body(rt::solver_named("doubling"), optical.problem,
                       {.streams = fewest_streams, .fourier_tolerance = 0.01 * tolerance_, .cancel = control_.cancel},
                       tolerance_));
    }

    const coating::Recipe& recipe_;
    double tolerance_;
    const JobControl& control_;
    std::map<double, brdf::MuellerGrid> grids_;
};

// The part of the difference in the middle that its halves keep, doubled.
double error_of_halves(const Samples& samples, double low, double middle, double high) {
    const brdf::MuellerGrid &a = samples.at(low), &b = samples.at(middle), &c = samples.at(high);
    double largest = 0.0;
    for (std::size_t k = 0; k < b.values.size(); ++k)
        largest = std::max(largest, (0.5 * (a.values[k] + c.values[k]) - b.values[k]).cwiseAbs().maxCoeff());
    return 0.5 * largest / intensity_scale(b);
}

}  // namespace

WavelengthChoice choose_wavelengths(const coating::Recipe& recipe, double from_nm, double to_nm, double tolerance,
                                    const JobControl& control) {
    PATINA_EXPECT(from_nm > 0.0 && from_nm < to_nm && tolerance > 0.0);
    const int first = static_cast<int>(std::ceil((to_nm - from_nm) / widest_nm - 1e-9));
    std::vector<double> found;
    for (int k = 0; k <= first; ++k) found.push_back(k == first ? to_nm : from_nm + k * (to_nm - from_nm) / first);
    Samples samples(recipe, tolerance, control);
    samples.prepare(found);

    // Halve all intervals that are still open at once.
    WavelengthChoice choice{found, 0.0, true};
    std::vector<std::pair<double, double>> open;
    for (std::size_t k = 1; k < found.size(); ++k) open.push_back({found[k - 1], found[k]});
    while (!open.empty()) {
        std::vector<double> middles;
        for (const auto& [low, high] : open) middles.push_back(0.5 * (low + high));
        samples.prepare(middles);
        std::vector<std::pair<double, double>> still_open;
        for (std::size_t k = 0; k < open.size(); ++k) {
            const auto [low, high] = open[k];
            const double error = error_of_halves(samples, low, middles[k], high);
            // A middle that its neighbours tell well enough, with half as much again for what lies beside it, is not
            // needed in the table.
            const double without = 3.0 * error;
            const bool needed = without > tolerance;
            if (needed) choice.wavelengths_nm.push_back(middles[k]);
            if (error > tolerance && high - low >= 2.0 * narrowest_nm) {
                still_open.push_back({low, middles[k]});
                still_open.push_back({middles[k], high});
                continue;
            }
            choice.converged = choice.converged && error <= tolerance;
            choice.interpolation_error = std::max(choice.interpolation_error, needed ? error : without);
        }
        open = std::move(still_open);
    }
    std::sort(choice.wavelengths_nm.begin(), choice.wavelengths_nm.end());
    return choice;
}

}  // namespace patina::jobs
