#include "patina/io/table_pbsdf.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include "patina/core/error.h"
#include "patina/core/files.h"

namespace patina::io {

static_assert(std::endian::native == std::endian::little, "tensor files are little-endian");

namespace {

constexpr std::string_view magic{"tensor_file\0", 12};
constexpr std::uint64_t alignment = 8;
enum class TensorType : std::uint8_t { uint16 = 3, float32 = 10 };

std::size_t size_of(TensorType type) {
    return type == TensorType::uint16 ? 2 : 4;
}

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

struct OutgoingField {
    std::string name;
    TensorType type;
    std::vector<std::uint64_t> shape;
    std::string data;
};

template <class T>
OutgoingField field(std::string name, TensorType type, std::vector<std::uint64_t> shape, const std::vector<T>& values) {
    return {std::move(name), type, std::move(shape),
            std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T))};
}

OutgoingField axis_field(std::string name, const std::vector<double>& values) {
    return field(std::move(name), TensorType::float32, {1, values.size()},
                 std::vector<float>(values.begin(), values.end()));
}

std::uint64_t aligned(std::uint64_t offset) {
    return (offset + alignment - 1) / alignment * alignment;
}

std::string tensor_file(const std::vector<OutgoingField>& fields) {
    // The header's length fixes where the data begins.
    std::uint64_t offset = magic.size() + 2 + 4;
    for (const OutgoingField& f : fields) offset += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();

    std::string bytes(magic);
    bytes += {1, 0};
    append(bytes, static_cast<std::uint32_t>(fields.size()));
    for (const OutgoingField& f : fields) {
        append(bytes, static_cast<std::uint16_t>(f.name.size()));
        bytes += f.name;
        append(bytes, static_cast<std::uint16_t>(f.shape.size()));
        append(bytes, static_cast<std::uint8_t>(f.type));
        offset = aligned(offset);
        append(bytes, offset);
        for (std::uint64_t extent : f.shape) append(bytes, extent);
        offset += f.data.size();
    }
    for (const OutgoingField& f : fields) {
        bytes.resize(aligned(bytes.size()), '\0');
        bytes += f.data;
    }
    return bytes;
}

// Reads values one after the other, never beyond the end.
class Cursor {
  public:
    Cursor(const std::string& bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

    template <class T>
    T next() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string_view take(std::size_t count) {
        if (count > bytes_.size() - position_)
            throw input_error({file_}, "the file is truncated",
                              fmt::format("its header ends at byte {}", bytes_.size()));
        position_ += count;
        return std::string_view(bytes_).substr(position_ - count, count);
    }

  private:
    const std::string& bytes_;
    std::string file_;
    std::size_t position_ = 0;
};

struct IncomingField {
    TensorType type;
    std::vector<std::uint64_t> shape;
    std::uint64_t count;
    std::string_view data;
};
using IncomingFields = std::map<std::string, IncomingField>;

IncomingField read_field(Cursor& cursor, const std::string& bytes, const std::string& file, const std::string& name) {
    IncomingField result;
    const int rank = cursor.next<std::uint16_t>();
    result.type = static_cast<TensorType>(cursor.next<std::uint8_t>());
    const auto offset = cursor.next<std::uint64_t>();
    result.count = 1;
    for (int axis = 0; axis < rank; ++axis) {
        const auto extent = cursor.next<std::uint64_t>();
        if (extent > bytes.size() || (extent != 0 && result.count > bytes.size() / extent))
            throw input_error({file}, fmt::format("field {} is larger than the file", name));
        result.shape.push_back(extent);
        result.count *= extent;
    }
    // Fields of other types are none of ours; their data is left alone.
    if (result.type != TensorType::uint16 && result.type != TensorType::float32) return result;
    const std::uint64_t length = result.count * size_of(result.type);
    if (offset > bytes.size() || length > bytes.size() - offset)
        throw input_error({file}, fmt::format("field {} reaches beyond the end of the file", name),
                          "the file is truncated or damaged");
    result.data = std::string_view(bytes).substr(offset, length);
    return result;
}

IncomingFields read_fields(const std::string& bytes, const std::string& file) {
    if (!std::string_view(bytes).starts_with(magic)) throw input_error({file}, "not a tensor file (.pbsdf)");
    Cursor cursor(bytes, file);
    cursor.take(magic.size());
    const auto major = cursor.next<std::uint8_t>(), minor = cursor.next<std::uint8_t>();
    if (major != 1 || minor != 0)
        throw input_error({file}, fmt::format("tensor file version {}.{}", major, minor), "only 1.0 is known");
    const auto count = cursor.next<std::uint32_t>();
    IncomingFields fields;
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::string name(cursor.take(cursor.next<std::uint16_t>()));
        fields.insert_or_assign(name, read_field(cursor, bytes, file, name));
    }
    return fields;
}

const IncomingField& require_field(const IncomingFields& fields, const std::string& name, TensorType type,
                                   std::size_t rank, const std::string& file) {
    const auto found = fields.find(name);
    if (found == fields.end()) throw input_error({file}, fmt::format("field {} is missing", name));
    if (found->second.type != type)
        throw input_error({file}, fmt::format("field {} has the type {}", name, static_cast<int>(found->second.type)),
                          fmt::format("{} is expected", static_cast<int>(type)));
    if (found->second.shape.size() != rank || found->second.count == 0)
        throw input_error({file},
                          fmt::format("field {} has the shape ({})", name, fmt::join(found->second.shape, ", ")),
                          fmt::format("{} dimensions, none of them 0, are expected", rank));
    return found->second;
}

template <class T>
std::vector<T> values(const IncomingField& field) {
    std::vector<T> result(field.count);
    std::memcpy(result.data(), field.data.data(), field.data.size());
    return result;
}

std::vector<double> read_axis(const IncomingFields& fields, const std::string& name, const std::string& file) {
    const IncomingField& field = require_field(fields, name, TensorType::float32, 2, file);
    if (field.shape[0] != 1)
        throw input_error({file}, fmt::format("field {} has {} rows", name, field.shape[0]), "one is expected");
    const std::vector<float> found = values<float>(field);
    return {found.begin(), found.end()};
}

}  // namespace

void write_table_pbsdf(const brdf::HalfAngleTable& table, const std::filesystem::path& path) {
    table.validate({path.string()});
    std::vector<std::uint16_t> wavelengths;
    for (double wavelength_nm : table.wavelengths_nm) {
        if (wavelength_nm != std::round(wavelength_nm) || wavelength_nm > 65535)
            throw input_error({path.string()}, fmt::format("wavelength {} nm", wavelength_nm),
                              "the format holds whole nanometres");
        wavelengths.push_back(static_cast<std::uint16_t>(wavelength_nm));
    }
    const std::string bytes = tensor_file(
        {axis_field("theta_h", table.theta_h), axis_field("theta_d", table.theta_d), axis_field("phi_d", table.phi_d),
         field("wvls", TensorType::uint16, {wavelengths.size()}, wavelengths),
         field("M", TensorType::float32,
               {table.phi_d.size(), table.theta_d.size(), table.theta_h.size(), wavelengths.size(), 4, 4},
               table.mueller)});
    write_text_file(path, bytes);
}

brdf::HalfAngleTable read_table_pbsdf(const std::filesystem::path& path) {
    const std::string file = path.string(), bytes = read_text_file(path, std::uint64_t{1} << 33);
    const IncomingFields fields = read_fields(bytes, file);
    brdf::HalfAngleTable table;
    table.theta_h = read_axis(fields, "theta_h", file);
    table.theta_d = read_axis(fields, "theta_d", file);
    table.phi_d = read_axis(fields, "phi_d", file);
    const std::vector<std::uint16_t> wavelengths =
        values<std::uint16_t>(require_field(fields, "wvls", TensorType::uint16, 1, file));
    table.wavelengths_nm.assign(wavelengths.begin(), wavelengths.end());

    const IncomingField& mueller = require_field(fields, "M", TensorType::float32, 6, file);
    const std::vector<std::uint64_t> expected = {
        table.phi_d.size(), table.theta_d.size(), table.theta_h.size(), wavelengths.size(), 4, 4};
    if (mueller.shape != expected)
        throw input_error({file}, fmt::format("field M has the shape ({})", fmt::join(mueller.shape, ", ")),
                          fmt::format("its axes make ({})", fmt::join(expected, ", ")));
    table.mueller = values<float>(mueller);
    table.validate({file});
    return table;
}

}  // namespace patina::io
