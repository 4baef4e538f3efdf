#pragma once
// Optical constants of a material: complex refractive index against vacuum wavelength, with its publication.

#include <complex>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace patina::optics {

enum class Extrapolation {
    refuse,  // outside the data: Error(input) naming the material, its range and its publication
    hold     // n and k of the nearest end, k of a material without k data is 0
};

// m = n + i k, k >= 0, on [wavelength_min_nm, wavelength_max_nm]. Immutable.
class OpticalConstants {
  public:
    // n and k may come from tables on different grids or from a dispersion formula; `k_known` false means the source
    // gives no k, which is then taken as 0 and flagged in outputs.
    OpticalConstants(std::string name, std::string citation, double wavelength_min_nm, double wavelength_max_nm,
                     bool k_known, std::function<std::complex<double>(double wavelength_nm)> index);

    // The same index at every wavelength; no range.
    static OpticalConstants constant(std::complex<double> index);

    const std::string& name() const { return name_; }
    const std::string& citation() const { return citation_; }
    double wavelength_min_nm() const { return wavelength_min_nm_; }
    double wavelength_max_nm() const { return wavelength_max_nm_; }
    bool k_known() const { return k_known_; }
    bool covers(double wavelength_nm) const {
        return wavelength_nm >= wavelength_min_nm_ && wavelength_nm <= wavelength_max_nm_;
    }

    // Index at a vacuum wavelength; Throws Error(input) outside the data unless `extrapolation` is hold.
    std::complex<double> at(double wavelength_nm, Extrapolation extrapolation = Extrapolation::refuse) const;

  private:
    std::string name_, citation_;
    double wavelength_min_nm_, wavelength_max_nm_;
    bool k_known_;
    std::function<std::complex<double>(double)> index_;
};

}  // namespace patina::optics
