#include "patina/render/bsdfs/normal_map.h"

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/bsdf_set.h"
#include "patina/render/plugins.h"

namespace patina::render {

namespace {

void to_outer(ScatteringMatrix& m, const Frame& frame) {
    if (m.form == ScatteringMatrix::Form::depolarizing) return;
    m.x_in = frame.to_world(m.x_in);
    m.x_out = frame.to_world(m.x_out);
}

// The picture and the model that both plugins take.
std::shared_ptr<const Bitmap> read_data(const Properties& node, const BsdfBuilder& builder, NormalMap& map) {
    const auto models = node.children_of("bsdf");
    // A bumpmap's texture may have any name, as in Mitsuba.
    const auto named = node.named_child(node.type);
    const auto texture = named ? named : node.only_child("texture");
    if (models.size() != 1 || !texture)
        throw input_error(node.where, fmt::format("{0} takes one model and one texture named \"{0}\"", node.type));
    const TexturePicture picture = read_picture(*texture, *builder.resources, true);
    if (!picture.raw)
        throw input_error(texture->location_of("raw"), "the picture is data, not colour", "", "set raw to true");
    const int channels = node.type == "normalmap" ? 3 : 1;
    if (picture.image->channel_count() < channels)
        throw input_error(texture->location_of("filename"), fmt::format("a {} needs {} channels", node.type, channels));
    for (float value : picture.image->data)
        if (!std::isfinite(value))
            throw input_error(texture->location_of("filename"), "the picture holds values that are not finite");
    map.model = builder.nested(models.front());
    map.grid = picture.grid;
    map.normals.reserve(picture.grid.size());
    return picture.image;
}

}  // namespace

Frame NormalMap::frame_at(const Vec2& uv) const {
    const Vec3 sum = grid.at(uv).blend([&](std::size_t texel) { return normals[texel]; });
    return Frame(sum.normalized(), Vec3::UnitX());
}

bool NormalMap::sample(const ShadingPoint& point, const Vec3& outgoing, float u, const Vec2& u2,
                       BsdfSample& sample) const {
    const Frame frame = frame_at(point.uv);
    const Vec3 inner = frame.to_local(outgoing);
    if (inner.z() * outgoing.z() <= 0) return false;
    if (!bsdf_sample(nested_bsdf(point, model), point, inner, u, u2, sample)) return false;
    const Vec3 incident = frame.to_world(sample.incident);
    if (incident.z() * sample.incident.z() <= 0) return false;
    // What light that runs the other way gains where its beam is wider before the turned normal than after (Veach
    // 1997, eq. 5.19).
    sample.adjoint *= std::abs(inner.z() * incident.z() / (outgoing.z() * sample.incident.z()));
    sample.incident = incident;
    to_outer(sample.weight, frame);
    return true;
}

bool NormalMap::evaluate(const ShadingPoint& point, const Vec3& outgoing, const Vec3& incident,
                         BsdfValue& value) const {
    const Frame frame = frame_at(point.uv);
    const Vec3 inner_o = frame.to_local(outgoing), inner_i = frame.to_local(incident);
    if (inner_o.z() * outgoing.z() <= 0 || inner_i.z() * incident.z() <= 0) return false;
    if (!bsdf_evaluate(nested_bsdf(point, model), point, inner_o, inner_i, value)) return false;
    to_outer(value.f, frame);
    return true;
}

PluginDescriptor NormalMap::describe() {
    return {"bsdf",
            "normalmap",
            "Another model with the normals of a picture; takes one model and a raw bitmap.",
            {{"normalmap", "bitmap texture", "", "", "", "normals in tangent space, (n + 1)/2"}}};
}

NormalMap NormalMap::build(const Properties& node, const BsdfBuilder& builder) {
    NormalMap map;
    const auto image = read_data(node, builder, map);
    for (int y = 0; y < map.grid.height; ++y)
        for (int x = 0; x < map.grid.width; ++x) {
            const float* texel = image->pixel(x, y);
            const Vec3 n = 2 * Vec3(texel[0], texel[1], texel[2]) - Vec3::Ones();
            // A normal that looks inwards is none.
            map.normals.push_back(n.z() > 1e-3f * n.norm() ? Vec3(n.normalized()) : Vec3::UnitZ());
        }
    return map;
}

PluginDescriptor BumpMap::describe() {
    return {"bsdf",
            "bumpmap",
            "Another model with the normals of a relief; takes one model and a raw bitmap of heights.",
            {{"bumpmap", "bitmap texture", "sides of the texture", "", "", "heights"},
             {"scale", "number", "", "1", "", "factor on the heights"},
             {"mirrored", "boolean", "", "as the shape has it", "",
              "u, v and normal are a left-handed system, as on spheres and flipped OBJ files"}}};
}

BumpMap BumpMap::build(const Properties& node, const BsdfBuilder& builder) {
    BumpMap map;
    const auto image = read_data(node, builder, map);
    const double scale = node.number("scale", 1.0);
    if (!std::isfinite(scale)) throw input_error(node.location_of("scale"), "scale is not finite");
    const auto height = [&](int x, int y) {
        return static_cast<float>(scale) *
               image->pixel((x + map.grid.width) % map.grid.width, (y + map.grid.height) % map.grid.height)[0];
    };
    // Central differences; v grows with the rows, to the left of u about the normal or to its right.
    const float left = node.boolean("mirrored", false) ? -0.5f : 0.5f;
    for (int y = 0; y < map.grid.height; ++y)
        for (int x = 0; x < map.grid.width; ++x)
            map.normals.push_back(Vec3(-0.5f * map.grid.width * (height(x + 1, y) - height(x - 1, y)),
                                       -left * map.grid.height * (height(x, y + 1) - height(x, y - 1)), 1)
                                      .normalized());
    return map;
}

}  // namespace patina::render
