#pragma once
// Runs the built program as a user would.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace patina::test {

namespace fs = std::filesystem;

inline std::string read_file(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_file(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

struct Outcome {
    int exit_code;
    std::string out, err;
};

// A test with a folder of its own, in which `patina` runs; the folder is removed afterwards.
class PatinaTest : public ::testing::Test {
  protected:
    PatinaTest() {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        std::string name =
            std::string("patina_") + info->test_suite_name() + "_" + info->name() + "_" + std::to_string(::getpid());
        std::replace(name.begin(), name.end(), '/', '_');  // in the names of tests with parameters
        folder_ = fs::temp_directory_path() / name;
        fs::create_directories(folder_);
    }
    ~PatinaTest() override { fs::remove_all(folder_); }

    const fs::path& folder() const { return folder_; }
    static fs::path example(const std::string& name) { return fs::path(PATINA_SOURCE_DIR) / "examples" / name; }

    // `arguments` is a shell word list; `limit_s` turns a hang into a failure.
    Outcome patina(const std::string& arguments, int limit_s = 300) const {
        const fs::path out = folder_ / ".stdout", err = folder_ / ".stderr";
        const std::string command = "cd '" + folder_.string() + "' && timeout " + std::to_string(limit_s) + " '" +
                                    PATINA_BINARY + "' " + arguments + " >'" + out.string() + "' 2>'" + err.string() +
                                    "'";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
    }

  private:
    fs::path folder_;
};

}  // namespace patina::test
