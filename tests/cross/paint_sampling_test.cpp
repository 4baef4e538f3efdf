// How well directions of light are drawn for a painted surface: against the best table there can be.

#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/jobs/solve.h"
#include "patina/render/paint_table.h"

namespace patina {
namespace {

using render::Vec2;
using render::Vec3;
using render::Wavelengths;

constexpr int fine = 96;  // places a side of the square that stands for the hemisphere

// The body seen against cells of equal cosine-weighted solid angle: pi f there, and the density of our draw relative to
// the cosine-weighted hemisphere.
struct Draw {
    double reflectance = 0.0;    // mean of pi f
    double second_moment = 0.0;  // of the weight pi f / density when drawn
};

double intensity(const render::PaintTable& table, const Wavelengths& w, const Vec3& outgoing, const Vec3& incident) {
    render::ScatteringMatrix f;
    table.evaluate(w, outgoing, incident, true, f);
    return std::max(0.0f, render::mean(f.m[0]));
}

Vec3 direction(double cos2, double azimuth) {
    const double sin = std::sqrt(1 - cos2);
    return Vec3(static_cast<float>(sin * std::cos(azimuth)), static_cast<float>(sin * std::sin(azimuth)),
                static_cast<float>(std::sqrt(cos2)));
}

// `density(incident)` is relative to the cosine-weighted hemisphere.
template <class Density>
Draw draw(const render::PaintTable& table, const Wavelengths& w, const Vec3& outgoing, const Density& density) {
    Draw result;
    for (int row = 0; row < fine; ++row)
        for (int column = 0; column < fine; ++column) {
            const Vec3 incident = direction((row + 0.5) / fine, 2 * pi * (column + 0.5) / fine);
            const double value = pi * intensity(table, w, outgoing, incident);
            result.reflectance += value / (fine * fine);
            result.second_moment += value * value / density(incident) / (fine * fine);
        }
    return result;
}

// Paths that are needed for the same noise of a surface under even light, in units of what an ideal draw needs.
double cost(const Draw& draw) {
    return draw.second_moment / (draw.reflectance * draw.reflectance);
}

// 64 x 64 cells for this very angle of view and these very wavelengths, each as probable as the light it holds.
class BestTable {
  public:
    BestTable(const render::PaintTable& table, const Wavelengths& w, const Vec3& outgoing) : held_(cells * cells, 0.0) {
        constexpr int places = 4 * cells;
        for (int row = 0; row < places; ++row)
            for (int column = 0; column < places; ++column) {
                const Vec3 incident = direction((row + 0.5) / places, 2 * pi * (column + 0.5) / places);
                const double value = intensity(table, w, outgoing, incident) / 16;
                held_[cell_of(incident)] += value;
                total_ += value;
            }
    }
    // Relative to the cosine-weighted hemisphere.
    double operator()(const Vec3& incident) const {
        return std::max(held_[cell_of(incident)] / total_, 1e-9) * cells * cells;
    }

  private:
    static constexpr int cells = 64;
    static int cell_of(const Vec3& incident) {
        const double turns = std::atan2(incident.y(), incident.x()) / (2 * pi);
        const int row = std::min(static_cast<int>(incident.z() * incident.z() * cells), cells - 1);
        return row * cells + std::min(static_cast<int>((turns < 0 ? turns + 1 : turns) * cells), cells - 1);
    }
    std::vector<double> held_;
    double total_ = 0.0;
};

struct Coat {
    const char* name;
    int streams;  // 0: chosen
    const char* recipe;
};
void PrintTo(const Coat& coat, std::ostream* out) {
    *out << coat.name;
}

class PaintSampling : public ::testing::TestWithParam<Coat> {};

TEST_P(PaintSampling, CostsAtMostATenthMoreThanTheBestTable) {
    const coating::Recipe recipe = coating::parse_recipe(GetParam().recipe, "coat.toml", ".");
    const jobs::SolveRequest request{.wavelengths_nm = {550.0}, .streams = GetParam().streams};
    const render::PaintTable table(jobs::solve(recipe, request).table);
    const Wavelengths w = Wavelengths::sample(0.3f);
    double worst = 0.0;
    for (const double theta_deg : {1.0, 21.0, 44.0, 63.5, 78.0, 86.0}) {
        const double c = std::cos(radians(theta_deg));
        const Vec3 outgoing = direction(c * c, 0.7);
        const Draw ours = draw(table, w, outgoing,
                               [&](const Vec3& incident) { return pi * table.pdf(outgoing, incident) / incident.z(); });
        const BestTable best(table, w, outgoing);
        worst = std::max(worst, cost(ours) / std::max(1.0, cost(draw(table, w, outgoing, best))));
    }
    EXPECT_LT(worst, 1.1);  // 1.06 is reached
}

INSTANTIATE_TEST_SUITE_P(Coats, PaintSampling,
                         ::testing::Values(Coat{"white", 12, R"(
[interface]
type = "smooth"
[[layers]]
thickness_um = 40
binder = "acrylic"
[[layers.pigments]]
material = "TiO2-rutile"
volume_fraction = 0.17
size = { distribution = "mono", radius_um = 0.12 }
[base]
type = "lambertian"
reflectance = 0.5
)"},
                                           Coat{"thin_on_metal", 12, R"(
[interface]
type = "smooth"
[[layers]]
thickness_um = 3
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.7, k = 0.02 }
volume_fraction = 0.03
size = { distribution = "mono", radius_um = 0.3 }
[base]
type = "metal"
material = { n = 1.0, k = 6.0 }
)"},
                                           Coat{"rough_top", 12, R"(
[interface]
type = "rough"
alpha = 0.35
[[layers]]
thickness_um = 20
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.4, k = 0.1 }
volume_fraction = 0.1
size = { distribution = "mono", radius_um = 0.2 }
)"},
                                           Coat{"dark_without_interface", 0, R"(
[[layers]]
thickness_um = 10
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 1.8, k = 0.3 }
volume_fraction = 0.05
size = { distribution = "mono", radius_um = 0.4 }
)"}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace patina
