#include "patina/render/spectrum.h"

#include <algorithm>
#include <numeric>

#include "patina/spectral/observer.h"
#include "patina/spectral/rgb_upsampling.h"
#include "patina/spectral/scene_spectrum.h"

namespace patina::render {

Spectrum::Spectrum(const std::function<double(double)>& function) {
    values_.resize(spectrum_nodes);
    for (int i = 0; i < spectrum_nodes - 1; ++i) values_[i] = static_cast<float>(function(wavelength_min_nm + i));
    values_.back() = values_[spectrum_nodes - 2];
    const auto [low, high] = std::minmax_element(values_.begin(), values_.end());
    if (*low != *high) return;
    uniform_ = *low;
    values_.clear();
}

bool Spectrum::is_black() const {
    return smallest() == 0 && largest() == 0;
}
float Spectrum::smallest() const {
    return values_.empty() ? uniform_ : *std::min_element(values_.begin(), values_.end());
}
float Spectrum::largest() const {
    return values_.empty() ? uniform_ : *std::max_element(values_.begin(), values_.end());
}
float Spectrum::average() const {
    if (values_.empty()) return uniform_;
    return std::accumulate(values_.begin(), values_.end() - 1, 0.0f) / (spectrum_nodes - 1);
}

Spectrum reflectance_table(const SpectrumSpec& spec, const SourceLocation& where) {
    return Spectrum(spectral::reflectance_spectrum(spec, where));
}
Spectrum emission_table(const SpectrumSpec& spec, const SourceLocation& where) {
    Spectrum table(spectral::emission_spectrum(spec, where));
    // Beyond this products of two overflow single precision.
    if (!(table.largest() < 1e15f)) throw input_error(where, "the light is too strong", "", "keep it below 1e15");
    return table;
}
Spectrum property_table(const SpectrumSpec& spec, const SourceLocation& where) {
    return Spectrum(spectral::property_spectrum(spec, where));
}

SigmoidCoefficients sigmoid_coefficients(const Eigen::Vector3d& rgb) {
    // Black and white are infinite coefficients; 1e6 is as black in single precision and stays finite when squared.
    const Eigen::Vector3f c =
        spectral::upsampled_reflectance(rgb).coefficients().cwiseMax(-1e6).cwiseMin(1e6).cast<float>();
    return {c[0], c[1], c[2]};
}

ColourMatching::ColourMatching() {
    using spectral::Observer;
    const double scale = wavelength_range_nm / spectral::luminance_integral_nm(Observer::cie1931_2deg);
    for (int node = 0; node < spectrum_nodes; ++node) {
        const Eigen::Vector3d v =
            scale * spectral::colour_matching(Observer::cie1931_2deg, wavelength_min_nm + node + 0.5);
        rows_.push_back(Float4{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0.0f});
    }
}

Eigen::Vector3f xyz_to_srgb(const Eigen::Vector3f& xyz) {
    Eigen::Matrix3f m;
    m << 3.240479f, -1.537150f, -0.498535f, -0.969256f, 1.875991f, 0.041556f, 0.055648f, -0.204043f, 1.057311f;
    return m * xyz;
}

}  // namespace patina::render
