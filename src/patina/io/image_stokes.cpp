#include "patina/io/image_stokes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/contract.h"
#include "patina/core/error.h"

namespace patina::io {

namespace {

// Y of linear sRGB (IEC 61966-2-1).
const Eigen::Vector3f luminance_weights(0.2126f, 0.7152f, 0.0722f);

int bin_of(const StokesImage& image, double wavelength_nm) {
    const auto& edges = image.bin_edges_nm;
    if (image.bin_count() == 0)
        throw Error(ErrorKind::usage, "the image has no spectral channels, so no wavelength can be chosen");
    if (!(wavelength_nm >= edges.front() && wavelength_nm <= edges.back()))
        throw Error(ErrorKind::usage, fmt::format("{} nm is outside of the image's spectrum ({} to {} nm)",
                                                  wavelength_nm, edges.front(), edges.back()));
    const auto after = std::upper_bound(edges.begin(), edges.end(), wavelength_nm);
    return std::min(static_cast<int>(after - edges.begin()) - 1, image.bin_count() - 1);
}

}  // namespace

StokesPlane select_band(const StokesImage& image, const BandChoice& choice) {
    if (choice.colour && (*choice.colour < 0 || *choice.colour > 2))
        throw Error(ErrorKind::usage, fmt::format("there is no colour {} (0 red, 1 green, 2 blue)", *choice.colour));
    PATINA_EXPECT(image.rgb.size() == image.pixel_count() * 12);
    StokesPlane plane{image.width, image.height, {}};
    plane.pixels.reserve(image.pixel_count());
    const int bin = choice.wavelength_nm ? bin_of(image, *choice.wavelength_nm) : 0;
    Eigen::Vector3f weights = luminance_weights;
    if (choice.colour) weights = Eigen::Vector3f::Unit(*choice.colour);
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
        if (choice.wavelength_nm) {
            plane.pixels.emplace_back(image.stokes(pixel, bin));
            continue;
        }
        // Four rows of R, G, B.
        const Eigen::Map<const Eigen::Matrix<float, 4, 3, Eigen::RowMajor>> rgb(image.stokes_rgb(pixel));
        plane.pixels.emplace_back(rgb * weights);
    }
    return plane;
}

float dop(const Eigen::Vector4f& stokes) {
    return stokes[0] > 0 ? stokes.tail<3>().norm() / stokes[0] : 0.0f;
}
float dolp(const Eigen::Vector4f& stokes) {
    return stokes[0] > 0 ? stokes.segment<2>(1).norm() / stokes[0] : 0.0f;
}
float docp(const Eigen::Vector4f& stokes) {
    return stokes[0] > 0 ? stokes[3] / stokes[0] : 0.0f;
}

float aolp_deg(const Eigen::Vector4f& stokes) {
    const double angle = 0.5 * degrees(std::atan2(double(stokes[2]), double(stokes[1])));
    const auto wrapped = static_cast<float>(angle < 0 ? angle + 180.0 : angle);
    return wrapped < 180.0f ? wrapped : 0.0f;
}

}  // namespace patina::io
