#include "patina/coating/material_reader.h"

#include <array>

#include "patina/optics/materials.h"

namespace patina::coating {

optics::OpticalConstants read_material(const TableReader& reader, std::string_view key, const Context& context) {
    const toml::node* node = reader.node(key);
    if (!node) (void)reader.text(key);  // says that it is missing
    if (node->is_string()) {
        try {
            return optics::material(*node->value<std::string>(), context.folder);
        } catch (const Error& error) {
            throw input_error(reader.where(key), reader.path_of(key), error.what());
        }
    }
    if (!node->is_table()) reader.wrong_type(key, "material: a name, a file, or { n = 1.5, k = 0 }");

    static constexpr std::array keys{
        KeyInfo{"n", KeyType::number, "1", "", "real part of the refractive index", 1e-3, 100.0},
        KeyInfo{"k", KeyType::number, "1", "0", "imaginary part of the refractive index, absorbing when positive", 0.0,
                100.0}};
    const TableReader index(*node->as_table(), keys, reader.path_of(key), context.file);
    return optics::OpticalConstants::constant({index.number("n"), index.optional_number("k").value_or(0.0)});
}

}  // namespace patina::coating
