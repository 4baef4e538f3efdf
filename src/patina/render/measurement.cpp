#include "patina/render/measurement.h"

#include "patina/core/constants.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/observer.h"

namespace patina::render {

namespace {

// The luminance of linear sRGB is 1 for the uniform unit spectrum.
double photometric_of(const Eigen::Vector3d& rgb) {
    return spectral::luminous_efficacy_lm_per_w * spectral::luminance_integral_nm(spectral::Observer::cie1931_2deg) *
           spectral::linear_srgb_to_xyz(rgb)[1];
}

}  // namespace

const QuantityNames& names_of(Quantity quantity) {
    static constexpr QuantityNames names[] = {
        {"flux", "W", "W/nm", "luminous flux", "lm"},
        {"intensity", "W/sr", "W/(sr nm)", "luminous intensity", "cd"},
        {"irradiance", "W/m^2", "W/(m^2 nm)", "illuminance", "lx"},
        {"radiosity", "W/m^2", "W/(m^2 nm)", "luminous exitance", "lm/m^2"},
        {"radiance", "W/(m^2 sr)", "W/(m^2 sr nm)", "luminance", "cd/m^2"},
    };
    return names[static_cast<int>(quantity)];
}

Measurement measure(const StokesImage& image, Quantity quantity, bool all_directions) {
    Measurement m;
    m.quantity = quantity;
    m.spectral.assign(static_cast<std::size_t>(image.bin_count()) * 4, 0.0);
    const auto pixels = static_cast<double>(image.pixel_count());
    std::array<Eigen::Vector3d, 4> colour;
    colour.fill(Eigen::Vector3d::Zero());
    double variance = 0;
    for (std::size_t p = 0; p < image.pixel_count(); ++p) {
        for (std::size_t i = 0; i < m.spectral.size(); ++i)
            m.spectral[i] += image.spectral[p * m.spectral.size() + i] / pixels;
        for (int k = 0; k < 4; ++k)
            colour[k] += Eigen::Map<const Eigen::Vector3f>(image.stokes_rgb(p) + 3 * k).cast<double>() / pixels;
        m.peak =
            std::max(m.peak, photometric_of(Eigen::Map<const Eigen::Vector3f>(image.stokes_rgb(p)).cast<double>()));
        if (!image.variance.empty()) variance += image.variance[4 * p] / (pixels * pixels);
    }
    for (int k = 0; k < 4; ++k) {
        m.photometric[k] = photometric_of(colour[k]);
        for (int b = 0; b < image.bin_count(); ++b)
            m.radiometric[k] += m.spectral[4 * b + k] * (image.bin_edges_nm[b + 1] - image.bin_edges_nm[b]);
    }
    m.standard_error = std::sqrt(variance) * photometric_of(Eigen::Vector3d::Ones());
    if (all_directions) m.total_flux = {{4 * pi * m.radiometric[0], 4 * pi * m.photometric[0]}};
    return m;
}

}  // namespace patina::render
