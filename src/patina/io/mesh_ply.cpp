#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include "patina/core/files.h"
#include "patina/io/located_text.h"
#include "patina/io/mesh_attributes.h"
#include "patina/io/mesh_file.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace {

constexpr std::uint64_t largest_mesh_bytes = std::uint64_t{4} << 30;
constexpr std::uint64_t most_corners = 4096;  // of one polygon

enum class Encoding { ascii, little_endian, big_endian };
enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

const std::map<std::string, Scalar, std::less<>>& scalar_names() {
    static const std::map<std::string, Scalar, std::less<>> names{
        {"char", Scalar::i8},   {"int8", Scalar::i8},     {"uchar", Scalar::u8},   {"uint8", Scalar::u8},
        {"short", Scalar::i16}, {"int16", Scalar::i16},   {"ushort", Scalar::u16}, {"uint16", Scalar::u16},
        {"int", Scalar::i32},   {"int32", Scalar::i32},   {"uint", Scalar::u32},   {"uint32", Scalar::u32},
        {"float", Scalar::f32}, {"float32", Scalar::f32}, {"double", Scalar::f64}, {"float64", Scalar::f64}};
    return names;
}

struct Property {
    std::string name;
    Scalar type = Scalar::f32;
    bool list = false;
    Scalar count_type = Scalar::u8;
};

struct ElementKind {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    SourceLocation where;
};

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<ElementKind> elements;
};

// The text of a PLY file, read front to back: header lines, then numbers in the header's encoding.
class PlyCursor {
  public:
    PlyCursor(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    Encoding encoding = Encoding::ascii;

    std::string_view line() {
        if (at_ == text_.size()) throw input_error(where(), "the header has no end_header");
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        const std::string_view found = text_.substr(at_, end - at_);
        at_ = std::min(end + 1, text_.size());
        ++line_;
        return trimmed(found);
    }
    std::size_t remaining() const { return text_.size() - at_; }
    // The line in text, the byte in binary data.
    SourceLocation where() const {
        if (encoding == Encoding::ascii) return {file_, line_, 0};
        return {fmt::format("{}: byte {}", file_, at_), 0, 0};
    }

    double number(Scalar type) { return encoding == Encoding::ascii ? ascii_number() : binary_number(type); }

  private:
    double ascii_number();
    double binary_number(Scalar type);
    template <class T>
    double take() {
        if (remaining() < sizeof(T)) throw input_error(where(), "the file is truncated");
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
        const bool swap = (encoding == Encoding::big_endian) == (std::endian::native == std::endian::little);
        if (swap) std::reverse(bytes.begin(), bytes.end());
        at_ += sizeof(T);
        return static_cast<double>(std::bit_cast<T>(bytes));
    }

    std::string_view text_;
    std::string file_;
    std::size_t at_ = 0;
    int line_ = 0;
};

double PlyCursor::ascii_number() {
    const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    while (at_ < text_.size() && space(text_[at_])) line_ += text_[at_++] == '\n';
    if (at_ == text_.size()) throw input_error(where(), "the file is truncated");
    const std::size_t begin = at_;
    while (at_ < text_.size() && !space(text_[at_])) ++at_;
    SourceLocation place = where();
    ++place.line;  // the header's lines were counted when they ended
    return parse_float(text_.substr(begin, at_ - begin), place, "number");
}

double PlyCursor::binary_number(Scalar type) {
    switch (type) {
        case Scalar::i8:
            return take<std::int8_t>();
        case Scalar::u8:
            return take<std::uint8_t>();
        case Scalar::i16:
            return take<std::int16_t>();
        case Scalar::u16:
            return take<std::uint16_t>();
        case Scalar::i32:
            return take<std::int32_t>();
        case Scalar::u32:
            return take<std::uint32_t>();
        case Scalar::f32:
            return take<float>();
        case Scalar::f64:
            return take<double>();
    }
    return 0;
}

Encoding parse_encoding(std::string_view word, const SourceLocation& where) {
    if (word == "ascii") return Encoding::ascii;
    if (word == "binary_little_endian") return Encoding::little_endian;
    if (word == "binary_big_endian") return Encoding::big_endian;
    throw input_error(where, fmt::format("unknown format {}", in_quotes(word)), "",
                      "known: ascii, binary_little_endian, binary_big_endian");
}

Scalar parse_scalar(std::string_view word, const SourceLocation& where) {
    const auto found = scalar_names().find(word);
    if (found == scalar_names().end()) throw input_error(where, fmt::format("unknown number type {}", in_quotes(word)));
    return found->second;
}

Property parse_property(const std::vector<std::string_view>& words, const SourceLocation& where) {
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) throw input_error(where, "a property line has a type and a name");
    if (!list) return {std::string(words[2]), parse_scalar(words[1], where), false, Scalar::u8};
    return {std::string(words[4]), parse_scalar(words[3], where), true, parse_scalar(words[2], where)};
}

Header read_header(PlyCursor& cursor) {
    Header header;
    if (cursor.line() != "ply") throw input_error(cursor.where(), "not a PLY file", "its first line is not \"ply\"");
    bool format_seen = false;
    while (true) {
        const std::string_view line = cursor.line();
        const SourceLocation where = cursor.where();
        const std::vector<std::string_view> words = split_list(line);
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
        if (words[0] == "end_header") break;
        if (words[0] == "format" && words.size() >= 2) {
            header.encoding = parse_encoding(words[1], where);
            format_seen = true;
        } else if (words[0] == "element" && words.size() == 3) {
            const std::int64_t count = parse_integer(words[2], where, "count");
            if (count < 0) throw input_error(where, fmt::format("a count of {}", count));
            header.elements.push_back({std::string(words[1]), static_cast<std::uint64_t>(count), {}, where});
        } else if (words[0] == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(parse_property(words, where));
        } else {
            throw input_error(where, fmt::format("header line {} makes no sense", in_quotes(line)));
        }
    }
    if (!format_seen) throw input_error(cursor.where(), "the header has no format line");
    return header;
}

// Where a property of an element goes among the attributes of the mesh: the first of their columns, and of each channel
// the property.
struct AttributeSlot {
    std::size_t attribute = 0;
    std::vector<std::size_t> columns;
    bool colour = false;
    std::vector<double> largest;  // of an integer of each column's type, 1 of a real number
};

// Integers stand for 0 .. 1, as Mitsuba has them.
double largest_of(Scalar type) {
    switch (type) {
        case Scalar::i8:
            return 127;
        case Scalar::u8:
            return 255;
        case Scalar::i16:
            return 32767;
        case Scalar::u16:
            return 65535;
        case Scalar::i32:
            return 2147483647.0;
        case Scalar::u32:
            return 4294967295.0;
        default:
            return 1;
    }
}

class PlyReader {
  public:
    PlyReader(std::string_view text, const std::string& name) : cursor_(text, name) { file_.mesh.name = name; }

    MeshFile read() {
        const Header header = read_header(cursor_);
        cursor_.encoding = header.encoding;
        for (const ElementKind& element : header.elements) {
            // Every element takes a byte at least, so that a count cannot promise more than the file holds.
            if (element.properties.empty()) continue;
            if (element.count > cursor_.remaining())
                throw input_error(element.where,
                                  fmt::format("{} elements {} are announced", element.count, in_quotes(element.name)),
                                  fmt::format("{} bytes are left in the file", cursor_.remaining()));
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                skip(element);
        }
        finish_mesh(file_, {file_.mesh.name});
        return std::move(file_);
    }

  private:
    void read_vertices(const ElementKind& element);
    void read_faces(const ElementKind& element);
    void skip(const ElementKind& element);
    std::uint64_t list_size(const Property& property);
    void add_polygon(const std::vector<double>& corners);
    std::vector<AttributeSlot> attribute_slots(const ElementKind& element, std::vector<bool> taken,
                                               const std::string& prefix);
    void store_attributes(const std::vector<double>& values, const std::vector<AttributeSlot>& slots);

    PlyCursor cursor_;
    MeshFile file_;
};

// Where a vertex property goes: 0..2 position, 3..5 normal, 6..7 texture coordinate, -1 nowhere.
int vertex_slot(std::string_view name) {
    static const std::map<std::string_view, int> slots{{"x", 0},  {"y", 1},  {"z", 2},         {"nx", 3},
                                                       {"ny", 4}, {"nz", 5}, {"u", 6},         {"v", 7},
                                                       {"s", 6},  {"t", 7},  {"texture_u", 6}, {"texture_v", 7}};
    const auto found = slots.find(name);
    return found == slots.end() ? -1 : found->second;
}

void PlyReader::read_vertices(const ElementKind& element) {
    std::array<bool, 8> present{};
    std::vector<int> slots;
    for (const Property& property : element.properties) {
        slots.push_back(property.list ? -1 : vertex_slot(property.name));
        if (slots.back() >= 0) present[slots.back()] = true;
    }
    if (!(present[0] && present[1] && present[2]))
        throw input_error(element.where, "vertices need properties x, y and z");
    const bool normals = present[3] && present[4] && present[5], uvs = present[6] && present[7];
    std::vector<bool> taken;
    for (const int slot : slots) taken.push_back(slot >= 0);
    const std::vector<AttributeSlot> attributes = attribute_slots(element, std::move(taken), "vertex_");
    std::vector<double> row(slots.size());

    for (std::uint64_t i = 0; i < element.count; ++i) {
        std::array<float, 8> values{};
        for (std::size_t p = 0; p < slots.size(); ++p) {
            const Property& property = element.properties[p];
            const std::uint64_t count = property.list ? list_size(property) : 1;
            for (std::uint64_t item = 0; item < count; ++item) {
                const double value = cursor_.number(property.type);
                if (slots[p] >= 0) values[slots[p]] = static_cast<float>(value);
                row[p] = value;
            }
        }
        file_.mesh.positions.emplace_back(values[0], values[1], values[2]);
        if (normals) file_.mesh.normals.emplace_back(values[3], values[4], values[5]);
        if (uvs) file_.mesh.uvs.emplace_back(values[6], values[7]);
        store_attributes(row, attributes);
    }
}

void PlyReader::read_faces(const ElementKind& element) {
    std::vector<double> corners;
    bool found = false;
    for (const Property& property : element.properties)
        found |= property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
    if (!found) throw input_error(element.where, "faces need a list property vertex_indices");
    const std::vector<AttributeSlot> attributes =
        attribute_slots(element, std::vector<bool>(element.properties.size()), "face_");
    std::vector<double> row(element.properties.size());

    for (std::uint64_t i = 0; i < element.count; ++i) {
        const std::size_t triangles_before = file_.mesh.triangles.size();
        for (std::size_t p = 0; p < row.size(); ++p) {
            const Property& property = element.properties[p];
            const bool indices =
                property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
            const std::uint64_t count = property.list ? list_size(property) : 1;
            if (indices && (count < 3 || count > most_corners))
                throw input_error(cursor_.where(), fmt::format("face {} has {} corners", i, count),
                                  fmt::format("3 to {} make a polygon", most_corners));
            corners.clear();
            for (std::uint64_t item = 0; item < count; ++item) {
                const double value = cursor_.number(property.type);
                if (indices) corners.push_back(value);
                row[p] = value;
            }
            if (indices) add_polygon(corners);
        }
        for (std::size_t t = triangles_before; t < file_.mesh.triangles.size(); ++t) store_attributes(row, attributes);
    }
}

void PlyReader::add_polygon(const std::vector<double>& corners) {
    constexpr double largest_index = 4294967295.0;
    std::vector<std::uint32_t> indices;
    for (const double corner : corners) {
        if (!(corner >= 0) || corner > largest_index || corner != std::floor(corner))
            throw input_error(cursor_.where(), fmt::format("{} is no vertex index", corner));
        indices.push_back(static_cast<std::uint32_t>(corner));
    }
    for (std::size_t i = 2; i < indices.size(); ++i)
        file_.mesh.triangles.push_back({indices[0], indices[i - 1], indices[i]});
}

std::vector<AttributeSlot> PlyReader::attribute_slots(const ElementKind& element, std::vector<bool> taken,
                                                      const std::string& prefix) {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < taken.size(); ++p)
        names.push_back(taken[p] || element.properties[p].list ? std::string() : element.properties[p].name);
    std::vector<AttributeSlot> slots;
    for (const AttributeColumns& group : group_attributes(names, prefix)) {
        AttributeSlot slot{file_.mesh.attributes.size(), group.columns, group.colour, {}};
        for (const std::size_t column : group.columns)
            slot.largest.push_back(largest_of(element.properties[column].type));
        slots.push_back(std::move(slot));
        file_.mesh.attributes.push_back({group.name, prefix == "face_", static_cast<int>(group.columns.size()), {}});
    }
    return slots;
}

void PlyReader::store_attributes(const std::vector<double>& values, const std::vector<AttributeSlot>& slots) {
    for (const AttributeSlot& slot : slots)
        for (std::size_t channel = 0; channel < slot.columns.size(); ++channel) {
            const double share = values[slot.columns[channel]] / slot.largest[channel];
            // Whole numbers of a colour are sRGB's.
            const bool encoded = slot.colour && slot.largest[channel] != 1;
            file_.mesh.attributes[slot.attribute].values.push_back(
                static_cast<float>(encoded ? spectral::srgb_decode(share) : share));
        }
}

std::uint64_t PlyReader::list_size(const Property& property) {
    const double size = cursor_.number(property.count_type);
    if (!(size >= 0) || size != std::floor(size) || size > static_cast<double>(cursor_.remaining()))
        throw input_error(cursor_.where(), fmt::format("a list {} of {} items", in_quotes(property.name), size),
                          fmt::format("{} bytes are left in the file", cursor_.remaining()));
    return static_cast<std::uint64_t>(size);
}

void PlyReader::skip(const ElementKind& element) {
    for (std::uint64_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) {
            const std::uint64_t count = property.list ? list_size(property) : 1;
            for (std::uint64_t item = 0; item < count; ++item) cursor_.number(property.type);
        }
}

}  // namespace

MeshFile read_ply(const std::filesystem::path& path) {
    const std::string text = read_text_file(path, largest_mesh_bytes);
    return PlyReader(text, path.string()).read();
}

}  // namespace patina::io
