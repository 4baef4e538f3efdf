#include "patina/jobs/checkpoint.h"

#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/core/fingerprint.h"

namespace patina::jobs {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* schema = "patina/checkpoint/1";

// The head of a record; key and values follow, in the byte order of the machine.
struct RecordHead {
    std::uint64_t key_bytes = 0, values = 0;
    std::uint64_t fingerprint = 0;  // of key and values: a record cut short does not pass
};

std::uint64_t fingerprint_of(std::string_view key, std::string_view values) {
    Fingerprint fingerprint;
    fingerprint.add(key);
    fingerprint.add(values);
    return fingerprint.value();
}

std::string_view bytes_of(std::span<const double> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

// Reads the record at the front of `rest` and removes it from there; false when it is damaged.
bool take_record(std::string_view& rest, std::string& key, std::vector<double>& values) {
    RecordHead head;
    if (rest.size() < sizeof head) return false;
    std::memcpy(&head, rest.data(), sizeof head);
    const std::string_view body = rest.substr(sizeof head);
    if (head.key_bytes > body.size() || head.values > (body.size() - head.key_bytes) / sizeof(double)) return false;
    const std::string_view name = body.substr(0, head.key_bytes),
                           numbers = body.substr(head.key_bytes, head.values * sizeof(double));
    if (fingerprint_of(name, numbers) != head.fingerprint) return false;
    key = name;
    values.resize(head.values);
    if (!values.empty()) std::memcpy(values.data(), numbers.data(), numbers.size());
    rest = body.substr(head.key_bytes + numbers.size());
    return true;
}

json to_json(const Checkpoint::Identity& identity) {
    json document = {{"schema", schema}};
    for (const auto& [name, value] : identity) document["identity"][name] = value;
    return document;
}

// The first part of the identity that differs, for people; texts of several lines are not quoted.
std::string difference(const json& kept, const Checkpoint::Identity& identity) {
    for (const auto& [name, value] : identity) {
        const std::string earlier = kept.value(name, std::string());
        if (earlier == value) continue;
        if (earlier.size() > 60 || value.size() > 60 || earlier.find('\n') != std::string::npos)
            return fmt::format("its {} is another", name);
        return fmt::format("its {} is {}, here {}", name, earlier, value);
    }
    return {};
}

}  // namespace

Checkpoint::Checkpoint(const fs::path& path, const Identity& identity, bool resume) : path_(path) {
    std::error_code ignored;
    const bool goes_on = resume && fs::exists(path, ignored);
    if (goes_on)
        read(identity);
    else
        expect_writable(path);
    stream_.open(path, goes_on ? std::ios::binary | std::ios::app : std::ios::binary | std::ios::trunc);
    if (!goes_on) append(to_json(identity).dump(-1, ' ', false, json::error_handler_t::replace) + "\n");
}

void Checkpoint::read(const Identity& identity) {
    const auto refuse = [&](const std::string& problem, const std::string& why) {
        return input_error({path_.string()}, problem, why, "leave out --resume to begin anew");
    };
    const std::string text = read_text_file(path_, std::uint64_t{1} << 40);
    const std::size_t end = text.find('\n');
    const json header = json::parse(std::string_view(text).substr(0, end), nullptr, false);
    if (end == std::string::npos || !header.is_object() || header.value("schema", json()) != schema ||
        !header.value("identity", json()).is_object())
        throw refuse("not a checkpoint of this program", "its first line is not that of one");
    // Text that is not UTF-8 was mended when it was written: compare what was mended the same way.
    const json mine = json::parse(to_json(identity).dump(-1, ' ', false, json::error_handler_t::replace));
    if (header != mine) throw refuse("cannot be resumed", difference(header.at("identity"), identity));

    // Keep what is whole.
    std::string_view rest = std::string_view(text).substr(end + 1);
    std::string key;
    std::vector<double> values;
    while (take_record(rest, key, values)) found_[key] = std::move(values);
    std::error_code error;
    if (!rest.empty()) fs::resize_file(path_, text.size() - rest.size(), error);
    if (error) throw Error(ErrorKind::runtime, fmt::format("{}: {}", path_.string(), error.message()));
}

std::optional<std::vector<double>> Checkpoint::find(const std::string& key, std::size_t count) const {
    const auto found = found_.find(key);
    if (found == found_.end() || (count != 0 && found->second.size() != count)) return std::nullopt;
    return found->second;
}

void Checkpoint::add(const std::string& key, std::span<const double> values) {
    if (path_.empty()) return;
    const std::string_view numbers = bytes_of(values);
    const RecordHead head{key.size(), values.size(), fingerprint_of(key, numbers)};
    std::string record(reinterpret_cast<const char*>(&head), sizeof head);
    record += key;
    record += numbers;
    append(record);
}

void Checkpoint::append(std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream_.flush();
    if (!stream_)
        throw Error(ErrorKind::runtime,
                    fmt::format("{}: cannot be written ({})", path_.string(), std::strerror(errno)));
}

void Checkpoint::remove() {
    if (path_.empty()) return;
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

}  // namespace patina::jobs
