#include <array>
#include <span>
#include <unordered_map>

#include <fmt/format.h>

#include "patina/core/files.h"
#include "patina/io/located_text.h"
#include "patina/io/mesh_file.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {

namespace {

constexpr std::uint64_t largest_mesh_bytes = std::uint64_t{4} << 30;

// Position, texture coordinate and normal of one corner, from 0; -1 for none.
using Corner = std::array<std::int64_t, 3>;

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        std::uint64_t hash = 0;
        for (const std::int64_t index : corner)
            hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15ull + (hash >> 29);
        return hash;
    }
};

class ObjReader {
  public:
    explicit ObjReader(const std::filesystem::path& path) : where_{path.string(), 0, 0} {
        file_.mesh.name = path.string();
    }

    MeshFile read(std::string_view text) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++where_.line;
            read_line(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        finish();
        return std::move(file_);
    }

  private:
    void read_line(std::string_view line);
    void read_face(std::span<const std::string_view> words);
    Corner read_corner(std::string_view word) const;
    std::int64_t read_index(std::string_view text, std::size_t count, const char* what) const;
    std::uint32_t vertex(const Corner& corner);
    void finish();

    template <int N>
    Eigen::Matrix<float, N, 1> read_numbers(std::span<const std::string_view> words) const {
        if (words.size() < N)
            throw input_error(where_, fmt::format("{} numbers where {} are expected", words.size(), N));
        Eigen::Matrix<float, N, 1> numbers;
        for (int i = 0; i < N; ++i) numbers[i] = static_cast<float>(parse_float(words[i], where_, "number"));
        return numbers;
    }

    SourceLocation where_;
    MeshFile file_;
    std::vector<Eigen::Vector3f> positions_, normals_;
    std::vector<Eigen::Vector3f> colours_;  // of positions up to the last that has one
    std::vector<Eigen::Vector2f> uvs_;
    std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
    std::vector<std::size_t> source_;  // position of each vertex of the mesh
    std::size_t corners_without_uv_ = 0, corners_without_normal_ = 0;
};

std::vector<std::string_view> split_words(std::string_view line) {
    std::vector<std::string_view> words;
    const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    for (std::size_t at = 0; at < line.size() && line[at] != '#';) {
        const std::size_t begin = at;
        while (at < line.size() && !space(line[at]) && line[at] != '#') ++at;
        if (at > begin) words.push_back(line.substr(begin, at - begin));
        while (at < line.size() && space(line[at])) ++at;
    }
    return words;
}

void ObjReader::read_line(std::string_view line) {
    const std::vector<std::string_view> words = split_words(line);
    if (words.empty()) return;
    const std::span<const std::string_view> values(words.begin() + 1, words.end());
    const std::string_view key = words[0];
    if (key == "v") {
        positions_.push_back(read_numbers<3>(values));
        // A fourth number alone is a weight.
        if (values.size() >= 6) {
            colours_.resize(positions_.size() - 1, Eigen::Vector3f::Ones());
            colours_.push_back(read_numbers<3>(values.subspan(3)));
        }
    } else if (key == "vn") {
        normals_.push_back(read_numbers<3>(values));
    } else if (key == "vt") {
        uvs_.push_back(values.size() == 1 ? Eigen::Vector2f(read_numbers<1>(values)[0], 0) : read_numbers<2>(values));
    } else if (key == "f") {
        read_face(values);
    } else {
        static const std::vector<std::string> skipped{"o",      "g",      "s",  "l",      "p",
                                                      "usemtl", "mtllib", "vp", "usemap", "maplib"};
        if (std::find(skipped.begin(), skipped.end(), key) == skipped.end())
            throw input_error(where_, fmt::format("unknown statement {}", in_quotes(key)),
                              "this is not a polygon mesh in OBJ");
    }
}

void ObjReader::read_face(std::span<const std::string_view> words) {
    if (words.size() < 3)
        throw input_error(where_, fmt::format("a face with {} corners", words.size()), "it takes 3 or more");
    std::vector<std::uint32_t> corners;
    for (const std::string_view word : words) corners.push_back(vertex(read_corner(word)));
    for (std::size_t i = 2; i < corners.size(); ++i)
        file_.mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

// "v", "v/vt", "v//vn" or "v/vt/vn".
Corner ObjReader::read_corner(std::string_view word) const {
    Corner corner{-1, -1, -1};
    const std::array<std::size_t, 3> counts{positions_.size(), uvs_.size(), normals_.size()};
    constexpr std::array<const char*, 3> names{"vertex", "texture coordinate", "normal"};
    std::string_view rest = word;
    for (std::size_t part = 0; part < 3; ++part) {
        const std::size_t slash = std::min(rest.find('/'), rest.size());
        const std::string_view text = rest.substr(0, slash);
        const bool last = slash == rest.size();
        if (!text.empty()) corner[part] = read_index(text, counts[part], names[part]);
        if (part == 0 && text.empty())
            throw input_error(where_, fmt::format("corner {} has no vertex", in_quotes(word)));
        if (last) return corner;
        rest.remove_prefix(slash + 1);
    }
    throw input_error(where_, fmt::format("corner {} has too many parts", in_quotes(word)),
                      "it is vertex/texture/normal");
}

// Indices count from 1, or from the last element backwards when negative.
std::int64_t ObjReader::read_index(std::string_view text, std::size_t count, const char* what) const {
    const std::int64_t index = parse_integer(text, where_, what);
    const auto size = static_cast<std::int64_t>(count);
    const std::int64_t from_zero = index < 0 ? size + index : index - 1;
    if (index == 0 || from_zero < 0 || from_zero >= size)
        throw input_error(where_, fmt::format("{} {} does not exist", what, index),
                          fmt::format("{} are defined so far", size), "indices start at 1");
    return from_zero;
}

// The mesh's vertex for this combination, made at its first use.
std::uint32_t ObjReader::vertex(const Corner& corner) {
    const auto [known, added] = vertices_.emplace(corner, static_cast<std::uint32_t>(file_.mesh.positions.size()));
    if (!added) return known->second;
    file_.mesh.positions.push_back(positions_[corner[0]]);
    source_.push_back(static_cast<std::size_t>(corner[0]));
    file_.mesh.uvs.push_back(corner[1] < 0 ? Eigen::Vector2f(0, 0) : uvs_[corner[1]]);
    file_.mesh.normals.push_back(corner[2] < 0 ? Eigen::Vector3f(0, 0, 0) : normals_[corner[2]]);
    corners_without_uv_ += corner[1] < 0;
    corners_without_normal_ += corner[2] < 0;
    return known->second;
}

void ObjReader::finish() {
    // Without any, there are none; a normal missing here and there is computed from the faces.
    if (corners_without_uv_ == file_.mesh.positions.size()) file_.mesh.uvs.clear();
    if (corners_without_normal_ == file_.mesh.positions.size()) file_.mesh.normals.clear();
    if (!file_.mesh.uvs.empty() && corners_without_uv_ > 0)
        file_.warnings.push_back(fmt::format("{}: {} vertices have no texture coordinate; (0, 0) is used",
                                             file_.mesh.name, corners_without_uv_));
    if (!colours_.empty()) {
        colours_.resize(positions_.size(), Eigen::Vector3f::Ones());
        MeshAttribute colour{"vertex_color", false, 3, {}};
        for (const std::size_t position : source_)
            for (const float channel : colours_[position])
                colour.values.push_back(static_cast<float>(spectral::srgb_decode(channel)));
        file_.mesh.attributes.push_back(std::move(colour));
    }
    finish_mesh(file_, {where_.file});
}

}  // namespace

MeshFile read_obj(const std::filesystem::path& path) {
    return ObjReader(path).read(read_text_file(path, largest_mesh_bytes));
}

}  // namespace patina::io
