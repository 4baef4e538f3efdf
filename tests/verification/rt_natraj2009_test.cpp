// Natraj, Li & Yung (2009): conservative Rayleigh layers over Lambertian bases.

#include <map>
#include <tuple>

#include "rt_problems.h"

#include "patina/core/constants.h"
#include "patina/jobs/validation/natraj2009_data.h"

namespace patina::rt {
namespace {

TEST(Natraj2009, ReproducesReflectedAndTransmittedStokesParameters) {
    const std::vector<double> mu_o{0.02, 0.2, 0.52, 0.84, 1.0}, phi_deg{0, 60, 120, 180};
    std::map<std::tuple<double, double, double>, Field> fields;
    double worst = 0.0;
    for (const auto& row : natraj2009::radiances) {
        const auto [found, is_new] = fields.try_emplace({row.optical_thickness, row.reflectance, row.mu_i});
        if (is_new) {
            const Problem problem{1.0,
                                  {{row.optical_thickness, 1.0, testing_problems::rayleigh(), 1.0}},
                                  LambertianBase{row.reflectance}};
            FieldRequest request{row.mu_i, {1, 0, 0, 0}, {0.0, row.optical_thickness}, mu_o, {}};
            for (double degrees : phi_deg) request.phi.push_back(radians(degrees));
            found->second = solver_named("doubling").field(problem, request, {.streams = 24});
        }
        std::size_t o = 0, p = 0;
        while (mu_o[o] != row.mu_o) ++o;
        while (phi_deg[p] != row.phi_deg) ++p;
        const optics::Stokes s = row.upward ? found->second.upward[0][o][p] : found->second.downward[1][o][p];
        const optics::Stokes expected(row.i, -row.q, -row.u, 0.0);
        worst = std::max(worst, (s - expected).cwiseAbs().maxCoeff());
        EXPECT_LT((s - expected).cwiseAbs().maxCoeff(), 1e-6)
            << (row.upward ? "up" : "down") << " tau " << row.optical_thickness << " base " << row.reflectance
            << " mu_i " << row.mu_i << " mu_o " << row.mu_o << " phi " << row.phi_deg;
    }
    EXPECT_EQ(fields.size(), 12u);
    RecordProperty("largest_difference", std::to_string(worst));
}

}  // namespace
}  // namespace patina::rt
