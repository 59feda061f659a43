// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/own_file.h"

#include <fstream>
#include <string>
#include <system_error>

namespace cdprep::write {
namespace {

bool is_own(const std::filesystem::path& file) {
    std::string begin(kOwnLine.size(), ' ');
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return stream && begin == kOwnLine;
}

}  // namespace

std::optional<Error> find_foreign(const std::filesystem::path& file) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown) || is_own(file)) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 file.string() +
                     ": would be replaced, but cdprep did not write it. Choose another output, or "
                     "remove it."};
}

}  // namespace cdprep::write
