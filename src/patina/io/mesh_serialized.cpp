#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <zlib.h>

#include "patina/core/files.h"
#include "patina/io/mesh_file.h"

namespace patina::io {

namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr std::uint64_t largest_mesh_bytes = std::uint64_t{4} << 30;
constexpr std::uint16_t magic = 0x041c;
// Deflate packs at most 1032:1; counts that promise more are broken or a trap.
constexpr double largest_expansion = 1100;

// Mesh flags of the format (Mitsuba's documentation of the plugin `serialized`).
constexpr std::uint32_t has_normals = 0x0001, has_uvs = 0x0002, has_colours = 0x0008, has_face_normals = 0x0010,
                        is_double = 0x2000;

template <class T>
T number_at(std::string_view bytes, std::size_t at, const SourceLocation& where) {
    if (at > bytes.size() || bytes.size() - at < sizeof(T)) throw input_error(where, "the file is truncated");
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

// The deflated bytes of one mesh, front to back.
class Inflater {
  public:
    Inflater(std::string_view packed, SourceLocation where) : where_(std::move(where)), packed_bytes_(packed.size()) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
        stream_.avail_in = static_cast<uInt>(std::min<std::size_t>(packed.size(), 0xffffffffu));
        if (inflateInit(&stream_) != Z_OK) throw Error(ErrorKind::runtime, "zlib refuses to start");
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    template <class T>
    T take() {
        T value;
        read(&value, sizeof(T));
        return value;
    }
    // `count` numbers of the file's precision.
    std::vector<float> floats(std::uint64_t count, bool wide) {
        const std::size_t bytes = expect_room(count, wide ? sizeof(double) : sizeof(float));
        std::vector<float> values(count);
        if (!wide) {
            read(values.data(), bytes);
            return values;
        }
        std::vector<double> doubles(count);
        read(doubles.data(), bytes);
        for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(doubles[i]);
        return values;
    }
    std::vector<std::uint32_t> indices(std::uint64_t count) {
        std::vector<std::uint32_t> values(expect_room(count, sizeof(std::uint32_t)) / sizeof(std::uint32_t));
        read(values.data(), values.size() * sizeof(std::uint32_t));
        return values;
    }

  private:
    std::size_t expect_room(std::uint64_t count, std::size_t size) const {
        if (static_cast<double>(count) * static_cast<double>(size) >
            largest_expansion * static_cast<double>(packed_bytes_))
            throw input_error(where_, fmt::format("{} numbers are announced", count),
                              fmt::format("{} bytes are left in the file", packed_bytes_));
        return static_cast<std::size_t>(count) * size;
    }
    void read(void* to, std::size_t bytes) {
        auto* out = static_cast<Bytef*>(to);
        while (bytes > 0) {
            const std::size_t step = std::min<std::size_t>(bytes, 1u << 30);
            stream_.next_out = out;
            stream_.avail_out = static_cast<uInt>(step);
            while (stream_.avail_out > 0) {
                const int state = inflate(&stream_, Z_NO_FLUSH);
                if (state == Z_OK) continue;
                if (state == Z_STREAM_END && stream_.avail_out == 0) break;
                throw input_error(where_, "the packed mesh cannot be read",
                                  state == Z_STREAM_END || state == Z_BUF_ERROR ? "it is truncated" : "it is damaged");
            }
            out += step;
            bytes -= step;
        }
    }

    z_stream stream_{};
    SourceLocation where_;
    std::size_t packed_bytes_;
};

// Where mesh `index` begins: the file ends with the offsets of all and their number.
std::size_t offset_of(std::string_view bytes, int index, std::uint16_t version, const SourceLocation& where) {
    if (bytes.size() < sizeof(std::uint32_t)) throw input_error(where, "the file is truncated");
    const auto count = number_at<std::uint32_t>(bytes, bytes.size() - sizeof(std::uint32_t), where);
    const std::size_t width = version == 4 ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
    if (static_cast<std::uint64_t>(count) * width + sizeof(std::uint32_t) > bytes.size())
        throw input_error(where, fmt::format("{} meshes are announced", count), "the file is smaller than their table");
    if (index < 0 || static_cast<std::uint32_t>(index) >= count)
        throw input_error(where, fmt::format("there is no mesh {}", index), fmt::format("the file holds {}", count),
                          "numbers count from 0");
    const std::size_t entry = bytes.size() - sizeof(std::uint32_t) - (count - static_cast<std::size_t>(index)) * width;
    return static_cast<std::size_t>(version == 4 ? number_at<std::uint64_t>(bytes, entry, where)
                                                 : number_at<std::uint32_t>(bytes, entry, where));
}

}  // namespace

MeshFile read_serialized(const std::filesystem::path& path, int index) {
    const SourceLocation where{path.string()};
    const std::string file = read_text_file(path, largest_mesh_bytes);
    const std::string_view bytes = file;
    const auto version = number_at<std::uint16_t>(bytes, sizeof(magic), where);
    if (number_at<std::uint16_t>(bytes, 0, where) != magic || (version != 3 && version != 4))
        throw input_error(where, "not a serialized mesh", fmt::format("its version is {}", version),
                          "versions 3 and 4 are read");
    const std::size_t begin = offset_of(bytes, index, version, where) + 2 * sizeof(std::uint16_t);
    if (begin > bytes.size()) throw input_error(where, "the file is truncated");

    Inflater packed(bytes.substr(begin), where);
    MeshFile result;
    TriangleMesh& mesh = result.mesh;
    mesh.name = fmt::format("{}, mesh {}", path.string(), index);
    const auto flags = packed.take<std::uint32_t>();
    if (version == 4)
        while (packed.take<char>() != 0) {
        }
    const auto vertices = packed.take<std::uint64_t>(), triangles = packed.take<std::uint64_t>();
    if (vertices > 0xffffffffu || triangles > 0xffffffffu)
        throw input_error(where, fmt::format("{} vertices and {} triangles are too many", vertices, triangles));
    const bool wide = flags & is_double;
    const std::vector<float> positions = packed.floats(3 * vertices, wide);
    const std::vector<float> normals = packed.floats(flags & has_normals ? 3 * vertices : 0, wide);
    const std::vector<float> uvs = packed.floats(flags & has_uvs ? 2 * vertices : 0, wide);
    std::vector<float> colours = packed.floats(flags & has_colours ? 3 * vertices : 0, wide);
    const std::vector<std::uint32_t> corners = packed.indices(3 * triangles);

    for (std::size_t i = 0; i < vertices; ++i)
        mesh.positions.emplace_back(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    if (!(flags & has_face_normals))
        for (std::size_t i = 0; i < normals.size(); i += 3)
            mesh.normals.emplace_back(normals[i], normals[i + 1], normals[i + 2]);
    for (std::size_t i = 0; i < uvs.size(); i += 2) mesh.uvs.emplace_back(uvs[i], uvs[i + 1]);
    if (!colours.empty()) mesh.attributes.push_back({"vertex_color", false, 3, std::move(colours)});
    for (std::size_t i = 0; i < corners.size(); i += 3)
        mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    finish_mesh(result, where);
    return result;
}

}  // namespace patina::io
