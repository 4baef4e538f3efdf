#include "patina/render/spectrum.h"

#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"

namespace patina::render {

namespace {

// Planck's spectral radiance in W/(m^2 sr nm); constants exact in the SI of 2019.
double planck(double wavelength_nm, double kelvin) {
    constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    const double w = wavelength_nm * 1e-9;
    return 1e-9 * 2 * h * c * c / (std::pow(w, 5) * std::expm1(h * c / (w * k * kelvin)));
}

void expect_range(const Spectrum& spectrum, float low, float high, const SourceLocation& where, const char* what) {
    // Two ulp of slack: a reflectance of exactly 1 must pass after the conversion to float.
    if (spectrum.smallest() >= low && spectrum.largest() <= high * 1.0000002f) return;
    throw input_error(where, fmt::format("{} out of range", what),
                      fmt::format("it spans {} to {} over 380 .. 780 nm", spectrum.smallest(), spectrum.largest()),
                      std::isfinite(high) ? fmt::format("keep it between {} and {}", low, high)
                                          : fmt::format("keep it at or above {}", low));
}

void expect_finite(const SpectrumSpec& spec, const SourceLocation& where) {
    for (double value : spec.values)
        if (!std::isfinite(value)) throw input_error(where, "spectrum has a value that is not finite");
    if (spec.values.empty()) throw input_error(where, "spectrum has no values");
}

Eigen::Vector3d rgb_of(const SpectrumSpec& spec, const SourceLocation& where) {
    if (spec.values.size() != 3) throw input_error(where, "an rgb colour needs three values");
    return {spec.values[0], spec.values[1], spec.values[2]};
}

SpectrumFunction upsampled(const Eigen::Vector3d& rgb, const SceneResources& resources, const SourceLocation& where) {
    // Greys are uniform spectra; the sigmoid reaches 0 and 1 only in the limit.
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return [grey = rgb[0]](double) { return grey; };
    if (!resources.rgb_reflectance)
        throw Error(ErrorKind::not_built, where.to_string() + ": rgb colours are not available");
    const SigmoidCoefficients c = resources.rgb_reflectance(rgb);
    return [c](double w) {
        const double x = (c[0] * w + c[1]) * w + c[2];
        return 0.5 + 0.5 * x / std::sqrt(1 + x * x);
    };
}

SpectrumFunction unit_d65(const SceneResources& resources, const SourceLocation& where) {
    if (!resources.illuminant_d65 || !resources.cie_xyz)
        throw Error(ErrorKind::not_built, where.to_string() + ": rgb emitters need the illuminant D65");
    double luminance = 0, unit = 0;
    for (int nm = 380; nm <= 780; ++nm) {
        const double y = resources.cie_xyz(nm)[1];
        unit += y;
        luminance += y * resources.illuminant_d65(nm);
    }
    return [d65 = resources.illuminant_d65, scale = unit / luminance](double nm) { return scale * d65(nm); };
}

}  // namespace

Spectrum::Spectrum(const SpectrumFunction& function) {
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

SpectrumFunction interpolated(const SpectrumSpec& sampled, bool zero_outside, const SourceLocation& where) {
    const auto& x = sampled.wavelengths_nm;
    if (x.size() != sampled.values.size() || x.empty())
        throw input_error(where, "a sampled spectrum needs as many values as wavelengths",
                          fmt::format("{} values, {} wavelengths", sampled.values.size(), x.size()));
    for (std::size_t i = 1; i < x.size(); ++i)
        if (!(x[i] > x[i - 1])) throw input_error(where, "wavelengths of a spectrum must ascend");
    return [x, y = sampled.values, zero_outside](double nm) {
        if (nm < x.front() || nm > x.back()) return zero_outside ? 0.0 : (nm < x.front() ? y.front() : y.back());
        const std::size_t upper = std::upper_bound(x.begin(), x.end(), nm) - x.begin();
        if (upper == x.size()) return y.back();
        const double t = (nm - x[upper - 1]) / (x[upper] - x[upper - 1]);
        return (1 - t) * y[upper - 1] + t * y[upper];
    };
}

Spectrum reflectance_spectrum(const SpectrumSpec& spec, const SceneResources& resources, const SourceLocation& where) {
    expect_finite(spec, where);
    Spectrum spectrum;
    switch (spec.kind) {
        case SpectrumSpec::Kind::uniform:
            spectrum = Spectrum(static_cast<float>(spec.values[0]));
            break;
        case SpectrumSpec::Kind::sampled:
        case SpectrumSpec::Kind::file:
            spectrum = Spectrum(interpolated(spec, false, where));
            break;
        case SpectrumSpec::Kind::rgb: {
            const Eigen::Vector3d rgb = rgb_of(spec, where);
            if (rgb.minCoeff() < 0 || rgb.maxCoeff() > 1)
                throw input_error(where, "rgb reflectance out of range",
                                  fmt::format("({}, {}, {})", rgb[0], rgb[1], rgb[2]), "keep it between 0 and 1");
            spectrum = Spectrum(upsampled(rgb, resources, where));
            break;
        }
        case SpectrumSpec::Kind::blackbody:
            throw input_error(where, "a blackbody is no reflectance", "", "use it as the radiance of an emitter");
    }
    expect_range(spectrum, 0, 1, where, "reflectance");
    return spectrum;
}

Spectrum emission_spectrum(const SpectrumSpec& spec, const SceneResources& resources, const SourceLocation& where) {
    expect_finite(spec, where);
    Spectrum spectrum;
    switch (spec.kind) {
        case SpectrumSpec::Kind::uniform:
            spectrum = Spectrum(static_cast<float>(spec.values[0]));
            break;
        case SpectrumSpec::Kind::sampled:
        case SpectrumSpec::Kind::file:
            spectrum = Spectrum(interpolated(spec, true, where));
            break;
        case SpectrumSpec::Kind::rgb: {
            // The sigmoid holds for components up to 1: scale the brightest to one half, and back.
            const Eigen::Vector3d rgb = rgb_of(spec, where);
            if (rgb.minCoeff() < 0) throw input_error(where, "rgb emission out of range", "a component is negative");
            const double scale = 2 * rgb.maxCoeff();
            if (scale == 0) return Spectrum(0.0f);
            spectrum = Spectrum([scale, colour = upsampled(rgb / scale, resources, where),
                                 d65 = unit_d65(resources, where)](double nm) { return scale * colour(nm) * d65(nm); });
            break;
        }
        case SpectrumSpec::Kind::blackbody: {
            const double kelvin = spec.values[0], scale = spec.values.size() > 1 ? spec.values[1] : 1.0;
            if (!(kelvin > 0))
                throw input_error(where, "temperature must be positive", fmt::format("it is {} K", kelvin));
            spectrum = Spectrum([=](double nm) { return scale * planck(nm, kelvin); });
            break;
        }
    }
    expect_range(spectrum, 0, INFINITY, where, "emission");
    return spectrum;
}

ColourMatching::ColourMatching(const SceneResources& resources) {
    PATINA_EXPECT(resources.cie_xyz);
    double integral = 0;
    for (int nm = 360; nm <= 830; ++nm) integral += resources.cie_xyz(nm)[1];
    const auto component = [&](int i) {
        return Spectrum([&, i](double nm) { return resources.cie_xyz(nm)[i] * wavelength_range_nm / integral; });
    };
    x = component(0), y = component(1), z = component(2);
}

Eigen::Vector3f xyz_to_srgb(const Eigen::Vector3f& xyz) {
    Eigen::Matrix3f m;
    m << 3.240479f, -1.537150f, -0.498535f, -0.969256f, 1.875991f, 0.041556f, 0.055648f, -0.204043f, 1.057311f;
    return m * xyz;
}

}  // namespace patina::render
