#include "patina/jobs/render_checkpoint.h"

#include <cstring>
#include <fstream>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "patina/core/error.h"
#include "patina/core/files.h"

namespace patina::jobs {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view title = "patina render checkpoint 1\n";
constexpr std::uint64_t largest_document = 1 << 24;

std::string_view film_bytes(std::span<const std::byte> film) {
    return {reinterpret_cast<const char*>(film.data()), film.size()};
}

std::string_view word_bytes(const std::uint64_t& word) {
    return {reinterpret_cast<const char*>(&word), sizeof word};
}

// The value of a property as bytes that differ when it does.
std::string text_of(const PropertyValue& value) {
    struct Visitor {
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
        std::string operator()(double v) const { return fmt::format("{:a}", v); }
        std::string operator()(const std::string& v) const { return v; }
        std::string operator()(const Eigen::Vector3d& v) const { return numbers(v.data(), 3); }
        std::string operator()(const Eigen::Matrix4d& v) const { return numbers(v.data(), 16); }
        std::string operator()(const SpectrumSpec& v) const {
            return fmt::format("{}:", static_cast<int>(v.kind)) +
                   numbers(v.wavelengths_nm.data(), v.wavelengths_nm.size()) + ":" +
                   numbers(v.values.data(), v.values.size());
        }
        static std::string numbers(const double* first, std::size_t count) {
            std::string text;
            for (std::size_t i = 0; i < count; ++i) text += fmt::format("{:a} ", first[i]);
            return text;
        }
    };
    return std::visit(Visitor{}, value);
}

[[noreturn]] void refuse_damaged(const fs::path& path, std::string_view why) {
    throw input_error({path.string()}, "the checkpoint is damaged", why, "remove it, or render without --resume");
}

// The first difference between what the file was made for and what is asked for now.
void expect_same(const fs::path& path, const json& then, const RenderIdentity& now) {
    const auto refuse = [&](const std::string& key, const std::string& was, const std::string& is) {
        throw input_error({path.string()}, fmt::format("the checkpoint is of another picture: {}", key),
                          fmt::format("{}, now {}", was, is), "render without --resume to begin anew");
    };
    for (const auto& [key, value] : now) {
        const std::string was = then.contains(key) ? then.at(key).get<std::string>() : "not known";
        if (was != value) refuse(key, was, value);
    }
    for (const auto& [key, value] : then.items())
        if (!now.contains(key)) refuse(key, value.get<std::string>(), "not given");
}

}  // namespace

void add_to(Fingerprint& fingerprint, const Properties& node) {
    // With its length, so that no two lists of texts look alike.
    const auto add = [&](std::string_view text) {
        fingerprint.add(text);
        fingerprint.add(static_cast<double>(text.size()));
    };
    add(node.category);
    add(node.type);
    add(node.id);
    for (const Properties::Entry& entry : node.entries) {
        add(entry.name);
        const std::string* text = std::get_if<std::string>(&entry.value);
        std::error_code none;
        if (text && fs::path(*text).is_absolute() && fs::is_regular_file(*text, none))
            add(read_text_file(*text, std::uint64_t{1} << 40));
        else
            add(text_of(entry.value));
    }
    for (const Properties::Child& child : node.children) {
        add(child.name);
        add_to(fingerprint, *child.node);
    }
    add("end");
}

void add_to(Fingerprint& fingerprint, const brdf::MuellerTable& table) {
    const auto add_numbers = [&](const double* data, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) fingerprint.add(data[i]);
    };
    add_numbers(table.wavelengths_nm.data(), table.wavelengths_nm.size());
    add_numbers(table.mu.data(), table.mu.size());
    for (const brdf::BodyModes& body : table.body)
        for (const Eigen::MatrixXd& mode : body.modes) add_numbers(mode.data(), static_cast<std::size_t>(mode.size()));
    for (const auto* part : {&table.specular_surface, &table.specular_coherent})
        for (const auto& row : *part)
            for (const optics::Mueller& matrix : row) add_numbers(matrix.data(), 16);
}

void add_options(const render::RenderOptions& options, RenderIdentity& identity) {
    if (options.size) identity["--size"] = fmt::format("{}x{}", options.size->first, options.size->second);
    if (options.crop) identity["--crop"] = fmt::format("{}", fmt::join(*options.crop, ","));
    if (options.integrator) identity["--integrator"] = *options.integrator;
    if (options.seed) identity["--seed"] = fmt::format("{}", *options.seed);
    if (!options.bin_edges_nm.empty()) identity["bins"] = fmt::format("{}", fmt::join(options.bin_edges_nm, ","));
    if (options.neumann_terms > 0) identity["--neumann"] = fmt::format("{}", options.neumann_terms);
    for (const render::LightPathOutput& output : options.light_paths)
        identity["--lpe " + output.name] = output.expression;
}

void CheckpointFile::save(const render::RenderState& state) const {
    json document = {{"samples", state.samples},
                     {"non_finite", state.non_finite},
                     {"non_finite_places", state.non_finite_places},
                     {"identity", identity_},
                     {"films", json::array()}};
    for (const auto& film : state.films) document["films"].push_back(film.size());
    const std::string text = document.dump();
    Fingerprint hash;
    hash.add(text);
    for (const auto& film : state.films) hash.add(film_bytes(film));
    write_file_atomically(path_, [&](const fs::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary);
        const std::uint64_t length = text.size(), seal = hash.value();
        stream << title << word_bytes(length) << text;
        for (const auto& film : state.films) stream << film_bytes(film);
        stream << word_bytes(seal) << std::flush;
        if (!stream)
            throw Error(ErrorKind::runtime, fmt::format("{}: the checkpoint cannot be written", path_.string()));
    });
}

bool CheckpointFile::load(render::RenderState& state) const {
    std::error_code none;
    if (!fs::exists(path_, none)) return false;
    std::ifstream stream(path_, std::ios::binary);
    const auto read = [&](void* data, std::size_t size) {
        if (!stream.read(static_cast<char*>(data), static_cast<std::streamsize>(size)))
            refuse_damaged(path_, "it ends too soon");
    };

    // What is it?
    std::string start(title.size(), ' ');
    read(start.data(), start.size());
    std::uint64_t length = 0;
    read(&length, sizeof length);
    if (start != title || length > largest_document) refuse_damaged(path_, "it does not begin as one");
    std::string text(length, ' ');
    read(text.data(), length);
    const json document = json::parse(text, nullptr, false);
    if (!document.is_object() || !document.contains("identity")) refuse_damaged(path_, "its description is no JSON");
    expect_same(path_, document.at("identity"), identity_);

    // Put the films back.
    Fingerprint hash;
    hash.add(text);
    const json& sizes = document.at("films");
    bool fits = sizes.size() == state.films.size();
    for (std::size_t i = 0; fits && i < sizes.size(); ++i) fits = sizes[i] == state.films[i].size();
    if (!fits) refuse_damaged(path_, "its films have another size");
    for (const auto& film : state.films) {
        read(film.data(), film.size());
        hash.add(film_bytes(film));
    }
    std::uint64_t seal = 0;
    read(&seal, sizeof seal);
    if (seal != hash.value()) refuse_damaged(path_, "its hash is wrong");
    state.samples = document.at("samples");
    state.non_finite = document.at("non_finite");
    state.non_finite_places = document.at("non_finite_places").get<std::vector<std::string>>();
    return true;
}

void CheckpointFile::remove() const {
    std::error_code none;
    fs::remove(path_, none);
}

}  // namespace patina::jobs
