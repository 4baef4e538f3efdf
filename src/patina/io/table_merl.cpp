#include "patina/io/table_merl.h"

#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"
#include "patina/core/files.h"

namespace patina::io {

static_assert(std::endian::native == std::endian::little, "MERL files are little-endian");

using brdf::MerlTable;

namespace {

constexpr std::int32_t dimensions[3] = {MerlTable::theta_h_count, MerlTable::theta_d_count, MerlTable::phi_d_count};
constexpr double stored_unit[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

}  // namespace

void write_table_merl(const MerlTable& table, const std::filesystem::path& path) {
    PATINA_EXPECT(table.rgb.size() == 3 * MerlTable::plane_size);
    std::string bytes(reinterpret_cast<const char*>(dimensions), sizeof dimensions);
    bytes.resize(sizeof dimensions + 8 * table.rgb.size());
    for (std::size_t k = 0; k < table.rgb.size(); ++k) {
        const double stored = table.rgb[k] / stored_unit[k / MerlTable::plane_size];
        std::memcpy(bytes.data() + sizeof dimensions + 8 * k, &stored, 8);
    }
    write_text_file(path, bytes);
}

MerlTable read_table_merl(const std::filesystem::path& path) {
    const std::string bytes = read_text_file(path), file = path.string();
    std::int32_t found[3] = {};
    if (bytes.size() >= sizeof found) std::memcpy(found, bytes.data(), sizeof found);
    if (!std::equal(found, found + 3, dimensions))
        throw input_error({file},
                          fmt::format("not a MERL BRDF: its grid is {} x {} x {}", found[0], found[1], found[2]),
                          "the database's is 90 x 90 x 180");
    const std::size_t expected = sizeof dimensions + 8 * 3 * MerlTable::plane_size;
    if (bytes.size() != expected)
        throw input_error({file}, fmt::format("the file has {} bytes", bytes.size()),
                          fmt::format("a MERL BRDF has {}", expected));
    MerlTable table;
    table.rgb.resize(3 * MerlTable::plane_size);
    for (std::size_t k = 0; k < table.rgb.size(); ++k) {
        double stored;
        std::memcpy(&stored, bytes.data() + sizeof dimensions + 8 * k, 8);
        if (!std::isfinite(stored)) throw input_error({file}, fmt::format("value {} is not finite", k));
        table.rgb[k] = stored * stored_unit[k / MerlTable::plane_size];
    }
    return table;
}

}  // namespace patina::io
