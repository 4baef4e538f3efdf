// Emitters from their nodes of the scene file.

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/render/emitters.h"
#include "patina/render/plugins.h"
#include "patina/render/sensor.h"

namespace patina::render {

namespace {

Spectrum emission(const Properties& node, const char* name) {
    const auto spec = node.spectrum(name);
    return spec ? emission_table(*spec, node.location_of(name)) : Spectrum(1.0f);
}

Vec3 unit(const Eigen::Vector3d& v, const SourceLocation& where) {
    if (!(v.norm() > 0) || !v.allFinite()) throw input_error(where, "a direction of length zero");
    return v.normalized().cast<float>();
}

Vec3 place(const Eigen::Vector3d& p, const SourceLocation& where) {
    if (!(p.cwiseAbs().maxCoeff() < 1e12))
        throw input_error(where, "the light stands too far away", "", "keep coordinates below 1e12");
    return p.cast<float>();
}

Eigen::Matrix3f rotation_of(const Properties& node) {
    const Eigen::Matrix3d m = node.transform("to_world").block<3, 3>(0, 0);
    const double scale = std::cbrt(std::abs(m.determinant()));
    if (!(scale > 0) || (m.transpose() * m - scale * scale * Eigen::Matrix3d::Identity()).norm() > 1e-4 * scale * scale)
        throw input_error(node.location_of("to_world"), "an environment can be turned only",
                          "its transform is no rotation times a scale");
    return (m / scale).cast<float>();
}

// As of every emitter's spectrum (emission_table): single precision holds what is made of it.
constexpr double brightest_light = 1e15;

EnvironmentEmitter environment(const Properties& node, const SceneResources& resources) {
    const SourceLocation where = node.location_of("filename");
    const std::string file = node.string("filename");
    if (!resources.load_bitmap)
        throw Error(ErrorKind::not_built, where.to_string() + ": environment maps are not available");
    const std::shared_ptr<const Bitmap> image = resources.load_bitmap(file, false);
    const double scale = node.number("scale", 1.0);
    if (!(scale >= 0)) throw input_error(node.location_of("scale"), "scale must be >= 0");
    if (image->channel_count() < 3 || image->width < 1 || image->height < 1)
        throw input_error(where, fmt::format("\"{}\" is no colour image", file));

    EnvironmentEmitter e;
    e.width = image->width, e.height = image->height;
    e.to_local = rotation_of(node).transpose();
    e.illuminant = emission_table({SpectrumSpec::Kind::rgb, {}, {scale, scale, scale}}, where);
    std::vector<double> weight(static_cast<std::size_t>(e.width) * e.height);
    for (int y = 0; y < e.height; ++y)
        for (int x = 0; x < e.width; ++x) {
            const float* p = image->pixel(x, y);
            const Eigen::Vector3d rgb(p[0], p[1], p[2]);
            if (!rgb.allFinite() || rgb.minCoeff() < 0 || rgb.maxCoeff() * std::max(scale, 1.0) > brightest_light)
                throw input_error(where, fmt::format("pixel ({}, {}) is negative, not finite or too bright", x, y), "",
                                  "keep it between 0 and 1e15");
            // The sigmoid holds for components up to 1: the brightest becomes one half.
            const double brightest = std::max(2 * rgb.maxCoeff(), 1e-30);
            const SigmoidCoefficients c = sigmoid_coefficients(rgb / brightest);
            e.texels.push_back({c[0], c[1], c[2], static_cast<float>(brightest)});
            weight[static_cast<std::size_t>(y) * e.width + x] = rgb.mean();
        }

    // Look-ups are bilinear, so a texel's cell also shines by its neighbours: weigh it by the brightest around it.
    std::vector<double> row_weights(e.height);
    for (int y = 0; y < e.height; ++y) {
        std::vector<double> row(e.width);
        for (int x = 0; x < e.width; ++x)
            for (int dy : {-1, 0, 1})
                for (int dx : {-1, 0, 1}) {
                    const int ny = std::clamp(y + dy, 0, e.height - 1), nx = (x + dx + e.width) % e.width;
                    const double value = weight[static_cast<std::size_t>(ny) * e.width + nx];
                    row[x] = std::max(row[x], dx == 0 && dy == 0 ? value : 0.25 * value);
                }
        const double sum = std::accumulate(row.begin(), row.end(), 0.0);
        row_weights[y] = sum / e.width * std::sin(pi * (y + 0.5) / e.height) / e.height;
        if (sum == 0) std::fill(row.begin(), row.end(), 1.0);
        e.columns.emplace_back(row);
    }
    if (std::accumulate(row_weights.begin(), row_weights.end(), 0.0) == 0) row_weights.assign(e.height, 1e-12);
    e.rows = DiscreteDistribution(row_weights);
    return e;
}

// The axes of a spot or projector, which may be scaled but not sheared.
Slide slide_of(const Properties& node) {
    const Eigen::Matrix3d m = node.transform("to_world").block<3, 3>(0, 0);
    Slide slide;
    for (int axis = 0; axis < 3; ++axis) slide.to_local.row(axis) = m.col(axis).normalized().cast<float>().transpose();
    if (!slide.to_local.allFinite() || std::abs(std::abs(slide.to_local.determinant()) - 1) > 1e-3f)
        throw input_error(node.location_of("to_world"), "the axes of the light are not perpendicular");
    return slide;
}

// Where a spot or projector stands and looks; its light is left to the caller.
SpotEmitter spot_in_place(const Properties& node) {
    SpotEmitter e;
    const Eigen::Matrix4d m = node.transform("to_world");
    e.position = place(m.block<3, 1>(0, 3), node.location_of("to_world"));
    e.axis = unit(m.block<3, 1>(0, 2), node.location_of("to_world"));
    return e;
}

SpotEmitter spot(const Properties& node, const SceneResources& resources) {
    SpotEmitter e = spot_in_place(node);
    e.intensity = emission(node, "intensity");
    const double cutoff_deg = node.number("cutoff_angle", 20.0),
                 beam_deg = node.number("beam_width", 0.75 * cutoff_deg);
    if (!(cutoff_deg > 0 && cutoff_deg <= 180) || !(beam_deg > 0 && beam_deg <= cutoff_deg))
        throw input_error(node.location_of("cutoff_angle"), "angles of the spot out of range",
                          fmt::format("cutoff_angle {}, beam_width {}", cutoff_deg, beam_deg),
                          "keep 0 < beam_width <= cutoff_angle <= 180");
    e.cutoff_rad = static_cast<float>(radians(cutoff_deg));
    e.beam_width_rad = static_cast<float>(radians(beam_deg));
    if (const auto picture = node.named_child("texture")) {
        if (!(cutoff_deg < 89))
            throw input_error(node.location_of("cutoff_angle"), "the cone is too wide for a texture",
                              fmt::format("it is {} degrees", cutoff_deg), "keep it below 89");
        Slide slide = slide_of(node);
        slide.tan_u = slide.tan_v = std::tan(e.cutoff_rad);
        slide.picture = Texture::reflectance(node, "texture", 1.0f, resources);
        e.slide = std::make_shared<const Slide>(std::move(slide));
    }
    return e;
}

// The pixel a direction falls on is that of a perspective camera in its place: u to the right of who looks along +z, v
// downwards.
SpotEmitter projector(const Properties& node, const SceneResources& resources) {
    SpotEmitter e = spot_in_place(node);
    const double scale = node.number("scale", 1.0);
    if (!(scale >= 0) || !(scale < 1e12))
        throw input_error(node.location_of("scale"), "scale must be >= 0", fmt::format("it is {}", scale));
    e.intensity = Spectrum(static_cast<float>(scale));
    Slide slide = slide_of(node);
    slide.picture = Texture::emission(node, "irradiance", 1.0f, resources);
    slide.projects = true;
    const double aspect = slide.picture.aspect(), tangent = tangent_along_x(node, aspect);
    slide.tan_u = static_cast<float>(-tangent);
    slide.tan_v = static_cast<float>(-tangent / aspect);
    e.cutoff_rad = e.beam_width_rad = std::atan(std::hypot(slide.tan_u, slide.tan_v)) + 1e-4f;
    e.slide = std::make_shared<const Slide>(std::move(slide));
    return e;
}

}  // namespace

Texture build_area_radiance(const Properties& node, const SceneResources& resources) {
    expect_plugin(node);
    if (node.type != "area")
        throw input_error(node.where, fmt::format("a shape cannot be a \"{}\" emitter", node.type), "", "use \"area\"");
    Texture radiance = Texture::emission(node, "radiance", 1.0f, resources);
    expect_known_properties(node);
    return radiance;
}

Emitter build_emitter(const Properties& node, const SceneResources& resources) {
    expect_plugin(node);
    if (node.type == "area")
        throw input_error(node.where, "an area emitter needs a shape", "", "put it inside the shape that shines");
    Emitter emitter;
    if (node.type == "point") {
        const Eigen::Vector4d p =
            node.transform("to_world") * node.vector("position", Eigen::Vector3d::Zero()).homogeneous();
        emitter = PointEmitter{place(p.head<3>(), node.location_of(node.has("position") ? "position" : "to_world")),
                               emission(node, "intensity")};
    } else if (node.type == "directional") {
        const Eigen::Matrix4d m = node.transform("to_world");
        const Eigen::Vector3d direction = m.block<3, 3>(0, 0) * node.vector("direction", Eigen::Vector3d::UnitZ());
        emitter = DirectionalEmitter{unit(direction, node.location_of("direction")), emission(node, "irradiance")};
    } else if (node.type == "constant") {
        emitter = ConstantEmitter{emission(node, "radiance")};
    } else if (node.type == "envmap") {
        emitter = environment(node, resources);
    } else if (node.type == "projector") {
        emitter = projector(node, resources);
    } else {
        emitter = spot(node, resources);
    }
    expect_known_properties(node);
    return emitter;
}

}  // namespace patina::render
