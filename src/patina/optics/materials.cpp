#include "patina/optics/materials.h"

#include <algorithm>
#include <map>

#include <embedded_materials.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "patina/core/contract.h"
#include "patina/optics/optical_constants_file.h"

namespace patina::optics {

namespace {

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

// Mean over random orientations of a uniaxial crystal, of n and of k alike.
OpticalConstants orientation_mean(const std::string& name, const OpticalConstants& ordinary,
                                  const OpticalConstants& extraordinary) {
    return OpticalConstants(
        name, ordinary.citation(), std::max(ordinary.wavelength_min_nm(), extraordinary.wavelength_min_nm()),
        std::min(ordinary.wavelength_max_nm(), extraordinary.wavelength_max_nm()),
        ordinary.k_known() && extraordinary.k_known(), [ordinary, extraordinary](double wavelength_nm) {
            return (2.0 * ordinary.at(wavelength_nm) + extraordinary.at(wavelength_nm)) / 3.0;
        });
}

// The parsed data, made once at the first use and never changed.
class Library {
  public:
    Library() {
        std::map<std::string, std::string_view, std::less<>> texts;
        for (const EmbeddedFile& file : embedded_materials()) texts.emplace(file.name, file.text);
        const YAML::Node entries = YAML::Load(std::string(texts.at("library.yml")));

        // Read every material that has a file, then mean those that are means.
        std::map<std::string, OpticalConstantsFile> data;
        for (const YAML::Node& entry : entries) {
            const auto name = entry["name"].as<std::string>();
            if (entry["mean_of"]) continue;
            const std::string file = name + ".yml";
            data.emplace(name, parse_optical_constants_yaml(texts.at(file), file, name));
        }
        for (const YAML::Node& entry : entries) {
            const YAML::Node mean = entry["mean_of"];
            if (!mean) continue;
            const auto name = entry["name"].as<std::string>();
            const OpticalConstantsFile& ordinary = data.at(mean[0].as<std::string>());
            const OpticalConstantsFile& extraordinary = data.at(mean[1].as<std::string>());
            data.emplace(name, OpticalConstantsFile{orientation_mean(name, ordinary.constants, extraordinary.constants),
                                                    "Orientation mean (2 n_o + n_e)/3. Ordinary: " + ordinary.comments +
                                                        " Extraordinary: " + extraordinary.comments});
        }
        for (const YAML::Node& entry : entries) add(entry, data.at(entry["name"].as<std::string>()));
    }

    const std::vector<MaterialInfo>& infos() const { return infos_; }

    const OpticalConstants& find(std::string_view name, const SourceLocation& where) const {
        std::vector<size_t> found = matches([&](const std::string& known) { return known == name; });
        if (found.empty()) found = matches([&](const std::string& known) { return lower(known) == lower(name); });
        if (found.size() == 1) return constants_[found[0]];

        std::vector<std::string> names;
        if (found.empty()) {
            for (const MaterialInfo& info : infos_) {
                names.push_back(info.name);
                names.insert(names.end(), info.aliases.begin(), info.aliases.end());
            }
            const std::string hint = did_you_mean(name, names, false);
            throw input_error(where, fmt::format("unknown material \"{}\"", name.substr(0, 64)), {},
                              hint.empty() ? "give a built-in name or a file (.yml, .yaml, .csv)" : hint);
        }
        for (size_t i : found) names.push_back(fmt::format("{} ({})", infos_[i].name, infos_[i].description));
        throw input_error(where, fmt::format("the material \"{}\" is ambiguous", name),
                          fmt::format("it may be {}", fmt::join(names, " or ")), "name one of them");
    }

  private:
    void add(const YAML::Node& entry, const OpticalConstantsFile& file) {
        const OpticalConstants& c = file.constants;
        MaterialInfo info{c.name(),
                          {},
                          entry["description"].as<std::string>(),
                          c.citation(),
                          file.comments,
                          c.wavelength_min_nm(),
                          c.wavelength_max_nm(),
                          c.k_known()};
        for (const YAML::Node& alias : entry["aliases"]) info.aliases.push_back(alias.as<std::string>());
        infos_.push_back(std::move(info));
        constants_.push_back(c);
    }

    // The materials with a name that satisfies the predicate, or else those with such an alias.
    template <class Predicate>
    std::vector<size_t> matches(Predicate predicate) const {
        std::vector<size_t> by_name, by_alias;
        for (size_t i = 0; i < infos_.size(); ++i) {
            if (predicate(infos_[i].name)) by_name.push_back(i);
            if (std::ranges::any_of(infos_[i].aliases, predicate)) by_alias.push_back(i);
        }
        return by_name.empty() ? by_alias : by_name;
    }

    std::vector<MaterialInfo> infos_;
    std::vector<OpticalConstants> constants_;
};

const Library& library() {
    static const Library instance;
    return instance;
}

}  // namespace

const std::vector<MaterialInfo>& builtin_materials() {
    return library().infos();
}

std::vector<MaterialInfo> search_builtin_materials(std::string_view words) {
    std::vector<MaterialInfo> result;
    const std::string wanted = lower(words);
    for (const MaterialInfo& info : builtin_materials()) {
        const std::string text = fmt::format("{}\n{}\n{}\n{}\n{}", info.name, fmt::join(info.aliases, "\n"),
                                             info.description, info.citation, info.comments);
        if (lower(text).find(wanted) != std::string::npos) result.push_back(info);
    }
    return result;
}

const OpticalConstants& builtin_material(std::string_view name, const SourceLocation& where) {
    return library().find(name, where);
}

OpticalConstants material(std::string_view spec, const std::filesystem::path& base_folder,
                          const SourceLocation& where) {
    const std::filesystem::path path(spec);
    const std::string extension = path.extension().string();
    const bool is_file = extension == ".yml" || extension == ".yaml" || extension == ".csv";
    if (!is_file) return builtin_material(spec, where);
    return read_optical_constants(path.is_absolute() ? path : base_folder / path).constants;
}

}  // namespace patina::optics
