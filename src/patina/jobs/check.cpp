#include "patina/jobs/check.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/io/mitsuba_xml.h"
#include "patina/jobs/render.h"

namespace patina::jobs {

std::vector<render::BsdfReport> check_scene(const std::filesystem::path& scene, const JobControl& control) {
    std::vector<std::string> warnings;
    const auto tree = io::read_mitsuba_scene(scene);
    auto reports = render::check_bsdfs(*tree, scene_resources(warnings, control));
    if (reports.empty()) throw input_error({scene.string()}, "the scene has no bsdf to check");
    return reports;
}

std::vector<render::BsdfReport> check_model(const std::string& type, const std::string& properties,
                                            const JobControl& control) {
    if (type.empty() ||
        !std::all_of(type.begin(), type.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
        throw Error(ErrorKind::usage, fmt::format("\"{}\" is no name of a model", type));
    std::vector<std::string> warnings;
    const auto tree = io::parse_mitsuba_scene(
        fmt::format("<scene version=\"3.0.0\"><bsdf type=\"{}\">{}</bsdf></scene>", type, properties), "--bsdf");
    return render::check_bsdfs(*tree, scene_resources(warnings, control));
}

}  // namespace patina::jobs
