// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>

struct zip;

namespace cdprep::import {

/// A ZIP archive, read only.
class ZipFile {
public:
    /// Opens an archive. Throws std::runtime_error with the reason if the file is not an archive.
    explicit ZipFile(const std::filesystem::path& path);

    /// Returns the bytes of an entry. Its name is compared without regard to case. Throws
    /// std::runtime_error with the name if the entry is missing, encrypted or damaged. Also throws
    /// if the entry declares more bytes than its packed bytes can hold.
    [[nodiscard]] std::string read(const std::string& name) const;

private:
    struct Close {
        void operator()(zip* archive) const noexcept;
    };
    std::unique_ptr<zip, Close> archive_;
};

}  // namespace cdprep::import
