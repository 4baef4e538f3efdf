#pragma once
// What every solver of the vector radiative transfer equation offers, and the registry of solvers.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "patina/core/progress.h"
#include "patina/optics/stokes.h"
#include "patina/rt/problem.h"

namespace patina::rt {

struct SolveOptions {
    int streams = 16;  // quadrature nodes per hemisphere in the medium above (air); denser media add their own
    double fourier_tolerance = 1e-9;  // stop at the Fourier order whose largest element, relative to the BRDF, is below
    bool scalar = false;              // intensity only (the 1x1 problem), to show what ignoring polarization costs
    std::int64_t samples =
        1'000'000;                // photon packets of a statistical solver; reflection() shares them among incidences
    std::uint64_t seed = 1;       // of its random numbers; the same seed gives the same bits on any number of threads
    int most_fourier_orders = 0;  // of reflection(); 1 is enough for fluxes and views along the normal; 0: all needed
    // Asked between Fourier orders, within them, and between photon packets; a stop throws Error(interrupted).
    const CancelToken* cancel = nullptr;
    // Told the share of the work that is done, 0 to 1, from any thread. Fourier series may end before 1.
    std::function<void(double)> progress = {};
};

struct Diagnostics {
    bool converged = true;
    int streams = 0;
    int fourier_orders = 0;
    double energy_balance = 0.0;  // largest |1 - (reflected + absorbed + transmitted)| seen where it is known exactly
    std::vector<std::string> notes;
};

// Reflection of the whole stack seen from above, without the specular (delta) part.
//
// modes[m] is (4N x 4N), 4x4 block (o, i) = f^m(mu[o], mu[i]) in 1/sr, no cosine and no weight inside:
//   f(mu_o, mu_i, phi) = sum_m (2 - delta_m0) T_m(phi) o f^m,
// where the elements {I,Q}<-{I,Q} and {U,V}<-{U,V} take cos(m phi), {I,Q}<-{U,V} take -sin(m phi) and {U,V}<-{I,Q} take
// +sin(m phi); phi is the azimuth of the outgoing minus that of the incident PROPAGATION direction, right-handed about
// the outward normal. S_out = sum over incidence of f S_in cos(theta_i) d omega.
struct Reflection {
    std::vector<double> mu;       // cosines in the medium above, ascending, N
    std::vector<double> weights;  // quadrature weights of d mu on (0, 1), N
    std::vector<Eigen::MatrixXd> modes;
    Diagnostics diagnostics;
};

// Stokes radiances wanted at exact directions (no interpolation between nodes).
struct FieldRequest {
    double mu_i = 1.0;                    // cosine of incidence in the medium above, (0, 1]
    optics::Stokes incident{1, 0, 0, 0};  // Stokes vector of the beam, times flux pi through a plane normal to it
    std::vector<double>
        optical_depths;        // 0 = just above the top interface (up) / just below it (down); increasing downward
    std::vector<double> mu_o;  // cosines of the view direction, [0, 1]; used for both hemispheres
    std::vector<double> phi;   // radians
};

struct Field {
    // upward[d][o][p], downward[d][o][p]: diffuse Stokes radiance at optical_depths[d], mu_o[o], phi[p].
    // Directions at depth 0 upward are in the medium above; inside and at the bottom they are in the layer.
    std::vector<std::vector<std::vector<optics::Stokes>>> upward, downward;
    // One standard deviation of each value, same shape; empty for deterministic solvers.
    std::vector<std::vector<std::vector<optics::Stokes>>> upward_error, downward_error;
    Diagnostics diagnostics;
};

class Solver {
  public:
    virtual ~Solver() = default;
    virtual std::string_view name() const = 0;
    virtual std::string_view summary() const = 0;
    // True when the answers have random errors, and field() tells them: such a solver is held to its own error bars
    // (tests/cross), not to the digits of a table.
    virtual bool is_statistical() const { return false; }
    // Empty when the solver can do the problem, else the reason it cannot, for the user.
    virtual std::string unsupported(const Problem& problem) const = 0;
    virtual Reflection reflection(const Problem& problem, const SolveOptions& options) const = 0;
    virtual Field field(const Problem& problem, const FieldRequest& request, const SolveOptions& options) const = 0;
};

// Registered solvers, the default first; and one by name (Error(usage) with a suggestion when unknown).
const std::vector<std::unique_ptr<Solver>>& solvers();
const Solver& solver_named(std::string_view name);

// Throws Error(input) for anything physically impossible: albedo outside 0..1, negative or NaN thickness, coefficients
// of unequal length or alpha1[0] != 1, no layer, an infinite layer above another.
void validate(const Problem& problem);

// The specular (delta) part along the mirror direction, radiance out = M radiance in, for incidence at cosine mu in the
// medium above: surface = Fresnel reflection at the top interface alone (zero when index matched); coherent = the
// unscattered beam through the stack, reflected by a metal base, with all its internal reflections, in closed form.
optics::Mueller specular_surface(const Problem& problem, double mu);
optics::Mueller specular_coherent(const Problem& problem, double mu);

}  // namespace patina::rt
