#pragma once
// Published scalar (intensity only) radiances.

#include <vector>

namespace patina::scalar_slabs {

// Beams on single layers over a black base, azimuth 0, as collected in DISORT's test problems (Stamnes et al. 1988,
// Appl. Opt. 27, 2502): 1 van de Hulst (1980) table 12, 2 Sweigart (1970) ApJS 22, 1, table 1. The digits are DISORT's
// with 8 nodes a hemisphere.
enum class Phase { isotropic, rayleigh, henyey_greenstein_075, haze_l };
struct Case {
    int test, number;
    Phase phase;
    double single_scattering_albedo, optical_thickness, mu_i;
    double flux;  // through a plane normal to the beam, in units of pi
    std::vector<double> optical_depths;
    std::vector<double> mu;                        // negative downward
    std::vector<std::vector<double>> intensities;  // [depth][mu]
};
inline const std::vector<Case> cases{
    {1,
     1,
     Phase::isotropic,
     0.2,
     0.03125,
     0.1,
     10,
     {0, 0.03125},
     {-1, -0.5, -0.1, 0.1, 0.5, 1},
     {{0.0, 0.0, 0.0, 1.17771E-01, 2.64170E-02, 1.34041E-02}, {1.33826E-02, 2.63324E-02, 1.15898E-01, 0.0, 0.0, 0.0}}},
    {1,
     2,
     Phase::isotropic,
     1,
     0.03125,
     0.1,
     10,
     {0, 0.03125},
     {-1, -0.5, -0.1, 0.1, 0.5, 1},
     {{0.0, 0.0, 0.0, 6.22884E-01, 1.39763E-01, 7.09192E-02}, {7.08109E-02, 1.39337E-01, 6.13458E-01, 0.0, 0.0, 0.0}}},
    {1,
     4,
     Phase::isotropic,
     0.2,
     32,
     0.1,
     10,
     {0, 32},
     {-1, -0.5, -0.1, 0.1, 0.5, 1},
     {{0.0, 0.0, 0.0, 2.62972E-01, 9.06967E-02, 5.02853E-02}, {1.22980E-15, 1.30698E-17, 6.88840E-18, 0.0, 0.0, 0.0}}},
    {1,
     5,
     Phase::isotropic,
     1,
     32,
     0.1,
     10,
     {0, 32},
     {-1, -0.5, -0.1, 0.1, 0.5, 1},
     {{0.0, 0.0, 0.0, 1.93321E+00, 1.02732E+00, 7.97199E-01}, {2.71316E-02, 1.87805E-02, 1.16385E-02, 0.0, 0.0, 0.0}}},
    {2,
     1,
     Phase::rayleigh,
     0.5,
     0.2,
     0.080442,
     1,
     {0, 0.2},
     {-0.981986, -0.538263, -0.018014, 0.018014, 0.538263, 0.981986},
     {{0.0, 0.0, 0.0, 1.61796E-01, 2.11501E-02, 7.86713E-03}, {7.71897E-03, 2.00778E-02, 2.57685E-02, 0.0, 0.0, 0.0}}},
    {2,
     2,
     Phase::rayleigh,
     1,
     0.2,
     0.080442,
     1,
     {0, 0.2},
     {-0.981986, -0.538263, -0.018014, 0.018014, 0.538263, 0.981986},
     {{0.0, 0.0, 0.0, 3.47678E-01, 4.87120E-02, 1.89387E-02}, {1.86027E-02, 4.64061E-02, 6.77603E-02, 0.0, 0.0, 0.0}}},
    {2,
     3,
     Phase::rayleigh,
     0.5,
     5,
     0.080442,
     1,
     {0, 5},
     {-0.981986, -0.538263, -0.018014, 0.018014, 0.538263, 0.981986},
     {{0.0, 0.0, 0.0, 1.62566E-01, 2.45786E-02, 1.01498E-02}, {1.70004E-04, 3.97168E-05, 1.32472E-05, 0.0, 0.0, 0.0}}},
    {2,
     4,
     Phase::rayleigh,
     1,
     5,
     0.080442,
     1,
     {0, 5},
     {-0.981986, -0.538263, -0.018014, 0.018014, 0.538263, 0.981986},
     {{0.0, 0.0, 0.0, 3.64010E-01, 8.26993E-02, 4.92370E-02}, {1.05950E-02, 7.69337E-03, 3.79276E-03, 0.0, 0.0, 0.0}}},
};

// Diffuse fluxes of the same collection for strongly forward scattering, beam of flux pi at normal incidence: 3 van de
// Hulst (1980) table 37, 4 Garcia & Siewert (1985) Transp. Theory Stat. Phys. 14, 437, tables 12 and 13. (DISORT's
// radiances of these problems carry the error of its delta-M truncation, up to 1 %, its fluxes hardly do.)
struct Flux {
    int test, number;
    Phase phase;
    double single_scattering_albedo, optical_thickness;
    std::vector<double> optical_depths, down, up;
};
inline const std::vector<Flux> fluxes{
    {3, 1, Phase::henyey_greenstein_075, 1, 1, {0, 1}, {0.0, 1.73849}, {2.47374E-01, 0.0}},
    {3, 2, Phase::henyey_greenstein_075, 1, 8, {0, 8}, {0.0, 1.54958}, {1.59096E+00, 0.0}},
    {4, 1, Phase::haze_l, 1, 1, {0, 0.5, 1}, {0.0, 1.17401, 1.81264}, {1.73223E-01, 1.11113E-01, 0.0}},
    {4, 2, Phase::haze_l, 0.9, 1, {0, 0.5, 1}, {0.0, 1.01517, 1.51554}, {1.23665E-01, 7.88690E-02, 0.0}},
};

// Haze L of Garcia & Siewert (1985), degrees 0 to 82.
inline const std::vector<double> haze_l{
    1.0,     2.41260, 3.23047, 3.37296, 3.23150, 2.89350, 2.49594, 2.11361, 1.74812, 1.44692, 1.17714, 0.96643,
    0.78237, 0.64114, 0.51966, 0.42563, 0.34688, 0.28351, 0.23317, 0.18963, 0.15788, 0.12739, 0.10762, 0.08597,
    0.07381, 0.05828, 0.05089, 0.03971, 0.03524, 0.02720, 0.02451, 0.01874, 0.01711, 0.01298, 0.01198, 0.00904,
    0.00841, 0.00634, 0.00592, 0.00446, 0.00418, 0.00316, 0.00296, 0.00225, 0.00210, 0.00160, 0.00150, 0.00115,
    0.00107, 0.00082, 0.00077, 0.00059, 0.00055, 0.00043, 0.00040, 0.00031, 0.00029, 0.00023, 0.00021, 0.00017,
    0.00015, 0.00012, 0.00011, 0.00009, 0.00008, 0.00006, 0.00006, 0.00005, 0.00004, 0.00004, 0.00003, 0.00003,
    0.00002, 0.00002, 0.00002, 0.00001, 0.00001, 0.00001, 0.00001, 0.00001, 0.00001, 0.00001, 0.00001};

// van de Hulst (1980), table 12: isotropic scattering, albedo 0.8, optical thickness 2; reflection (upward) and diffuse
// transmission functions, radiance = value mu_i for a flux of pi.
struct Isotropic {
    bool reflection;
    double mu_o, mu_i, value;
};
inline const std::vector<Isotropic> isotropic_slab{
    {true, 0.5, 1.0, 0.28616},  {true, 0.5, 0.9, 0.30277},  {true, 0.5, 0.7, 0.34188},  {true, 0.5, 0.5, 0.39102},
    {true, 0.5, 0.3, 0.45353},  {true, 0.5, 0.1, 0.53214},  {false, 0.5, 1.0, 0.14864}, {false, 0.5, 0.9, 0.14731},
    {false, 0.5, 0.7, 0.13963}, {false, 0.5, 0.3, 0.09425}, {false, 0.5, 0.1, 0.06601},
};

// Siewert (2000), problem IIA, solved for intensity alone (numpy discrete ordinates, cdisort 2.1.3 and VLIDORT 2.8.3
// with one Stokes component agree to nine digits): upward radiance at the top.
struct Radiance {
    double mu_o, phi_deg, intensity;
};
inline const std::vector<Radiance> problem_iia{
    {0.5, 0, 0.339867121}, {0.5, 90, 0.124481026}, {0.5, 180, 0.068159113},
    {0.1, 0, 0.927086888}, {0.1, 90, 0.164593995}, {0.1, 180, 0.074999692},
};

}  // namespace patina::scalar_slabs
