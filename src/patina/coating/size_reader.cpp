#include "patina/coating/size_reader.h"

#include <fmt/format.h>

namespace patina::coating {

namespace {

using optics::SizeShape;

// One distribution: its name, its own keys, and how it is read from them.
struct ShapeReader {
    std::string_view name;
    std::vector<std::string_view> keys;
    SizeShape (*read)(const TableReader&);
};

const std::vector<ShapeReader>& shape_readers() {
    using R = TableReader;
    static const std::vector<ShapeReader> readers{
        {"mono", {"radius_um"}, [](const R& r) -> SizeShape { return optics::Monodisperse{r.number("radius_um")}; }},
        {"lognormal",
         {"median_radius_um", "sigma_g"},
         [](const R& r) -> SizeShape {
             return optics::LogNormal{r.number("median_radius_um"), r.number("sigma_g")};
         }},
        {"gamma",
         {"effective_radius_um", "effective_variance"},
         [](const R& r) -> SizeShape {
             return optics::Gamma{r.number("effective_radius_um"), r.number("effective_variance")};
         }},
        {"modified-gamma",
         {"alpha", "gamma", "mode_radius_um"},
         [](const R& r) -> SizeShape {
             return optics::ModifiedGamma{r.number("alpha"), r.number("gamma"), r.number("mode_radius_um")};
         }},
        {"power-law",
         {"exponent", "min_radius_um", "max_radius_um"},
         [](const R& r) -> SizeShape {
             return optics::PowerLaw{r.number("exponent"), r.number("min_radius_um"), r.number("max_radius_um")};
         }},
        {"rosin-rammler",
         {"scale_radius_um", "spread"},
         [](const R& r) -> SizeShape {
             return optics::RosinRammler{r.number("scale_radius_um"), r.number("spread")};
         }},
        {"histogram",
         {"edges_um", "fractions"},
         [](const R& r) -> SizeShape {
             return optics::Histogram{r.numbers("edges_um"), r.numbers("fractions")};
         }},
    };
    return readers;
}

const ShapeReader& chosen_reader(const TableReader& reader) {
    std::vector<std::string> names;
    for (const ShapeReader& shape : shape_readers()) names.emplace_back(shape.name);
    (void)reader.text("distribution");  // says that it is missing
    const std::string name = reader.choice("distribution", names);
    return *std::find_if(shape_readers().begin(), shape_readers().end(),
                         [&](const ShapeReader& shape) { return shape.name == name; });
}

}  // namespace

optics::SizeDistribution read_size_distribution(const TableReader& reader) {
    const ShapeReader& chosen = chosen_reader(reader);
    for (const ShapeReader& other : shape_readers())
        if (&other != &chosen)
            reader.forbid(other.keys, fmt::format("it belongs to distribution = \"{}\"", other.name));

    optics::SizeDistribution distribution{chosen.read(reader)};
    const std::string weighting = reader.choice("weighting", {"number", "area", "volume"});
    if (weighting == "area") distribution.weighting = optics::SizeWeighting::area;
    if (weighting == "volume") distribution.weighting = optics::SizeWeighting::volume;
    optics::validate(distribution, reader.where());
    return distribution;
}

}  // namespace patina::coating
