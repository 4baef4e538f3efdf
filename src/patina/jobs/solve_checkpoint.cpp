#include "patina/jobs/solve_checkpoint.h"

#include "patina/rt/problem_fingerprint.h"

namespace patina::jobs {

std::vector<double> to_values(const SolvedWavelength& solved) {
    const rt::Reflection& reflection = solved.reflection;
    std::vector<double> values{solved.scale, solved.difference_from_half, static_cast<double>(reflection.mu.size()),
                               static_cast<double>(reflection.modes.size())};
    values.insert(values.end(), reflection.mu.begin(), reflection.mu.end());
    values.insert(values.end(), reflection.weights.begin(), reflection.weights.end());
    for (const Eigen::MatrixXd& mode : reflection.modes)
        values.insert(values.end(), mode.data(), mode.data() + mode.size());
    return values;
}

std::optional<SolvedWavelength> to_solved_wavelength(std::span<const double> values) {
    if (values.size() < 4) return std::nullopt;
    SolvedWavelength solved{{}, values[0], values[1]};
    const auto nodes = static_cast<std::size_t>(values[2]), modes = static_cast<std::size_t>(values[3]);
    if (values.size() != 4 + 2 * nodes + modes * 16 * nodes * nodes) return std::nullopt;
    auto at = values.begin() + 4;
    solved.reflection.mu.assign(at, at + nodes);
    at += nodes;
    solved.reflection.weights.assign(at, at + nodes);
    at += nodes;
    for (std::size_t m = 0; m < modes; ++m, at += 16 * nodes * nodes)
        solved.reflection.modes.emplace_back(Eigen::MatrixXd::Map(&*at, 4 * nodes, 4 * nodes));
    return solved;
}

std::string fingerprint_of(const std::vector<rt::Problem>& problems) {
    Fingerprint fingerprint;
    for (const rt::Problem& problem : problems) rt::add_to(fingerprint, problem);
    return fingerprint.hex();
}

}  // namespace patina::jobs
