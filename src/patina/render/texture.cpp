#include "patina/render/texture.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

std::shared_ptr<SpectralBitmap> upsample(const Bitmap& image, const SourceLocation& where) {
    auto result = std::make_shared<SpectralBitmap>();
    result->width = image.width;
    result->height = image.height;
    result->coefficients.reserve(static_cast<std::size_t>(image.width) * image.height);
    const bool colour = image.channel_count() >= 3;
    if (image.width < 1 || image.height < 1 || image.channel_count() < 1)
        throw input_error(where, fmt::format("image \"{}\" is empty", image.name));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.pixel(x, y);
            result->coefficients.push_back(
                sigmoid_coefficients(colour ? Eigen::Vector3d(p[0], p[1], p[2]) : Eigen::Vector3d::Constant(p[0])));
        }
    return result;
}

}  // namespace

Float4 SpectralBitmap::at(const Wavelengths& w, Vec2 uv) const {
    const float x = (uv.x() - std::floor(uv.x())) * width - 0.5f;
    const float y = (1 - (uv.y() - std::floor(uv.y()))) * height - 0.5f;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float fx = x - x0, fy = y - y0;
    const auto texel = [&](int column, int row) {
        column = (column + width) % width;
        row = (row + height) % height;
        return sigmoid_reflectance(coefficients[static_cast<std::size_t>(row) * width + column], w);
    };
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
           fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

Float4 Texture::varying(const Wavelengths& w, const Vec2& uv) const {
    const Vec3 mapped = to_uv_ * Vec3(uv.x(), uv.y(), 1);
    if (bitmap_) return bitmap_->at(w, {mapped.x(), mapped.y()});
    const bool odd_x = mapped.x() - std::floor(mapped.x()) > 0.5f, odd_y = mapped.y() - std::floor(mapped.y()) > 0.5f;
    return odd_x == odd_y ? spectrum_.at(w) : other_->at(w, uv);
}

float Texture::average() const {
    if (other_) return 0.5f * (spectrum_.average() + other_->average());
    if (!bitmap_) return spectrum_.average();
    // A few hundred texels at mid wavelength are enough for a sampling weight.
    const Wavelengths w = Wavelengths::sample(0.1f);
    float total = 0;
    const std::size_t count = bitmap_->coefficients.size(), step = std::max<std::size_t>(1, count / 256);
    int used = 0;
    for (std::size_t i = 0; i < count; i += step, ++used)
        total += mean(sigmoid_reflectance(bitmap_->coefficients[i], w));
    return total / static_cast<float>(used);
}

Texture Texture::reflectance(const Properties& plugin, const std::string& name, float fallback,
                             const SceneResources& resources) {
    if (const auto child = plugin.named_child(name)) {
        if (child->category != "texture")
            throw input_error(child->where, fmt::format("\"{}\" must be a spectrum or a texture", name),
                              fmt::format("it is a {}", child->category));
        return build(*child, resources);
    }
    const auto spec = plugin.spectrum(name);
    if (!spec) return Spectrum(fallback);
    return reflectance_table(*spec, plugin.location_of(name));
}

Texture Texture::build(const Properties& texture, const SceneResources& resources) {
    expect_plugin(texture);
    Texture result;
    const Eigen::Matrix4d to_uv = texture.transform("to_uv");
    if (!(to_uv.cwiseAbs().maxCoeff() < 1e6))
        throw input_error(texture.location_of("to_uv"), "the transform of the texture is too large");
    // Mitsuba's to_uv is a 4x4 transform of which the plane part counts.
    result.to_uv_ << static_cast<float>(to_uv(0, 0)), static_cast<float>(to_uv(0, 1)), static_cast<float>(to_uv(0, 3)),
        static_cast<float>(to_uv(1, 0)), static_cast<float>(to_uv(1, 1)), static_cast<float>(to_uv(1, 3)), 0, 0, 1;
    if (texture.type == "bitmap") {
        const std::string file = texture.string("filename");
        const bool raw = texture.boolean("raw", false);
        if (!resources.load_bitmap)
            throw Error(ErrorKind::not_built, texture.where.to_string() + ": image files are not available");
        result.bitmap_ = upsample(*resources.load_bitmap(file, raw), texture.location_of("filename"));
        expect_known_properties(texture);
        return result;
    }
    const auto colour = [&](const char* name, float fallback) {
        const auto spec = texture.spectrum(name);
        return spec ? reflectance_table(*spec, texture.location_of(name)) : Spectrum(fallback);
    };
    result.spectrum_ = colour("color0", 0.4f);
    result.other_ = std::make_shared<const Texture>(Texture(colour("color1", 0.2f)));
    expect_known_properties(texture);
    return result;
}

}  // namespace patina::render
