#include "patina/rt/solvers/monte_carlo.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/math/quadrature.h"
#include "patina/rt/monte_carlo/walk.h"

namespace patina::rt {

namespace {

using namespace monte_carlo;
using optics::Stokes;

// Sums of a batch, divided by its number of packets.
using Tally = Eigen::ArrayXd;

struct BatchMeans {
    Tally mean, standard_error;
};

// Walks `samples` packets in `batches` independent batches; make_sink(tally, random) builds what receives a batch's
// local estimates; `done` is told after each batch how many are. Packets of a batch are stratified in the depth of
// their first collision.
template <int columns, class MakeSink, class Done>
BatchMeans walk_batches(const Stack& stack, const std::vector<Cone>& cones, const FirstCollision<columns>& first,
                        std::int64_t samples, std::uint64_t seed, int batches, Eigen::Index values,
                        const MakeSink& make_sink, const CancelToken* cancel, const Done& done) {
    std::vector<Tally> sums(static_cast<std::size_t>(batches));
    std::atomic<int> finished = 0;
    const std::int64_t packets = (samples + batches - 1) / batches;
    parallel_for(0, batches, [&](std::ptrdiff_t batch) {
        Tally tally = Tally::Zero(values);
        if (first.power() > 0.0) {
            RandomStream random(seed, static_cast<std::uint64_t>(batch));
            auto sink = make_sink(tally, random);
            Walk<columns, decltype(sink)> walk(stack, cones, random, sink);
            for (std::int64_t i = 0; i < packets; ++i) {
                stop_if_requested(cancel);
                walk.run(first.draw((static_cast<double>(i) + random.uniform()) / static_cast<double>(packets)),
                         first.power());
            }
        }
        sums[static_cast<std::size_t>(batch)] = tally / static_cast<double>(packets);
        done(static_cast<double>(++finished) / batches);
    });

    // Combine in the order of batches, whatever thread did them.
    BatchMeans result{Tally::Zero(values), Tally::Zero(values)};
    for (const Tally& batch : sums) result.mean += batch / batches;
    for (const Tally& batch : sums) result.standard_error += (batch - result.mean).square();
    result.standard_error = (result.standard_error / (static_cast<double>(batches) * (batches - 1))).sqrt();
    return result;
}

// Adds Stokes vectors, the last column, at fixed azimuths; the tally is [cone][azimuth][4].
template <int columns>
class AzimuthSink {
  public:
    AzimuthSink(Tally& tally, const std::vector<Eigen::Vector2d>& azimuths) : tally_(tally), azimuths_(azimuths) {}

    template <class Radiance>
    void each(std::size_t cone, const Gain& gain, const Radiance& radiance) {
        double* place = tally_.data() + 4 * cone * azimuths_.size();
        for (const Eigen::Vector2d& azimuth : azimuths_) {
            StokesColumns<1> stokes = radiance(azimuth.x(), azimuth.y()).template rightCols<1>();
            apply(gain, stokes);
            Eigen::Map<Eigen::Vector4d>{place} += stokes;
            place += 4;
        }
    }

  private:
    Tally& tally_;
    const std::vector<Eigen::Vector2d>& azimuths_;
};

// Adds Mueller matrices at a random azimuth, projected on cos(m phi) and sin(m phi) with the signs of Reflection; the
// tally is [cone][m][16], matrices by columns.
class FourierSink {
  public:
    FourierSink(Tally& tally, RandomStream& random, int orders) : tally_(tally), random_(random), orders_(orders) {}

    template <class Radiance>
    void each(std::size_t cone, const Gain& gain, const Radiance& radiance) {
        const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * random_.uniform());
        StokesColumns<4> mueller = radiance(turn.real(), turn.imag());
        apply(gain, mueller);
        std::complex<double> wave = 1.0;
        double* place = tally_.data() + 16 * static_cast<std::ptrdiff_t>(cone) * orders_;
        for (int m = 0; m < orders_; ++m, wave *= turn, place += 16) {
            Eigen::Map<Eigen::Matrix4d> mode(place);
            mode.topLeftCorner<2, 2>() += wave.real() * mueller.topLeftCorner<2, 2>();
            mode.bottomRightCorner<2, 2>() += wave.real() * mueller.bottomRightCorner<2, 2>();
            mode.topRightCorner<2, 2>() -= wave.imag() * mueller.topRightCorner<2, 2>();
            mode.bottomLeftCorner<2, 2>() += wave.imag() * mueller.bottomLeftCorner<2, 2>();
        }
    }

  private:
    Tally& tally_;
    RandomStream& random_;
    int orders_;
};

void require(bool condition, const std::string& problem, const std::string& why, const std::string& suggestion) {
    if (!condition) throw input_error({}, problem, why, suggestion);
}

// The layer of an optical depth; a depth between two layers belongs to the upper one.
SpecularStack::Level locate(const Problem& problem, double depth, bool up) {
    if (depth == 0.0) return {up ? -1 : 0, 0.0, up};
    double above = 0.0;
    int last = -1;
    for (const Layer& layer : problem.layers) {
        ++last;
        // Rounding must not put a level below its own layer, where nothing could be seen from the base.
        if (depth <= above + layer.optical_thickness)
            return {last, std::min(depth - above, layer.optical_thickness), up};
        above += layer.optical_thickness;
    }
    // Sums of layers may fall short by rounding.
    require(depth <= above * (1.0 + 1e-12), fmt::format("optical depth {} lies below the stack", depth),
            fmt::format("its total optical thickness is {}", above), fmt::format("use at most {}", above));
    return {last, problem.layers.back().optical_thickness, up};
}

void check(const FieldRequest& request, const SolveOptions& options) {
    require(options.samples >= 2, fmt::format("{} samples are too few", options.samples),
            "errors come from at least two batches", "use 1e5 or more");
    require(request.mu_i > 0.0 && request.mu_i <= 1.0, fmt::format("mu_i = {} is no cosine of incidence", request.mu_i),
            "", "use 0 < mu_i <= 1");
    for (double mu : request.mu_o)
        require(mu > 0.0 && mu <= 1.0, fmt::format("mu_o = {} cannot be estimated by the solver montecarlo", mu),
                "a horizontal direction sees no finite part of a layer", "use 0 < mu_o <= 1, for instance 0.001");
    for (double depth : request.optical_depths)
        require(depth >= 0.0 && std::isfinite(depth),
                fmt::format("optical depth {} is not a level of the stack", depth), "", "use a finite depth >= 0");
}

class MonteCarloSolver final : public Solver {
  public:
    std::string_view name() const override { return "montecarlo"; }
    std::string_view summary() const override {
        return "polarized Monte Carlo with electric-field frames; independent of the other solvers, with error bars";
    }
    bool is_statistical() const override { return true; }
    std::string unsupported(const Problem& problem) const override {
        const auto* metal = std::get_if<MetalBase>(&problem.base);
        if (std::holds_alternative<SurfaceBase>(problem.base)) return "it cannot draw directions from a table";
        return metal && metal->roughness ? "it has smooth mirrors only" : "";
    }
    Reflection reflection(const Problem& problem, const SolveOptions& options) const override;
    Field field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const override;
};

Field MonteCarloSolver::field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const {
    validate(problem);
    check(request, options);
    const double deepest = request.optical_depths.empty() ? 0.0 : std::ranges::max(request.optical_depths);
    const Stack stack = make_stack(problem, options.scalar, deepest);

    // One cone for each level, hemisphere and polar angle.
    std::vector<Cone> cones;
    for (double depth : request.optical_depths)
        for (bool up : {true, false})
            for (double mu : request.mu_o) cones.emplace_back(stack, locate(problem, depth, up), mu);
    std::vector<Eigen::Vector2d> azimuths;
    for (double phi : request.phi) azimuths.emplace_back(std::cos(phi), std::sin(phi));

    // A Stokes vector that no light has (a column of a Mueller matrix) rides along with unpolarized light.
    const auto walk = [&]<int columns>(const StokesColumns<columns>& incident) {
        const FirstCollision<columns> first(stack, request.mu_i, incident);
        const int batches = static_cast<int>(std::min<std::int64_t>(128, options.samples));
        const auto values = static_cast<Eigen::Index>(4 * cones.size() * azimuths.size());
        return walk_batches(
            stack, cones, first, options.samples, options.seed, batches, values,
            [&](Tally& tally, RandomStream&) { return AzimuthSink<columns>(tally, azimuths); }, options.cancel,
            [&](double part) {
                if (options.progress) options.progress(part);
            });
    };
    const bool physical =
        request.incident[0] > 0.0 && request.incident.tail<3>().norm() <= request.incident[0] * (1.0 + 1e-12);
    StokesColumns<2> with_unpolarized;
    with_unpolarized << Stokes(1, 0, 0, 0), request.incident;
    BatchMeans result = physical ? walk(StokesColumns<1>(request.incident)) : walk(with_unpolarized);

    // A beam of flux pi through a plane normal to itself.
    result.mean *= std::numbers::pi * request.mu_i;
    result.standard_error *= std::numbers::pi * request.mu_i;

    // Copy out in the order in which cones were made.
    Field field;
    const auto unpack = [&](const Tally& tally, auto& upward, auto& downward) {
        const double* place = tally.data();
        for (std::size_t d = 0; d < request.optical_depths.size(); ++d)
            for (auto* hemisphere : {&upward, &downward}) {
                hemisphere->emplace_back(request.mu_o.size());
                for (auto& row : hemisphere->back())
                    for (std::size_t p = 0; p < azimuths.size(); ++p, place += 4)
                        row.emplace_back(Eigen::Map<const Eigen::Vector4d>(place));
            }
    };
    unpack(result.mean, field.upward, field.downward);
    unpack(result.standard_error, field.upward_error, field.downward_error);
    return field;
}

Reflection MonteCarloSolver::reflection(const Problem& problem, const SolveOptions& options) const {
    validate(problem);
    require(options.samples >= 2 * options.streams, fmt::format("{} samples are too few", options.samples),
            "they are shared among the incidences", fmt::format("use {} or more", 10000 * options.streams));
    const Stack stack = make_stack(problem, options.scalar, 0.0);
    const math::Quadrature rule = math::gauss_legendre(options.streams, 0.0, 1.0);
    const int count = rule.size();
    std::vector<Cone> cones;
    for (double mu : rule.nodes) cones.emplace_back(stack, SpecularStack::Level{-1, 0.0, true}, mu);

    // The lobes of a rough top are about alpha wide. A phase matrix of order L has no modes beyond m = L, nor has any
    // number of scatterings.
    int orders = problem.order() + 1;
    if (stack.rough_top) orders = std::max(orders, static_cast<int>(std::ceil(8.0 / problem.top_roughness->alpha)) + 1);
    Reflection reflection{rule.nodes, rule.weights, {}, {}};
    reflection.modes.assign(static_cast<std::size_t>(orders), Eigen::MatrixXd::Zero(4 * count, 4 * count));

    // One run an incidence carries all four incident Stokes vectors.
    double worst = 0.0;
    const std::int64_t samples = options.samples / count;
    const int batches = static_cast<int>(std::min<std::int64_t>(32, samples));
    for (int i = 0; i < count; ++i) {
        const FirstCollision<4> first(stack, rule.nodes[static_cast<std::size_t>(i)], StokesColumns<4>::Identity());
        const std::uint64_t seed = hash64(options.seed + static_cast<std::uint64_t>(i));
        const BatchMeans result = walk_batches(
            stack, cones, first, samples, seed, batches, 16 * count * orders,
            [&](Tally& tally, RandomStream& random) { return FourierSink(tally, random, orders); }, options.cancel,
            [&](double part) {
                if (options.progress) options.progress((i + part) / count);
            });
        for (int o = 0; o < count; ++o)
            for (int m = 0; m < orders; ++m)
                reflection.modes[static_cast<std::size_t>(m)].block<4, 4>(4 * o, 4 * i) =
                    Eigen::Map<const Eigen::Matrix4d>(result.mean.data() + 16 * (o * orders + m));
        for (int o = 0; o < count; ++o) {
            const Eigen::Index mean_mode = 16 * o * orders;
            if (result.mean[mean_mode] > 0.0)
                worst = std::max(worst, result.standard_error[mean_mode] / result.mean[mean_mode]);
        }
    }
    reflection.diagnostics.streams = count;
    reflection.diagnostics.fourier_orders = orders;
    reflection.diagnostics.notes.push_back(fmt::format(
        "statistical: largest standard error of the azimuthal mean of the BRDF is {:.2g} of its value", worst));
    return reflection;
}

}  // namespace

std::unique_ptr<Solver> make_monte_carlo_solver() {
    return std::make_unique<MonteCarloSolver>();
}

}  // namespace patina::rt
