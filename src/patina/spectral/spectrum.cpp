#include "patina/spectral/spectrum.h"

#include <algorithm>
#include <utility>

#include "patina/core/contract.h"

namespace patina::spectral {

Spectrum::Spectrum(std::vector<double> wavelengths_nm, std::vector<double> values, Outside outside)
    : wavelengths_nm_(std::move(wavelengths_nm)), values_(std::move(values)), outside_(outside) {
    PATINA_EXPECT(!wavelengths_nm_.empty());
    PATINA_EXPECT(wavelengths_nm_.size() == values_.size());
    PATINA_EXPECT(std::adjacent_find(wavelengths_nm_.begin(), wavelengths_nm_.end(), std::greater_equal<>{}) ==
                  wavelengths_nm_.end());
}

double Spectrum::operator()(double wavelength_nm) const {
    if (is_uniform()) return values_[0];

    // Leave the samples on either side; the ends themselves belong to the spectrum.
    if (wavelength_nm < wavelengths_nm_.front()) return outside_ == Outside::hold ? values_.front() : 0.0;
    if (wavelength_nm > wavelengths_nm_.back()) return outside_ == Outside::hold ? values_.back() : 0.0;

    // Interpolate between the samples around the wavelength.
    const auto above = std::upper_bound(wavelengths_nm_.begin(), wavelengths_nm_.end(), wavelength_nm);
    if (above == wavelengths_nm_.end()) return values_.back();
    const auto i = static_cast<size_t>(above - wavelengths_nm_.begin());
    const double t = (wavelength_nm - wavelengths_nm_[i - 1]) / (wavelengths_nm_[i] - wavelengths_nm_[i - 1]);
    return values_[i - 1] + t * (values_[i] - values_[i - 1]);
}

Spectrum Spectrum::scaled(double factor) const {
    Spectrum result = *this;
    for (double& value : result.values_) value *= factor;
    return result;
}

}  // namespace patina::spectral
