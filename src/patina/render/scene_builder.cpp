#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/render/instance_builder.h"
#include "patina/render/mesh_attribute.h"
#include "patina/render/plugins.h"
#include "patina/render/scene.h"
#include "patina/render/scene_white.h"
#include "patina/render/shape_builder.h"

namespace patina::render {

namespace {

class SceneBuilder {
  public:
    SceneBuilder(const Properties& root, const SceneResources& resources, const std::string& sensor)
        : root_(root),
          chosen_sensor_(sensor),
          resources_(resources),
          bsdf_builder_{&resources_, [this](const std::shared_ptr<const Properties>& node) { return bsdf_index(node); },
                        &scene_->notes} {}

    std::shared_ptr<const Scene> build() {
        scene_->matching = std::make_unique<const ColourMatching>();
        for (const auto& node : root_.children_of("sensor")) sensors_.push_back({node, -1});
        if ((scene_->integrator_node = root_.only_child("integrator"))) build_integrator(*scene_->integrator_node);
        for (const auto& node : root_.children_of("bsdf"))
            if (!reads_attributes(*node)) bsdf_index(node);
        for (const auto& node : root_.children_of("medium")) medium_index(node);
        for (const auto& node : root_.children_of("shape"))
            if (!instances_.add(*node)) build_shape(*node, -1);
        if (sensors_.empty()) throw input_error(root_.where, "the scene has no sensor");
        for (const auto& node : root_.children_of("emitter")) {
            states_.push_back(build_polarization(*node, node->transform("to_world")));
            emitters_.push_back(build_emitter(*node, resources_));
        }
        root_.children_of("texture");  // named ones, built where they are referenced
        root_.expect_all_used({"integrator", "sensor", "bsdf", "shape", "emitter", "texture", "medium"});
        if (emitters_.empty())
            throw input_error(root_.where, "the scene is dark", "it has no emitter",
                              "add one, for instance \"constant\"");
        scene_->geometry.needs_uv = any_texture(root_);
        choose_sensor();
        scene_->geometry.commit();
        build_camera();
        scene_->notes["white"] = lit_by_daylight(root_) ? "D65" : "E";
        scene_->lights = Lights(std::move(emitters_), scene_->geometry, std::move(states_));
        return scene_;
    }

  private:
    void choose_sensor() {
        std::tie(scene_->sensor_node, scene_->sensor_shape) = chosen_sensor();
        const Shutter shutter = build_shutter(*scene_->sensor_node);
        instances_.place(shutter.open_s, shutter.close_s);
    }

    void build_camera() {
        const Properties& node = *scene_->sensor_node;
        expect_plugin(node);
        if (const auto film = node.only_child("film")) {
            scene_->film = build_film(*film);
        } else {
            FilmSettings& settings = scene_->film;
            std::tie(settings.width, settings.height) = default_film_size(node);
            settings.crop_width = settings.width, settings.crop_height = settings.height;
            settings.bin_edges_nm = FilmSettings::default_bins();
        }
        if (const auto sampler = node.only_child("sampler")) {
            expect_plugin(*sampler);
            const std::int64_t count = sampler->integer("sample_count", 16);
            if (count < 1 || count > (1 << 30))
                throw input_error(sampler->location_of("sample_count"), "sample_count out of range",
                                  fmt::format("it is {}", count), "keep it between 1 and 1073741824");
            scene_->samples_per_pixel = static_cast<int>(count);
            scene_->seed = static_cast<std::uint64_t>(sampler->integer("seed", 0));
            sampler->boolean("jitter", true);
            expect_known_properties(*sampler);
        }
        const Sensor sensor =
            build_sensor(node, scene_->film.width, scene_->film.height, scene_->geometry, scene_->sensor_shape);
        // A meter's mean is over uniform places: no filter reaches over the edges.
        if (sensor.is_meter()) scene_->film.filter = PixelFilter();
        scene_->camera_medium = medium_index(node.only_child("medium"));
        expect_known_properties(node);
    }

    std::pair<std::shared_ptr<const Properties>, int> chosen_sensor() const {
        if (chosen_sensor_.empty()) return sensors_.front();
        std::vector<std::string> names;
        for (std::size_t i = 0; i < sensors_.size(); ++i) {
            const std::string& id = sensors_[i].first->id;
            if (chosen_sensor_ == id || chosen_sensor_ == std::to_string(i)) return sensors_[i];
            names.push_back(id.empty() ? std::to_string(i) : id);
        }
        throw input_error(root_.where, fmt::format("the scene has no sensor \"{}\"", chosen_sensor_), "",
                          did_you_mean(chosen_sensor_, names));
    }

    int bsdf_index(const std::shared_ptr<const Properties>& node) {
        if (const auto known = bsdf_of_node_.find(node.get()); known != bsdf_of_node_.end()) {
            if (known->second < 0) throw input_error(node->where, fmt::format("bsdf \"{}\" contains itself", node->id));
            return known->second;
        }
        bsdf_of_node_[node.get()] = -1;
        Bsdf bsdf = build_bsdf(*node, bsdf_builder_);
        scene_->bsdfs.push_back(std::move(bsdf));
        return bsdf_of_node_[node.get()] = static_cast<int>(scene_->bsdfs.size()) - 1;
    }

    // Null: the vacuum.
    int medium_index(const std::shared_ptr<const Properties>& node) {
        if (!node) return vacuum;
        const auto [known, is_new] = medium_of_node_.try_emplace(node.get(), static_cast<int>(scene_->media.size()));
        if (is_new) scene_->media.push_back(build_medium(*node, {&resources_, &scene_->notes}));
        return known->second;
    }

    // The child `side`, which must be a medium.
    int side_medium(const Properties& shape, const char* side) {
        const auto node = shape.named_child(side);
        if (node && node->category != "medium")
            throw input_error(node->where, fmt::format("the {} of a shape is a medium", side),
                              fmt::format("this is a {}", node->category));
        return medium_index(node);
    }

    int default_bsdf() {
        if (default_bsdf_ < 0) {
            default_bsdf_ = static_cast<int>(scene_->bsdfs.size());
            scene_->bsdfs.push_back({Diffuse{Texture(Spectrum(0.5f))}});
        }
        return default_bsdf_;
    }

    void build_shape(const Properties& node, int group) {
        const int index = append_shape(node, resources_, scene_->geometry, group);
        resources_.mesh = scene_->geometry.shapes[index].is_mesh ? scene_->geometry.meshes.back().mesh : nullptr;
        for (const char* lamp_or_meter : {"emitter", "sensor"})
            if (const auto child = group >= 0 ? node.only_child(lamp_or_meter) : nullptr)
                throw input_error(child->where,
                                  fmt::format("no {} can stand in what moves or is copied", child->category));
        auto material = node.only_child("bsdf");
        if (material && left_handed(node) && holds_relief(*material)) material = mirrored(material);
        if (material && reads_attributes(*material)) material = copied(material);
        scene_->geometry.shapes[index].bsdf = material ? bsdf_index(material) : default_bsdf();
        scene_->geometry.shapes[index].interior = side_medium(node, "interior");
        scene_->geometry.shapes[index].exterior = side_medium(node, "exterior");
        if (const auto emitter = node.only_child("emitter")) {
            scene_->geometry.shapes[index].emitter = static_cast<int>(emitters_.size());
            states_.push_back(build_polarization(*emitter, node.transform("to_world")));
            Texture radiance = build_area_radiance(*emitter, resources_);
            auto table = LampTable::of(scene_->geometry, index, radiance);
            emitters_.push_back(AreaEmitter{index, std::move(radiance), std::move(table)});
        }
        for (const auto& sensor : node.children_of("sensor")) sensors_.push_back({sensor, index});
        expect_known_properties(node);
    }

    // Do u, v and the normal of a shape make a left-handed system? Reliefs want to know.
    static bool left_handed(const Properties& shape) {
        if (shape.type == "obj" || shape.type == "ply" || shape.type == "serialized")
            return shape.boolean("flip_tex_coords", shape.type == "obj");
        return shape.type == "sphere" || shape.type == "cube";
    }
    static bool holds_relief(const Properties& model) {
        return model.type == "bumpmap" ||
               std::any_of(model.children.begin(), model.children.end(), [](const auto& child) {
                   return child.node->category == "bsdf" && holds_relief(*child.node);
               });
    }
    // The same model with its reliefs mirrored, one copy for all shapes.
    std::shared_ptr<const Properties> mirrored(const std::shared_ptr<const Properties>& model) {
        auto& copy = mirrored_[model.get()];
        if (copy) return copy;
        auto changed = std::make_shared<Properties>(*model);
        if (model->type == "bumpmap" && !model->has("mirrored"))
            changed->entries.push_back({"mirrored", true, model->where});
        for (auto& child : changed->children)
            if (child.node->category == "bsdf") child.node = mirrored(child.node);
        return copy = changed;
    }

    // The same model for one mesh alone, whose attributes it reads.
    std::shared_ptr<const Properties> copied(const std::shared_ptr<const Properties>& model) {
        auto copy = std::make_shared<Properties>(*model);
        for (auto& child : copy->children)
            if (child.node->category == "bsdf") child.node = copied(child.node);
        own_models_.push_back(copy);
        return copy;
    }

    static bool any_texture(const Properties& node) {
        for (const auto& child : node.children)
            if (child.node->category == "texture" || any_texture(*child.node)) return true;
        return false;
    }

    const Properties& root_;
    const std::string& chosen_sensor_;
    std::vector<std::pair<std::shared_ptr<const Properties>, int>> sensors_;  // with the shapes they stand in
    SceneResources resources_;
    std::shared_ptr<Scene> scene_ = std::make_shared<Scene>();
    BsdfBuilder bsdf_builder_;
    std::map<const Properties*, int> bsdf_of_node_;  // -1 while being built
    std::map<const Properties*, int> medium_of_node_;
    std::map<const Properties*, std::shared_ptr<const Properties>> mirrored_;
    std::vector<std::shared_ptr<const Properties>> own_models_;  // kept, as models are known by their address
    int default_bsdf_ = -1;
    InstanceBuilder instances_{scene_->geometry,
                               [this](const Properties& node, int group) { build_shape(node, group); }};
    std::vector<Emitter> emitters_;
    std::vector<EmitterPolarization> states_;  // of the emitters
};

}  // namespace

std::shared_ptr<const Scene> build_scene(const Properties& root, const SceneResources& resources,
                                         const std::string& sensor) {
    return SceneBuilder(root, resources, sensor).build();
}

}  // namespace patina::render
