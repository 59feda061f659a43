// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "cdprep/result.h"
#include "write/mesh_file.h"

namespace cdprep::cli {

/// Returns the path without links. Where links cannot be followed, returns the absolute path.
[[nodiscard]] std::filesystem::path without_links(const std::filesystem::path& path);

/// Returns one spelling for the paths that lead to a file through folders and links. The file need
/// not exist.
[[nodiscard]] std::filesystem::path named_file(const std::filesystem::path& path);

/// Returns the path without "." and "..", or unchanged if that leads to another file: ".." after a
/// symbolic link leads to the folder above the link's target.
[[nodiscard]] std::filesystem::path shortened(const std::filesystem::path& path);

/// The files that a command reads and writes. An empty path is none. The settings file of --config
/// is an input.
class UsedFiles {
public:
    UsedFiles();
    void add_input(const std::filesystem::path& path);
    /// Adds a file that will be written. Fails with bad_argument if it is an input or another
    /// output, whatever name it has there.
    [[nodiscard]] Result<Done> add_output(const std::filesystem::path& path);

private:
    /// Returns false for a file that is known.
    bool add(const std::filesystem::path& path);

    std::set<std::filesystem::path> names_;
    std::set<std::pair<std::uint64_t, std::uint64_t>> files_;  ///< device and number, if it exists
};

/// Returns the error of UsedFiles if an output is the input.
[[nodiscard]] std::optional<Error> find_replaced_input(const std::filesystem::path& input,
                                                       const std::filesystem::path& output);

/// Returns the format that the extension of `output` names; OBJ for "-", standard output. Fails
/// if there is no such format or if `output` is the input. Reads no file content, so a command
/// can fail before it reads anything.
[[nodiscard]] Result<write::MeshFormat> mesh_output(const std::filesystem::path& input,
                                                    const std::filesystem::path& output);

/// Writes a mesh into the file `output`, or to standard output for "-". `format` is the result
/// of mesh_output().
[[nodiscard]] Result<Done> write_mesh(const std::filesystem::path& output, write::MeshFormat format,
                                      const write::MeshArrays& mesh);

/// Writes the complete bytes of a file, or writes them to standard output for "-".
[[nodiscard]] Result<Done> write_bytes(const std::filesystem::path& output, std::string_view bytes);

/// Returns the stream for a report: standard output, or standard error if `output` is "-".
[[nodiscard]] std::ostream& report_stream(const std::filesystem::path& output);

}  // namespace cdprep::cli
