#pragma once
// The laws of reflection tried on models: those of a scene, or one by its name.

#include <filesystem>
#include <string>
#include <vector>

#include "patina/core/progress.h"
#include "patina/render/bsdf_checks.h"

namespace patina::jobs {

// Every model of a scene file; its recipes are solved first.
std::vector<render::BsdfReport> check_scene(const std::filesystem::path& scene, const JobControl& control = {});

// A model with its defaults, or with its properties as XML: `<float name="alpha" value="0.3"/>`.
std::vector<render::BsdfReport> check_model(const std::string& type, const std::string& properties,
                                            const JobControl& control = {});

}  // namespace patina::jobs
