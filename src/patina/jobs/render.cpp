#include "patina/jobs/render.h"

#include <algorithm>
#include <cctype>
#include <mutex>

#include <fmt/format.h>

#include "patina/coating/spectral_medium.h"
#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/io/bitmap_file.h"
#include "patina/io/image_tone.h"
#include "patina/io/mesh_file.h"
#include "patina/io/mitsuba_xml.h"
#include "patina/io/png_file.h"
#include "patina/io/stokes_exr.h"
#include "patina/io/table_hdf5.h"
#include "patina/io/table_merl.h"
#include "patina/io/table_pbsdf.h"
#include "patina/jobs/render_checkpoint.h"
#include "patina/jobs/solve.h"
#include "patina/render/scene.h"
#include "patina/version.h"

namespace patina::jobs {

namespace {

template <class T, class... Ts>
constexpr bool is_one_of = (std::is_same_v<T, Ts> || ...);

namespace fs = std::filesystem;

// The spacing of wavelengths at which a scene's recipes are solved; bodies of paints vary slowly with wavelength.
constexpr int recipe_step_nm = 10;

std::shared_ptr<const brdf::MuellerTable> solve_recipe(const std::string& path, const JobControl& control) {
    const coating::Recipe recipe = coating::read_recipe(path);
    SolveRequest request;
    if (!recipe.is_wavelength_independent())
        for (int wavelength = 380; wavelength <= 780; wavelength += recipe_step_nm)
            request.wavelengths_nm.push_back(wavelength);
    request.command = fmt::format("patina solve {} --wavelengths 380:780:{}", path, recipe_step_nm);
    SolveResult result = solve(recipe, request, control);
    if (result.interrupted) throw Error(ErrorKind::interrupted, fmt::format("stopped while solving {}", path));
    return std::make_shared<const brdf::MuellerTable>(std::move(result.table));
}

std::shared_ptr<const brdf::MuellerTable> load_table(const std::string& path, const JobControl& control) {
    const std::string extension = fs::path(path).extension().string();
    if (extension == ".toml") return solve_recipe(path, control);
    if (extension == ".h5") return std::make_shared<const brdf::MuellerTable>(io::read_table_hdf5(path));
    throw input_error({path}, "neither a recipe nor a BRDF table", "recipes end in .toml, tables in .h5");
}

// Loads each file once, however many shapes and plugins name it.
template <class Value>
class Cache {
  public:
    template <class Load>
    std::shared_ptr<const Value> get(const std::string& key, const Load& load) {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<const Value>& value = values_[key];
        if (!value) value = load();
        return value;
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const Value>> values_;
};

}  // namespace

render::SceneResources scene_resources(std::vector<std::string>& warnings, const JobControl& control) {
    const auto tables = std::make_shared<Cache<brdf::MuellerTable>>();
    const auto media = std::make_shared<Cache<optics::SpectralMedium>>();
    const auto half_angle_tables = std::make_shared<Cache<brdf::HalfAngleTable>>();
    const auto merl_tables = std::make_shared<Cache<brdf::MerlTable>>();
    const auto meshes = std::make_shared<Cache<TriangleMesh>>();
    const auto bitmaps = std::make_shared<Cache<Bitmap>>();
    render::SceneResources resources;
    resources.load_brdf_table = [tables, control](const std::string& path) {
        return tables->get(path, [&] { return load_table(path, control); });
    };
    resources.load_medium = [media](const std::string& path, int layer) {
        return media->get(fmt::format("{}|{}", path, layer), [&] {
            const coating::Recipe recipe = coating::read_recipe(path);
            const bool one = recipe.is_wavelength_independent();
            return std::make_shared<const optics::SpectralMedium>(
                coating::spectral_medium(recipe, layer, 380, recipe_step_nm, one ? 1 : 400 / recipe_step_nm + 1));
        });
    };
    resources.load_half_angle_table = [half_angle_tables](const std::string& path) {
        return half_angle_tables->get(
            path, [&] { return std::make_shared<const brdf::HalfAngleTable>(io::read_table_pbsdf(path)); });
    };
    resources.load_merl_table = [merl_tables](const std::string& path) {
        return merl_tables->get(path,
                                [&] { return std::make_shared<const brdf::MerlTable>(io::read_table_merl(path)); });
    };
    resources.load_mesh = [meshes, &warnings](const std::string& path, const std::string& kind) {
        return meshes->get(path + "|" + kind, [&] {
            io::MeshFile file = io::read_mesh(path, kind);
            warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
            return std::make_shared<const TriangleMesh>(std::move(file.mesh));
        });
    };
    resources.load_bitmap = [bitmaps](const std::string& path, bool raw) {
        return bitmaps->get(path + (raw ? "|raw" : ""),
                            [&] { return std::make_shared<const Bitmap>(io::read_bitmap(path, raw)); });
    };
    return resources;
}

namespace {

// Everything that decides the picture: the scene with the files it names, solved recipes, options, the program.
class PictureIdentity {
  public:
    explicit PictureIdentity(const Properties& tree) { add_to(scene_, tree); }
    // Solved recipes name files of their own.
    void watch(render::SceneResources& resources) {
        resources.load_brdf_table = [this, load = resources.load_brdf_table](const std::string& path) {
            const auto table = load(path);
            if (fs::path(path).extension() == ".toml") add_to(scene_, *table);
            return table;
        };
    }
    RenderIdentity of(const RenderRequest& request) const {
        RenderIdentity identity{{"the scene or a file it names", scene_.hex()},
                                {"the program's version", PATINA_VERSION}};
        add_options(request.options, identity);
        if (!request.sensor.empty()) identity["--sensor"] = request.sensor;
        return identity;
    }

  private:
    Fingerprint scene_;
};

render::RenderCheckpoint checkpoint_of(const RenderRequest& request, const CheckpointFile& file,
                                       std::vector<std::string>& warnings) {
    render::RenderCheckpoint checkpoint;
    if (request.checkpoint.empty()) return checkpoint;
    checkpoint.interval_seconds = request.checkpoint_interval_s;
    checkpoint.save_finished = request.keep_checkpoint;
    if (request.resume) checkpoint.load = [&file](render::RenderState& state) { return file.load(state); };
    checkpoint.save = [&file, &warnings](const render::RenderState& state) {
        try {
            file.save(state);
        } catch (const Error& error) {
            // The picture matters more.
            warnings.push_back(error.what());
        }
    };
    return checkpoint;
}

// Surfaces with a part that sends light one way only, which no path from a lamp can be joined to the camera by.
bool shows_mirrors(const render::Scene& scene) {
    using namespace render;
    return std::ranges::any_of(scene.bsdfs, [](const Bsdf& bsdf) {
        return std::visit(
            []<class Model>(const Model&) {
                return is_one_of<Model, Dielectric, ThinDielectric, Conductor, Plastic, Paint, Dipole, LinearPolarizer,
                                 Retarder, CircularPolarizer, Mask, Null>;
            },
            bsdf.model);
    });
}

// Lamps of no power or that shine away, a camera inside of something: what nobody renders on purpose.
bool is_black(const StokesImage& image) {
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        for (int bin = 0; bin < image.bin_count(); ++bin)
            if (image.stokes(pixel, bin)[0] != 0) return false;
    return true;
}

}  // namespace

render::Pictures render_scene(const RenderRequest& request, const JobControl& control) {
    std::vector<std::string> warnings;
    const std::shared_ptr<const Properties> tree = io::read_mitsuba_scene(request.scene, request.variables);
    PictureIdentity identity(*tree);
    render::SceneResources resources = scene_resources(warnings, control);
    identity.watch(resources);
    const std::shared_ptr<const render::Scene> scene = render::build_scene(*tree, resources, request.sensor);
    const CheckpointFile file(request.checkpoint, identity.of(request));
    render::Pictures pictures =
        render::render_parts(*scene, request.options, control, checkpoint_of(request, file, warnings));
    const bool stopped = pictures.whole.metadata.contains("stopped");
    if (!request.checkpoint.empty() && !stopped && !request.keep_checkpoint) file.remove();
    const std::shared_ptr<const Properties> node = tree->only_child("integrator");
    // `aov` hides what it wraps; Stokes channels are asked for wherever `stokes` stands.
    std::shared_ptr<const Properties> named = node;
    while (named && named->type == "aov") named = named->only_child("integrator");
    const std::string integrator = request.options.integrator.value_or(named ? named->type : "path");
    if ((integrator == "light" || integrator == "ptracer") && shows_mirrors(*scene))
        warnings.emplace_back(
            "light tracing leaves out what mirrors, glass and other surfaces without a spread show the camera; "
            "integrator bidirectional has it");
    if (!stopped && is_black(pictures.whole))
        warnings.emplace_back(
            "the picture is black: no lamp's light reached the camera; look at the lamps' power and outsides, at what "
            "the camera stands in, and at the integrator's max_depth and hide_emitters");
    const auto add_provenance = [&](StokesImage& image) {
        image.metadata["command"] = request.command;
        image.metadata["scene"] = request.scene.string();
        image.metadata["integrator"] = integrator;
        image.metadata["software"] = std::string("patina ") + PATINA_VERSION;
        for (size_t i = 0; i < warnings.size(); ++i) image.metadata[fmt::format("warning_{:02}", i)] = warnings[i];
    };
    add_provenance(pictures.whole);
    for (auto& [name, image] : pictures.parts) add_provenance(image);
    return pictures;
}

fs::path part_path(const fs::path& path, const std::string& name) {
    const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-';
    });
    if (!plain)
        throw Error(ErrorKind::usage, fmt::format("\"{}\" cannot name a picture: use letters, digits, _ and -", name));
    fs::path part = path;
    return part.replace_extension("." + name + path.extension().string());
}

void check_picture_output(const fs::path& path) {
    if (path.extension() != ".exr")
        throw Error(ErrorKind::usage,
                    fmt::format("-o {}: the picture is an OpenEXR file, its name ends in .exr", path.string()));
    expect_writable(path);
}

std::vector<std::string> write_picture(const fs::path& path, const StokesImage& image, bool stokes_rgb, bool png) {
    io::StokesExrOptions options;
    const auto integrator = image.metadata.find("integrator");
    options.stokes_rgb = stokes_rgb || (integrator != image.metadata.end() && integrator->second == "stokes");
    io::write_stokes_exr(path, image, options);
    std::vector<std::string> written{path.string()};
    if (png) {
        fs::path preview = path;
        preview.replace_extension(".png");
        io::write_png(preview, io::tone_map(image));
        written.push_back(preview.string());
    }
    return written;
}

}  // namespace patina::jobs
