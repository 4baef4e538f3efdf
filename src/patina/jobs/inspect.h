#pragma once
// What a file is, in words: for `patina inspect`.

#include <filesystem>
#include <string>
#include <vector>

namespace patina::jobs {

struct Fact {
    std::string name, value;
};

// Tables (.h5, .pbsdf), pictures (.exr), recipes (.toml) and materials (.yml, .csv), told apart by extension.
// Throws Error(input) for other files and for files that are not what their extension says.
std::vector<Fact> inspect(const std::filesystem::path& path);

}  // namespace patina::jobs
