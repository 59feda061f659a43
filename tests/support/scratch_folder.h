// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace cdprep::test {

/// A new folder. The destructor removes it with all its content.
class ScratchFolder {
public:
    ScratchFolder() {
        std::random_device random;
        for (int i = 0; i < 100; ++i) {
            const std::string name =
                "cdprep_" + std::to_string(random()) + std::to_string(random());
            path_ = std::filesystem::temp_directory_path() / name;
            std::error_code failed;
            if (std::filesystem::create_directory(path_, failed)) return;  // false: it was there
        }
        std::fprintf(stderr, "%s: cannot be made.\n", path_.string().c_str());
        std::abort();
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    [[nodiscard]] const std::filesystem::path& path() const {
        return path_;
    }
    [[nodiscard]] std::string file(const std::string& name) const {
        return (path_ / name).string();
    }
    /// Writes a file into the folder and returns its path.
    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }
    std::filesystem::path write(const std::string& name, std::span<const std::byte> bytes) const {
        return write(name,
                     std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }

    /// Returns the names of everything in the folder.
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) {
            names.insert(entry.path().filename().string());
        }
        return names;
    }

private:
    std::filesystem::path path_;
};

}  // namespace cdprep::test
