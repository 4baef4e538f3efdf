#pragma once
// A scene file in, a picture with polarization out: reads the files a scene names and solves the recipes it names.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "patina/core/progress.h"
#include "patina/core/stokes_image.h"
#include "patina/render/render.h"

namespace patina::jobs {

struct RenderRequest {
    std::filesystem::path scene;
    render::RenderOptions options;
    std::map<std::string, std::string> variables;  // values for the scene's <default> names
    std::string command;                           // for provenance
    std::string sensor;                            // of several, by id or number; "" is the first

    // What will be written: an Error(input) when the scene names one of these files, as a texture for instance.
    std::vector<std::filesystem::path> outputs;

    // Where the state is kept every so often and when stopped; removed when the picture is done. Empty: nowhere.
    std::filesystem::path checkpoint;
    double checkpoint_interval_s = 60;
    bool keep_checkpoint = false;  // also when the picture is done, for more samples to be added
    bool resume = false;           // go on with what the checkpoint holds, if it is there
};

// Files for the renderer; each is loaded, and each recipe solved, once. What was repaired in a mesh is said in
// `warnings`, which must outlive the resources.
render::SceneResources scene_resources(std::vector<std::string>& warnings, const JobControl& control = {});

// The picture, and the parts that the options ask for. Throws Error(input) when asked to resume the checkpoint of
// another picture: the scene, a file it names, an option or the program's version differs. A checkpoint that cannot be
// written is a warning in the metadata.
render::Pictures render_scene(const RenderRequest& request, const JobControl& control = {});

// Throws Error(usage) unless the name ends in .exr, before anything long is started.
void check_picture_output(const std::filesystem::path& path);

// Where a part is written: OUT.name.exr beside OUT.exr. Throws Error(usage) for names that are no part of a file name.
std::filesystem::path part_path(const std::filesystem::path& path, const std::string& name);

// Writes the EXR and, if asked, a PNG of the same name; returns the names written. Mitsuba's channels are written when
// asked for, and of a scene whose integrator is `stokes`.
std::vector<std::string> write_picture(const std::filesystem::path& path, const StokesImage& image, bool stokes_rgb,
                                       bool png);

}  // namespace patina::jobs
