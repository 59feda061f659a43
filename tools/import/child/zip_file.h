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
    /// Throws std::runtime_error with the reason when it is no archive.
    explicit ZipFile(const std::filesystem::path& path);

    /// The bytes of an entry, whose name is compared without regard to case. Throws
    /// std::runtime_error with the name when there is none, when it is encrypted or damaged, or
    /// when it claims to be larger than its packed bytes can be.
    [[nodiscard]] std::string read(const std::string& name) const;

private:
    struct Close {
        void operator()(zip* archive) const noexcept;
    };
    std::unique_ptr<zip, Close> archive_;
};

}  // namespace cdprep::import
