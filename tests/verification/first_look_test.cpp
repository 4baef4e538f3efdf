// Largest degree of polarization and directional-hemispherical reflectance of four pigments against an independent
// prototype made for this project (24 nodes, 150 radii): unpolarized light at 44.2 deg, black base, body part only, 550
// nm, host index 1.495, log-normal by number with sigma_g 1.3. It is printed to three digits and its nodes end at 74
// deg.

#include "patina/brdf/mueller_table.h"
#include "patina/core/constants.h"
#include "patina/optics/scattering/particle_ensemble.h"
#include "patina/rt/solver.h"

namespace patina::test {
namespace {

constexpr double host_index = 1.495;
constexpr double optical_thicknesses[] = {0.1, 0.5, 1, 2, 5, 20, 100};

struct Row {
    const char* pigment;
    std::complex<double> index;
    double median_radius_um;
    bool interface;
    double polarization[7], reflectance[7];
};

const Row rows[] = {
    {"TiO2 0.125 um",
     2.75,
     0.125,
     false,
     {.400, .255, .187, .146, .111, .088, .081},
     {.028, .135, .245, .400, .626, .869, .971}},
    {"TiO2 0.05 um",
     2.75,
     0.05,
     false,
     {.604, .464, .387, .315, .249, .207, .194},
     {.039, .174, .301, .467, .686, .897, .977}},
    {"Fe2O3",
     {3.19, 0.48},
     0.125,
     false,
     {.188, .165, .156, .152, .151, .151, .151},
     {.009, .029, .041, .047, .048, .048, .048}},
    {"Au",
     {0.423, 2.48},
     0.05,
     false,
     {.751, .684, .652, .637, .634, .634, .634},
     {.029, .098, .133, .150, .153, .153, .153}},
    {"AlAs",
     {3.235, 0.003},
     0.1,
     false,
     {.270, .214, .180, .148, .120, .108, .108},
     {.038, .170, .293, .449, .637, .742, .744}},
    {"TiO2 0.125 um",
     2.75,
     0.125,
     true,
     {.463, .380, .322, .266, .221, .200, .195},
     {.005, .032, .075, .163, .364, .696, .888}},
    {"TiO2 0.05 um",
     2.75,
     0.05,
     true,
     {.413, .276, .239, .221, .207, .199, .197},
     {.006, .044, .102, .213, .432, .744, .902}},
    {"Fe2O3",
     {3.19, 0.48},
     0.125,
     true,
     {.374, .350, .337, .326, .323, .323, .323},
     {.001, .005, .008, .011, .011, .012, .012}},
    {"Au",
     {0.423, 2.48},
     0.05,
     true,
     {.284, .263, .252, .244, .242, .242, .242},
     {.006, .028, .043, .053, .055, .055, .055}},
    {"AlAs",
     {3.235, 0.003},
     0.1,
     true,
     {.427, .350, .299, .254, .221, .211, .210},
     {.007, .046, .101, .202, .379, .508, .511}},
};

brdf::MuellerTable solve(const Row& row, double optical_thickness) {
    const optics::ScatteringProperties particles = optics::scatter(
        row.index, host_index, 550.0, {optics::LogNormal{row.median_radius_um, 1.3}}, {.tolerance = 1e-4});
    rt::Problem problem;
    problem.refractive_index_above = row.interface ? 1.0 : host_index;
    problem.layers = {{optical_thickness, std::min(1.0, particles.albedo()), particles.expansion, host_index}};
    const rt::Reflection reflection =
        rt::solver_named("doubling").reflection(problem, {.streams = 24, .fourier_tolerance = 1e-6});
    brdf::MuellerTable table;
    table.wavelengths_nm = {550.0};
    table.mu = reflection.mu;
    table.mu_weights = reflection.weights;
    table.body = {{reflection.modes}};
    return table;
}

double largest_polarization(const brdf::MuellerTable& table, double mu_i) {
    std::vector<double> mu_o, phi;
    for (int theta_deg = 0; theta_deg <= 74; theta_deg += 2) mu_o.push_back(std::cos(radians(theta_deg)));
    for (int phi_deg = 0; phi_deg <= 180; phi_deg += 5) phi.push_back(radians(phi_deg));
    const brdf::MuellerGrid grid = table.evaluate_grid(550.0, mu_o, std::vector<double>{mu_i}, phi);
    double largest = 0.0;
    for (const optics::Mueller& f : grid.values) largest = std::max(largest, optics::degree_of_polarization(f.col(0)));
    return largest;
}

TEST(FirstLook, PigmentsPolarizeAndReflectAsAnIndependentPrototypeSays) {
    const double mu_i = std::cos(radians(44.2));
    for (const Row& row : rows)
        for (int t = 0; t < 7; ++t) {
            const brdf::MuellerTable table = solve(row, optical_thicknesses[t]);
            // The prototype's own claim: three printed digits, angles on its nodes.
            EXPECT_NEAR(largest_polarization(table, mu_i), row.polarization[t], 0.005)
                << row.pigment << (row.interface ? " interface" : "") << " tau " << optical_thicknesses[t];
            EXPECT_NEAR(table.body_albedo(550.0, mu_i), row.reflectance[t], 0.005)
                << row.pigment << (row.interface ? " interface" : "") << " tau " << optical_thicknesses[t];
        }
}

}  // namespace
}  // namespace patina::test
