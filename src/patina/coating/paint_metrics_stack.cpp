#include "patina/coating/paint_metrics_stack.h"

#include <limits>
#include <set>

#include <fmt/format.h>

#include "patina/brdf/interpolation.h"
#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/parallel.h"
#include "patina/rt/problem_fingerprint.h"

namespace patina::coating {

namespace {

constexpr int fewest_streams = 12, most_streams = 128;

bool scatters_in(const RecipeLayer& layer) {
    if (const auto* composition = std::get_if<Composition>(&layer.content)) return !composition->pigments.empty();
    const auto& optical = std::get<OpticalLayer>(layer.content);
    return optical.single_scattering_albedo > 0.0 && optical.optical_thickness > 0.0;
}

double thickness_of(const RecipeLayer& layer) {
    if (const auto* composition = std::get_if<Composition>(&layer.content)) return composition->thickness_um;
    return std::get<OpticalLayer>(layer.content).optical_thickness;
}

RecipeLayer with_unit_thickness(RecipeLayer layer) {
    if (auto* composition = std::get_if<Composition>(&layer.content))
        composition->thickness_um = 1.0;
    else
        std::get<OpticalLayer>(layer.content).optical_thickness = 1.0;
    return layer;
}

// Nodes that integrate every phase function exactly.
int exact_streams(const std::vector<rt::Problem>& problems) {
    int order = 0;
    for (const rt::Problem& problem : problems) order = std::max(order, problem.order());
    return std::min(order / 2 + 2, most_streams);
}

// A decade of the tolerance for every four.
int smooth_streams(double tolerance) {
    return std::clamp(static_cast<int>(std::ceil(-4.0 * std::log10(tolerance))), fewest_streams, most_streams);
}

// The largest difference of two answers in units of the largest value.
double largest_difference(const ReflectanceSpectra& a, const ReflectanceSpectra& b) {
    double difference = 0.0, largest = 0.0;
    for (const auto values :
         {&ReflectanceSpectra::r45_0, &ReflectanceSpectra::d8_excluded, &ReflectanceSpectra::bihemispherical})
        for (std::size_t w = 0; w < (a.*values).size(); ++w) {
            difference = std::max(difference, std::abs((a.*values)[w] - (b.*values)[w]));
            largest = std::max(largest, std::abs((b.*values)[w]));
        }
    return largest > 0.0 ? difference / largest : 0.0;
}

// Reflectance factors from the azimuthal mean of the BRDF, element I <- I.
struct Geometry {
    double r45_0, d8, bihemispherical;
};

Geometry measure(const rt::Reflection& reflection) {
    const int count = static_cast<int>(reflection.mu.size());
    const Eigen::MatrixXd& mode = reflection.modes.front();
    Eigen::MatrixXd f(count, count);
    for (int o = 0; o < count; ++o)
        for (int i = 0; i < count; ++i) f(o, i) = mode(4 * o, 4 * i);
    Eigen::VectorXd flux(count);
    for (int i = 0; i < count; ++i) flux[i] = 2.0 * pi * reflection.mu[i] * reflection.weights[i];

    const brdf::BarycentricInterpolation interpolation(reflection.mu);
    const Eigen::VectorXd normal = interpolation.weights(1.0), at_45 = interpolation.weights(std::sqrt(0.5)),
                          at_8 = interpolation.weights(std::cos(radians(8.0)));
    // Diffuse light of radiance 1/pi shows the reflectance factor pi L = sum of f cos(theta_i) d omega.
    return {pi * normal.dot(f * at_45), at_8.dot(f * flux), flux.dot(f * flux) / pi};
}

}  // namespace

VariableLayer variable_layer(const Recipe& recipe) {
    const auto found = std::find_if(recipe.layers.begin(), recipe.layers.end(), scatters_in);
    const bool scatters = found != recipe.layers.end();
    const RecipeLayer& layer = scatters ? *found : recipe.layers.front();
    return {static_cast<int>(&layer - recipe.layers.data()), scatters,
            std::holds_alternative<OpticalLayer>(layer.content)};
}

const ReflectanceSpectra* StackMemory::answer(std::uint64_t question) const {
    const auto found = answers_.find(question);
    if (found == answers_.end()) return nullptr;
    ++found_;
    return &found->second;
}

void StackMemory::keep(std::uint64_t question, const ReflectanceSpectra& answer) {
    constexpr std::size_t most_answers = 100'000;  // of a kilobyte or two
    if (answers_.size() >= most_answers) answers_.clear();
    answers_[question] = answer;
}

const StackMemory::SetUp* StackMemory::set_up(const std::string& composition) const {
    return !composition.empty() && set_up_.composition == composition ? &set_up_ : nullptr;
}

VariableStack::VariableStack(const Recipe& recipe, const StackOptions& options, const JobControl& control)
    : recipe_(recipe), options_(options), solver_(rt::solver_named(options.solver)) {
    PATINA_EXPECT(!options.wavelengths_nm.empty());
    if (!options_.memory) options_.memory = std::make_shared<StackMemory>();
    layer_ = variable_layer(recipe);
    thickness_ = thickness_of(recipe.layers[layer_.index]);

    const StackMemory::SetUp* known = options_.memory->set_up(options_.composition);
    if (!known) known = &options_.memory->keep(set_up(control));
    problems_ = known->problems;
    notes_ = known->notes;
    for (const rt::Problem& problem : problems_) {
        if (const std::string reason = solver_.unsupported(problem); !reason.empty())
            throw Error(ErrorKind::input,
                        fmt::format("solver \"{}\" cannot do this recipe ({})", solver_.name(), reason));
        optical_per_length_.push_back(problem.layers[layer_.index].optical_thickness);
    }
    streams_ = options.streams > 0 ? options.streams : chosen_streams(control);
}

// Reflectances of coarse particles need fewer nodes than their phase functions, since forward peaks are truncated
// (rt/truncation.h): as many as make no difference any more at the ends and the middle of the spectrum, to an opaque
// layer and to one that lets half of the light through. Neither depends on the recipe's thickness or base.
int VariableStack::chosen_streams(const JobControl& control) const {
    const int exact = exact_streams(problems_);
    int streams = smooth_streams(options_.tolerance);
    if (solver_.is_statistical()) return std::max(exact, streams);

    const int last = static_cast<int>(problems_.size()) - 1;
    std::vector<rt::Problem> probes;
    for (const int w : std::set<int>{0, last / 2, last})
        for (const double transport_thickness : {4.0, std::numeric_limits<double>::infinity()}) {
            const double scattering = transport_scattering(w);
            const double thickness = scattering > 0.0 ? transport_thickness / scattering : 1.0;
            probes.push_back(problem(w, {{thickness}, 0.0}));
        }
    ReflectanceSpectra coarse;
    for (; streams < exact; streams = (3 * streams + 1) / 2) {
        control.report({"choosing streams", streams, 0, ""});
        if (coarse.r45_0.empty()) coarse = solve(probes, streams, control);
        ReflectanceSpectra finer = solve(probes, std::min(exact, (3 * streams + 1) / 2), control);
        // Half of the tolerance is left for what still finer ones would show.
        if (largest_difference(coarse, finer) < 0.5 * options_.tolerance) return streams;
        coarse = std::move(finer);
    }
    return std::max(exact, smooth_streams(options_.tolerance));
}

// Every wavelength, with unit thickness of the variable layer.
StackMemory::SetUp VariableStack::set_up(const JobControl& control) const {
    Recipe unit = recipe_;
    unit.layers[layer_.index] = with_unit_thickness(recipe_.layers[layer_.index]);
    const std::vector<double>& wavelengths_nm = options_.wavelengths_nm;
    const std::ptrdiff_t count = std::ssize(wavelengths_nm);
    const double scattering_tolerance = std::clamp(0.1 * options_.tolerance, 1e-7, 1e-3);
    std::vector<OpticalProblem> optical(count);
    std::atomic<int> done = 0;
    parallel_for(0, count, [&](std::ptrdiff_t w) {
        if (control.stop_requested()) return;
        optical[w] = optical_problem(unit, wavelengths_nm[w], scattering_tolerance);
        control.report({"scattering", ++done, count, fmt::format("{:g} nm", wavelengths_nm[w])});
    });
    if (control.stop_requested()) throw Error(ErrorKind::interrupted, "stopped before anything was solved");

    StackMemory::SetUp result{options_.composition, {}, {}};
    std::set<std::string> notes;
    for (OpticalProblem& at_w : optical) {
        notes.insert(at_w.notes.begin(), at_w.notes.end());
        result.problems.push_back(std::move(at_w.problem));
    }
    if (result.problems.front().has_rough_top())
        notes.insert("rough top: d:8 excluded is without the reflection of a smooth surface; 45:0 has a part of it");
    result.notes.assign(notes.begin(), notes.end());
    return result;
}

bool VariableStack::streams_are_exact() const {
    return streams_ >= exact_streams(problems_);
}

double VariableStack::transport_scattering(int w) const {
    const rt::Layer& layer = problems_[w].layers[layer_.index];
    return optical_per_length_[w] * layer.single_scattering_albedo * (1.0 - layer.expansion.asymmetry());
}

double VariableStack::absorption(int w) const {
    return optical_per_length_[w] * (1.0 - problems_[w].layers[layer_.index].single_scattering_albedo);
}

rt::Problem VariableStack::problem(int w, const Question& question) const {
    const double thickness = question.thickness.size() == 1 ? question.thickness[0] : question.thickness[w];
    rt::Problem result = problems_[w];
    rt::Layer& layer = result.layers[layer_.index];
    // A layer without extinction stays without, however thick.
    layer.optical_thickness = optical_per_length_[w] > 0.0 ? optical_per_length_[w] * thickness : 0.0;
    if (question.lambertian_base) result.base = rt::LambertianBase{*question.lambertian_base};
    if (question.lambertian_base == 0.0) result.base = rt::BlackBase{};

    // What follows the recipe's layers is the medium of a table that is its base.
    if (std::isinf(layer.optical_thickness)) {
        result.layers.resize(layer_.index + 1);
    } else {
        if (question.lambertian_base) result.layers.resize(recipe_.layers.size());
        if (question.below == Below::nothing)
            result.layers.erase(result.layers.begin() + layer_.index + 1,
                                result.layers.begin() + recipe_.layers.size());
    }
    if (question.above == Above::nothing) {
        result.layers.erase(result.layers.begin(), result.layers.begin() + layer_.index);
        if (!recipe_.has_interface) result.refractive_index_above = result.layers.front().refractive_index;
    }
    return result;
}

ReflectanceSpectra VariableStack::solve(const Question& question, const JobControl& control) const {
    const int count = static_cast<int>(problems_.size());
    PATINA_EXPECT(question.thickness.size() == 1 || std::ssize(question.thickness) == count);
    std::vector<rt::Problem> problems;
    Fingerprint fingerprint;
    fingerprint.add(solver_.name());
    fingerprint.add(static_cast<double>(streams_));
    for (int w = 0; w < count; ++w) {
        problems.push_back(problem(w, question));
        rt::add_to(fingerprint, problems.back());
    }
    if (const ReflectanceSpectra* known = options_.memory->answer(fingerprint.value())) return *known;
    const ReflectanceSpectra result = solve(problems, streams_, control);
    if (converged_) options_.memory->keep(fingerprint.value(), result);
    return result;
}

ReflectanceSpectra VariableStack::solve(const std::vector<rt::Problem>& problems, int streams,
                                        const JobControl& control) const {
    const std::ptrdiff_t count = std::ssize(problems);
    rt::SolveOptions options;
    options.streams = streams;
    options.most_fourier_orders = 1;
    options.cancel = control.cancel;
    ReflectanceSpectra result;
    for (auto* values : {&result.r45_0, &result.d8_excluded, &result.d8_included, &result.bihemispherical})
        values->assign(count, 0.0);
    const double mu_8 = std::cos(radians(8.0));
    parallel_for(0, count, [&](std::ptrdiff_t w) {
        if (control.stop_requested()) return;
        const rt::Reflection reflection = solver_.reflection(problems[w], options);
        if (!reflection.diagnostics.converged) converged_ = false;
        const Geometry geometry = measure(reflection);
        result.r45_0[w] = geometry.r45_0;
        // A rough surface scatters its reflection: what it sends in all directions is taken for that of a smooth one.
        rt::Problem smooth = problems[w];
        smooth.top_roughness.reset();
        const double scattered = problems[w].has_rough_top() ? rt::specular_surface(smooth, mu_8)(0, 0) : 0.0;
        result.d8_excluded[w] = geometry.d8 - scattered;
        result.d8_included[w] = geometry.d8 + rt::specular_surface(problems[w], mu_8)(0, 0) +
                                rt::specular_coherent(problems[w], mu_8)(0, 0);
        result.bihemispherical[w] = geometry.bihemispherical;
    });
    if (control.stop_requested()) throw Error(ErrorKind::interrupted, "stopped");
    return result;
}

}  // namespace patina::coating
