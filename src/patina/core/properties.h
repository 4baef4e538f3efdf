#pragma once
// A typed tree of named values with the place each came from: what a scene file becomes before anything is built from
// it.
//
// One node is one plugin of a scene: `<bsdf type="roughconductor" id="gold"> ... </bsdf>`. The reader (io/mitsuba_xml)
// fills the tree and knows no plugin; the builders (render/) query it and know no XML. Every query marks its key; what
// was never asked for is reported by expect_all_used(), so that a typo is an error with a line and a column.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Dense>

#include "patina/core/error.h"

namespace patina {

// A spectrum as written in a scene file, before it is given a meaning (reflectance, radiance, refractive index).
struct SpectrumSpec {
    enum class Kind {
        uniform,   // one value at every wavelength: values[0]
        sampled,   // values at wavelengths_nm (irregular, a file, or regular expanded to its grid)
        rgb,       // linear sRGB in values[0..2]
        blackbody  // kelvin in values[0], scale in values[1]
    };
    Kind kind = Kind::uniform;
    std::vector<double> wavelengths_nm;
    std::vector<double> values;
};

class Properties;

using PropertyValue = std::variant<bool, std::int64_t, double, std::string, Eigen::Vector3d /* point, vector */,
                                   Eigen::Matrix4d /* transform */, SpectrumSpec>;

class Properties {
  public:
    struct Entry {
        std::string name;
        PropertyValue value;
        SourceLocation where;
        mutable bool used = false;
    };
    struct Child {
        std::string name;  // attribute name="..." or "" when not given
        std::shared_ptr<const Properties> node;
        mutable bool used = false;
    };

    std::string
        category;  // "bsdf", "shape", "emitter", "sensor", "film", "sampler", "integrator", "texture", "rfilter", ...
    std::string type;  // the plugin's name
    std::string id;    // "" when not given
    SourceLocation where;
    std::vector<Entry> entries;
    std::vector<Child> children;  // in file order; a <ref> is the very node it names

    bool has(std::string_view name) const;

    // The value of `name`, converted where nothing is lost (int to float, number to uniform spectrum and back).
    // Throws Error(input) at the entry for a value of another type or, without a default, at the node for a missing
    // one.
    double number(std::string_view name) const;
    double number(std::string_view name, double fallback) const;
    std::int64_t integer(std::string_view name, std::int64_t fallback) const;
    bool boolean(std::string_view name, bool fallback) const;
    std::string string(std::string_view name) const;
    std::string string(std::string_view name, std::string_view fallback) const;
    Eigen::Vector3d vector(std::string_view name, const Eigen::Vector3d& fallback) const;
    Eigen::Matrix4d transform(std::string_view name,
                              const Eigen::Matrix4d& fallback = Eigen::Matrix4d::Identity()) const;
    std::optional<SpectrumSpec> spectrum(std::string_view name) const;

    // Where `name` stands, for errors about its value; the node's own place when it is absent.
    SourceLocation location_of(std::string_view name) const;

    // Children of one category, marked as used.
    std::vector<std::shared_ptr<const Properties>> children_of(std::string_view child_category) const;
    // The only child of a category, null when there is none; more than one is an Error(input).
    std::shared_ptr<const Properties> only_child(std::string_view child_category) const;
    // The child with the attribute name="...", null when there is none.
    std::shared_ptr<const Properties> named_child(std::string_view name) const;

    // Throws Error(input) for the first entry or child never asked for; `known` are the legal names, for the
    // suggestion.
    void expect_all_used(const std::vector<std::string>& known) const;

  private:
    const Entry* find(std::string_view name) const;
};

}  // namespace patina
