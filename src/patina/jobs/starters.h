#pragma once
// The commented files that `patina new` writes.

#include <string>

namespace patina::jobs {

// A paint recipe with every key that most users touch; the rest is listed with its unit and default.
std::string starter_recipe();

// A scene with one painted sphere under an area light.
std::string starter_scene();

}  // namespace patina::jobs
