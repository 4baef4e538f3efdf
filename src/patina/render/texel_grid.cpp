#include "patina/render/texel_grid.h"

#include <cmath>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

int wrapped(int i, int size, TexelGrid::Wrap wrap) {
    if (wrap == TexelGrid::Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = wrap == TexelGrid::Wrap::mirror ? 2 * size : size;
    i = (i % period + period) % period;
    return i < size ? i : period - 1 - i;
}

// Near 0 .. 1 before it is multiplied by the number of texels: a far place would overflow an integer.
float near_unit(float u, TexelGrid::Wrap wrap) {
    if (wrap == TexelGrid::Wrap::clamp) return std::clamp(u, -1.0f, 2.0f);
    return wrap == TexelGrid::Wrap::mirror ? u - 2 * std::floor(0.5f * u) : u - std::floor(u);
}

}  // namespace

TexelPatch TexelGrid::at(const Vec2& uv) const {
    const Vec3 mapped = to_uv * Vec3(uv.x(), uv.y(), 1);
    const float centre = nearest ? 0.0f : 0.5f;
    const float x = near_unit(mapped.x(), wrap) * width - centre;
    const float y = near_unit(mapped.y(), wrap) * height - centre;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto texel = [&](int column, int row) {
        return static_cast<std::size_t>(wrapped(row, height, wrap)) * width + wrapped(column, width, wrap);
    };
    if (nearest) {
        const std::size_t only = texel(x0, y0);
        return {{only, only, only, only}, 0, 0};
    }
    return {{texel(x0, y0), texel(x0 + 1, y0), texel(x0, y0 + 1), texel(x0 + 1, y0 + 1)}, x - x0, y - y0};
}

Eigen::Matrix3f plane_transform(const Properties& texture) {
    const Eigen::Matrix4d m = texture.transform("to_uv");
    if (!(m.cwiseAbs().maxCoeff() < 1e6))
        throw input_error(texture.location_of("to_uv"), "the transform of the texture is too large");
    Eigen::Matrix3d plane;
    plane << m(0, 0), m(0, 1), m(0, 3), m(1, 0), m(1, 1), m(1, 3), 0, 0, 1;
    return plane.cast<float>();
}

TexturePicture read_picture(const Properties& texture, const SceneResources& resources, bool raw) {
    expect_plugin(texture);
    if (texture.category != "texture" || texture.type != "bitmap")
        throw input_error(texture.where, "a bitmap texture is needed here",
                          fmt::format("it is a {} \"{}\"", texture.category, texture.type));
    if (!resources.load_bitmap)
        throw Error(ErrorKind::not_built, texture.where.to_string() + ": image files are not available");
    const auto word = [&](const char* name, const char* fallback, const std::vector<std::string>& known) {
        const std::string value = texture.string(name, fallback);
        if (std::find(known.begin(), known.end(), value) == known.end())
            throw input_error(texture.location_of(name), fmt::format("unknown {} \"{}\"", name, value), "",
                              did_you_mean(value, known));
        return value;
    };
    TexturePicture picture;
    picture.raw = texture.boolean("raw", raw);
    picture.image = resources.load_bitmap(texture.string("filename"), picture.raw);
    const Bitmap& image = *picture.image;
    if (image.width < 1 || image.height < 1 || image.channel_count() < 1)
        throw input_error(texture.location_of("filename"), fmt::format("image \"{}\" is empty", image.name));
    picture.grid.width = image.width;
    picture.grid.height = image.height;
    picture.grid.to_uv = plane_transform(texture);
    picture.grid.nearest = word("filter_type", "bilinear", {"bilinear", "nearest"}) == "nearest";
    const std::string wrap = word("wrap_mode", "repeat", {"repeat", "mirror", "clamp"});
    picture.grid.wrap = wrap == "repeat"   ? TexelGrid::Wrap::repeat
                        : wrap == "mirror" ? TexelGrid::Wrap::mirror
                                           : TexelGrid::Wrap::clamp;
    texture.string("format", "");
    texture.boolean("accel", true);
    expect_known_properties(texture);
    return picture;
}

std::vector<ParameterDescriptor> picture_parameters() {
    return {{"filename", "path", "", "", "", "the picture"},
            {"raw", "boolean", "", "false; true for data", "", "values are data, not sRGB"},
            {"filter_type", "string", "", "bilinear", "bilinear, nearest", "between texel centres"},
            {"wrap_mode", "string", "", "repeat", "repeat, mirror, clamp", "beyond 0 .. 1"},
            {"to_uv", "transform", "", "identity", "", "of texture coordinates"},
            {"format", "string", "", "", "", "accepted, without effect"},
            {"accel", "boolean", "", "true", "", "accepted, without effect"}};
}

}  // namespace patina::render
