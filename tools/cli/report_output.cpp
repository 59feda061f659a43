// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report_output.h"

#include <iostream>
#include <span>
#include <utility>

namespace cdprep::cli {
namespace {

Result<Done> checked(const std::ostream& out) {
    if (out) return Done{};
    return Error{ErrorCode::unwritable,
                 "standard output cannot be written; the result is incomplete."};
}

}  // namespace

Result<ReportOutput> ReportOutput::open(const std::filesystem::path& path) {
    ReportOutput output;
    if (path.empty() || path == "-") return output;
    Result<write::OutputFile> file = write::OutputFile::create(path);
    if (!file) return file.error();
    output.file_.emplace(std::move(file).value());
    return output;
}

Result<Done> ReportOutput::append(std::string_view text) {
    if (!file_) return checked(std::cout << text);
    const auto bytes = std::as_bytes(std::span(text));
    Result<Done> written = file_->write_at(size_, bytes);
    size_ += text.size();
    return written;
}

Result<Done> ReportOutput::finish() {
    return file_ ? file_->commit() : checked(std::cout.flush());
}

}  // namespace cdprep::cli
