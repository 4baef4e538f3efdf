#include "patina/render/picture_parts.h"

#include <cmath>

#include "patina/core/contract.h"

namespace patina::render {

namespace {

constexpr int kept_digits = 22;  // two fewer than a float has: room for the rounding of many parts

void align(std::vector<StokesImage>& parts, std::vector<float> StokesImage::*values) {
    const std::size_t count = (parts.front().*values).size();
    for (std::size_t i = 0; i < count; ++i) {
        double magnitude = 0;
        for (const StokesImage& part : parts) magnitude += std::abs((part.*values)[i]);
        if (magnitude == 0) continue;
        const int exponent = std::ilogb(magnitude) + 1;
        for (StokesImage& part : parts) {
            float& value = (part.*values)[i];
            const double steps = std::nearbyint(std::ldexp(static_cast<double>(value), kept_digits - exponent));
            value = static_cast<float>(std::ldexp(steps, exponent - kept_digits));
        }
    }
}

void add(std::vector<float>& sum, const std::vector<float>& part) {
    PATINA_EXPECT(sum.size() == part.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
}

}  // namespace

void align_parts(std::vector<StokesImage>& parts) {
    if (parts.empty()) return;
    PATINA_EXPECT(parts.size() <= (std::size_t{1} << 20));
    align(parts, &StokesImage::spectral);
    align(parts, &StokesImage::rgb);
}

void add_part(StokesImage& sum, const StokesImage& part) {
    add(sum.spectral, part.spectral);
    add(sum.rgb, part.rgb);
}

}  // namespace patina::render
