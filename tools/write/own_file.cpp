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
    const std::string line(kOwnLine.substr(0, kOwnLine.size() - 1));
    return Error{ErrorCode::bad_argument,
                 file.string() + ": would be replaced, but does not begin with '" + line +
                     "': another program or an older cdprep wrote it. Choose another output, or "
                     "remove it."};
}

}  // namespace cdprep::write
