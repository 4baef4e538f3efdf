#pragma once
// Lorenz-Mie scattering by one homogeneous sphere.
//
// Bohren & Huffman (1983), chapter 4: time factor exp(-i w t), relative index m = n + i k with k >= 0 for absorption,
// amplitudes E_s' = S1 E_s, E_p' = S2 E_p. Logarithmic derivatives and Riccati-Bessel psi come from downward
// recurrences started far enough beyond their turning points (physics: Nussenzveig 1992, the Airy region has the width
// x^(1/3)), chi from the upward one, so that the smallest spheres lose no digits and the largest are stable. Limits:
// 1e-20 <= x, |m| x <= 1e6; |m - 1| much smaller than 1e-8 is lost to rounding.

#include <complex>
#include <span>
#include <vector>

#include <Eigen/Dense>

namespace patina::optics {

// S1 and S2 at a list of angles (dimensionless, eq. 4.74).
struct MieAmplitudes {
    Eigen::ArrayXcd s1, s2;
};

class MieSphere {
  public:
    // x = 2 pi r n_host / lambda > 0; m = n_particle / n_host.
    MieSphere(double size_parameter, std::complex<double> relative_index);
    static MieSphere perfect_conductor(double size_parameter);

    // In an absorbing host, in the far field: x = k r with the complex wavenumber k = k' + i k'' = 2 pi m_host / lambda
    // and m = m_particle / m_host. The scattered field is E = exp(i k R)/(-i k R) S(theta) E_0 with the incident field
    // E_0 at the centre. Where N spheres a volume lie in the host, the coherent field's wavenumber is k + 2 pi i N
    // S(0)/k^2 (Foldy), so that light is extinguished by 2 k'' + N C_ext with C_ext = 4 pi Re(S(0)/k^2) (Bohren & Gilra
    // 1979, J. Colloid Interface Sci. 72, 215; Mishchenko 2008, Opt. Express 16, 2288), which counts the host that the
    // sphere replaces: it is negative for a hole. C_sca = integral |S|^2 d omega / |k|^2, the decay exp(-2 k'' R)
    // between spheres being the host's (Mishchenko & Yang 2018, J. Quant. Spectrosc. Radiat. Transf. 205, 241).
    // Efficiencies are over pi r^2; absorption = extinction - scattering may be negative. k'' r <= max_host_absorption.
    static MieSphere in_absorbing_host(std::complex<double> size_parameter, std::complex<double> relative_index);
    static constexpr double max_host_absorption = 5.0;

    // Cross sections divided by pi r^2.
    double extinction_efficiency() const { return extinction_efficiency_; }
    double scattering_efficiency() const { return scattering_efficiency_; }
    double absorption_efficiency() const { return absorption_efficiency_; }
    // 4 |S(180 deg)|^2 / x^2, the radar definition: 4 pi (dC/dOmega) / (pi r^2).
    double backscattering_efficiency() const { return backscattering_efficiency_; }
    // <cos theta>.
    double asymmetry() const { return asymmetry_; }

    // At cosines of the scattering angle in [-1, 1].
    MieAmplitudes amplitudes(std::span<const double> cosines) const;

    double size_parameter() const { return size_parameter_; }
    // Coefficients of electric (a) and magnetic (b) multipoles; n = 1 .. order() at index n - 1.
    const std::vector<std::complex<double>>& a() const { return a_; }
    const std::vector<std::complex<double>>& b() const { return b_; }
    int order() const { return static_cast<int>(a_.size()); }

  private:
    MieSphere() = default;
    void sum_efficiencies();

    double size_parameter_ = 0.0;
    std::vector<std::complex<double>> a_, b_;
    double extinction_efficiency_ = 0.0, scattering_efficiency_ = 0.0, absorption_efficiency_ = 0.0;
    double backscattering_efficiency_ = 0.0, asymmetry_ = 0.0;
};

// Number of multipoles that matter to rounding for a sphere of size parameter x (Wiscombe 1980, enlarged).
int mie_order(double size_parameter);

// Angular functions of all multipoles n = 1 .. order at cosines mu: column n - 1 holds pi_n + tau_n and pi_n - tau_n
// (Bohren & Huffman 1983, eq. 4.47), from which S1 +- S2 = sum (2n+1)/(n(n+1)) (a_n +- b_n) (pi_n +- tau_n).
// shape [cosines][order]
struct MieAngularFunctions {
    Eigen::MatrixXd sum, difference;
};
MieAngularFunctions mie_angular_functions(std::span<const double> cosines, int order);

}  // namespace patina::optics
