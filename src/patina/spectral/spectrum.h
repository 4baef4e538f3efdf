#pragma once
// A spectrum: a value for every wavelength, uniform or from samples joined by straight lines.

#include <functional>
#include <vector>

namespace patina::spectral {

// Any spectrum the colorimetry can integrate; the wavelength is in vacuum, in nm.
using SpectralFunction = std::function<double(double wavelength_nm)>;

// What a sampled spectrum is outside its samples.
enum class Outside {
    zero,  // sources: what was not measured does not shine
    hold   // material properties: the value of the nearest end
};

class Spectrum {
  public:
    // The same value at every wavelength.
    explicit Spectrum(double value) : values_{value} {}

    // Values at strictly ascending wavelengths; linear between them.
    Spectrum(std::vector<double> wavelengths_nm, std::vector<double> values, Outside outside);

    double operator()(double wavelength_nm) const;

    bool is_uniform() const { return wavelengths_nm_.empty(); }
    // Empty for a uniform spectrum, whose one value is values()[0].
    const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
    const std::vector<double>& values() const { return values_; }

    Spectrum scaled(double factor) const;

  private:
    std::vector<double> wavelengths_nm_;
    std::vector<double> values_;
    Outside outside_ = Outside::hold;
};

}  // namespace patina::spectral
