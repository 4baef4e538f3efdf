#include "patina/core/files.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

#include "patina/core/error.h"

namespace patina {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

std::string read_text_file(const fs::path& path, std::uint64_t largest_bytes) {
    std::error_code status_error;
    const fs::file_status status = fs::status(path, status_error);
    if (!fs::exists(status)) throw input_error({path.string()}, "file not found");
    if (!fs::is_regular_file(status)) throw input_error({path.string()}, "not a regular file");

    const std::uint64_t size = fs::file_size(path, status_error);
    if (status_error) throw input_error({path.string()}, "cannot be read", status_error.message());
    if (size > largest_bytes)
        throw input_error({path.string()}, "file is too large",
                          fmt::format("{} bytes, where at most {} make sense", size, largest_bytes));

    std::ifstream stream(path, std::ios::binary);
    std::string text(size, '\0');
    if (!stream || !stream.read(text.data(), static_cast<std::streamsize>(size)))
        throw input_error({path.string()}, "cannot be read", std::strerror(errno));
    return text;
}

void expect_writable(const fs::path& path) {
    std::error_code ignored;
    const fs::path folder = folder_of(path);
    const auto refuse = [&](const std::string& why) {
        return Error(ErrorKind::runtime, fmt::format("{}: cannot be written ({})", path.string(), why));
    };
    if (!fs::is_directory(folder, ignored))
        throw refuse(fmt::format("the folder \"{}\" does not exist", folder.string()));
    if (fs::is_directory(path, ignored)) throw refuse("it is a folder");
    if (::access(folder.c_str(), W_OK) != 0) throw refuse(std::strerror(errno));
}

void write_file_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    expect_writable(path);
    std::error_code ignored;
    const fs::path folder = folder_of(path);

    // The extension stays last: libraries choose the format by it.
    const fs::path temporary =
        folder / fmt::format(".{}.{}.partial{}", path.stem().string(), ::getpid(), path.extension().string());
    try {
        write(temporary);
    } catch (...) {
        fs::remove(temporary, ignored);
        throw;
    }

    std::error_code rename_error;
    fs::rename(temporary, path, rename_error);
    if (rename_error) {
        fs::remove(temporary, ignored);
        throw Error(ErrorKind::runtime,
                    fmt::format("{}: cannot be written ({})", path.string(), rename_error.message()));
    }
}

void write_text_file(const fs::path& path, std::string_view text) {
    write_file_atomically(path, [&](const fs::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary);
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.close();
        if (!stream)
            throw Error(ErrorKind::runtime,
                        fmt::format("{}: cannot be written ({})", path.string(), std::strerror(errno)));
    });
}

}  // namespace patina
