#pragma once
// Reading whole files, and writing them so that a half-written file never stands under its final name.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace patina {

// The bytes of a regular file. Throws Error(input) naming the file when it is missing, a folder, not readable, or
// larger than `largest_bytes`.
std::string read_text_file(const std::filesystem::path& path, std::uint64_t largest_bytes = std::uint64_t{1} << 30);

// Throws Error(runtime) when `path` could not be written: its folder does not exist or is not writable, or it is a
// folder itself. To be called before long work whose result goes there.
void expect_writable(const std::filesystem::path& path);

// Calls write(temporary_path), where the temporary lies beside `path`, then renames it to `path`. When write throws,
// the temporary is removed and an earlier file under `path` stays as it was. Throws Error(runtime) when the folder does
// not exist or cannot be written.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path& temporary)>& write);

// The same for text at hand; a short write (disk full) is an Error(runtime).
void write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace patina
