// A composition recipe against an independent Monte Carlo: pins the sign that no published table tests, the Mie b2
// against the retardance of total internal reflection. With b2 flipped, V under the interface is wrong by more than
// itself.

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/jobs/field.h"
#include "patina/jobs/validation/paint_slab_data.h"

namespace patina::test {
namespace {

void expect_slab(bool interface, std::span<const paint_slab::Row> rows, const std::string& solver) {
    jobs::FieldJob job;
    job.theta_i_deg = 45.0;
    job.theta_o_deg = {0, 20, 40, 60, 75};
    job.phi_deg = {0, 45, 90, 135, 180};
    job.optical_depths = {0.0};
    job.wavelength_nm = 550.0;
    job.streams = 20;
    job.solver = solver;
    const jobs::FieldResult result =
        jobs::field(coating::parse_recipe(paint_slab::recipe(interface), "slab.toml", "."), job);

    int compared = 0;
    for (const paint_slab::Row& row : rows)
        for (const jobs::FieldValue& value : result.radiance) {
            if (!value.upward || value.theta_deg != row.theta_o_deg || value.phi_deg != row.phi_deg) continue;
            const optics::Stokes brdf = value.stokes / (pi * std::cos(radians(45.0)));
            // 3 sigma of the reference, plus the 1e-5 of I that its 512 size classes leave (narrow resonances of the
            // pigment).
            for (int i = 0; i < 4; ++i)
                EXPECT_NEAR(brdf[i], row.stokes[i], 3.0 * row.sigma[i] + 1e-5 * row.stokes[0])
                    << solver << " theta " << row.theta_o_deg << " phi " << row.phi_deg << " component " << i;
            ++compared;
        }
    EXPECT_EQ(compared, 25);
}

TEST(PaintSlab, IndexMatchedFollowsTheMonteCarlo) {
    expect_slab(false, paint_slab::case_a, "doubling");
}
TEST(PaintSlab, UnderAnInterfaceFollowsTheMonteCarlo) {
    expect_slab(true, paint_slab::case_b, "doubling");
}

}  // namespace
}  // namespace patina::test
