#include "patina/jobs/converged_field.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patina::jobs {

namespace {

constexpr int fewest_streams = 12, usual_streams = 32, most_streams = 72;

int exact_streams(const rt::Problem& problem) {
    return std::clamp(problem.order() / 2 + 8, usual_streams, most_streams);
}

using Radiances = std::vector<std::vector<std::vector<optics::Stokes>>>;

// Puts the views of a part behind those that are there, at each depth.
void append(Radiances& all, const Radiances& part) {
    all.resize(part.size());
    for (std::size_t depth = 0; depth < part.size(); ++depth)
        all[depth].insert(all[depth].end(), part[depth].begin(), part[depth].end());
}

template <class Visit>
void for_each_radiance(const rt::Field& field, const Visit& visit) {
    for (const auto hemisphere : {&rt::Field::upward, &rt::Field::downward})
        for (std::size_t depth = 0; depth < (field.*hemisphere).size(); ++depth)
            for (std::size_t view = 0; view < (field.*hemisphere)[depth].size(); ++view)
                for (std::size_t phi = 0; phi < (field.*hemisphere)[depth][view].size(); ++phi)
                    visit((field.*hemisphere)[depth][view][phi],
                          [=](const rt::Field& other) { return (other.*hemisphere)[depth][view][phi]; });
}

double largest_difference(const rt::Field& a, const rt::Field& b) {
    double largest = 0.0;
    for_each_radiance(a, [&](const optics::Stokes& stokes, const auto& same_of) {
        largest = std::max(largest, (stokes - same_of(b)).cwiseAbs().maxCoeff());
    });
    return largest;
}

double largest_radiance(const rt::Field& field) {
    double largest = 0.0;
    for_each_radiance(field,
                      [&](const optics::Stokes& stokes, const auto&) { largest = std::max(largest, stokes[0]); });
    return largest;
}

}  // namespace

rt::Field field_of_views(const rt::Solver& solver, const rt::Problem& problem, const rt::FieldRequest& request,
                         const rt::SolveOptions& options) {
    const std::size_t at_once = static_cast<std::size_t>(std::max(16, options.streams));
    if (solver.is_statistical() || request.mu_o.size() <= at_once) return solver.field(problem, request, options);

    rt::Field whole;
    for (std::size_t first = 0; first < request.mu_o.size(); first += at_once) {
        const auto begin = request.mu_o.begin() + static_cast<std::ptrdiff_t>(first);
        rt::FieldRequest some = request;
        some.mu_o.assign(begin, std::min(begin + static_cast<std::ptrdiff_t>(at_once), request.mu_o.end()));
        const rt::Field part = solver.field(problem, some, options);
        append(whole.upward, part.upward);
        append(whole.downward, part.downward);
        const bool converged = part.diagnostics.converged && (first == 0 || whole.diagnostics.converged);
        whole.diagnostics = part.diagnostics;
        whole.diagnostics.converged = converged;
    }
    return whole;
}

rt::Field converged_field(const rt::Solver& solver, const rt::Problem& problem, const rt::FieldRequest& request,
                          rt::SolveOptions options) {
    constexpr double beyond_fifth_digit = 5e-6;
    const int most = exact_streams(problem);
    options.streams = most < most_streams || solver.is_statistical() ? most : fewest_streams;
    rt::Field field = field_of_views(solver, problem, request, options);
    double difference_before = 0.0, left = 0.0;
    while (options.streams < most) {
        options.streams = std::min(most, (3 * options.streams + 1) / 2);
        rt::Field finer = field_of_views(solver, problem, request, options);
        const double difference = largest_difference(field, finer);
        field = std::move(finer);
        left = difference * (difference_before > 0.0 ? std::clamp(difference / difference_before, 0.3, 1.0) : 1.0);
        if (difference_before > 0.0 && left <= beyond_fifth_digit * largest_radiance(field)) return field;
        difference_before = difference;
    }
    if (left > 0.0)
        field.diagnostics.notes.push_back(
            fmt::format("{} nodes leave an error of some {:.1g} of the largest radiance (the phase function is too "
                        "sharp for them); --streams takes more",
                        most, left / largest_radiance(field)));
    return field;
}

}  // namespace patina::jobs
