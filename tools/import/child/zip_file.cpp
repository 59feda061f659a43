// SPDX-License-Identifier: GPL-3.0-or-later
#include "zip_file.h"

#include <zip.h>

#include <cstdint>
#include <stdexcept>

namespace cdprep::import {
namespace {

struct CloseEntry {
    void operator()(zip_file_t* entry) const noexcept {
        ::zip_fclose(entry);
    }
};

/// Deflate packs at most 1,032 bytes into one.
constexpr std::uint64_t kMostPerPackedByte = 1032;

}  // namespace

void ZipFile::Close::operator()(zip* archive) const noexcept {
    ::zip_discard(archive);
}

ZipFile::ZipFile(const std::filesystem::path& path) {
    int code = 0;
    archive_.reset(::zip_open(path.c_str(), ZIP_RDONLY, &code));
    if (archive_) return;
    zip_error_t error;
    ::zip_error_init_with_code(&error, code);
    const std::string why = ::zip_error_strerror(&error);
    ::zip_error_fini(&error);
    throw std::runtime_error("the archive cannot be opened: " + why);
}

std::string ZipFile::read(const std::string& name) const {
    const zip_int64_t number = ::zip_name_locate(archive_.get(), name.c_str(), ZIP_FL_NOCASE);
    if (number < 0) throw std::runtime_error("its part " + name + " is missing");
    const auto place = static_cast<zip_uint64_t>(number);
    zip_stat_t status;
    if (::zip_stat_index(archive_.get(), place, 0, &status) != 0) {
        throw std::runtime_error("its part " + name + " cannot be read");
    }
    if (status.size / kMostPerPackedByte > status.comp_size) {
        throw std::runtime_error("its part " + name + " declares " + std::to_string(status.size) +
                                 " bytes, but has only " + std::to_string(status.comp_size) +
                                 " compressed bytes");
    }
    const std::unique_ptr<zip_file_t, CloseEntry> entry(
        ::zip_fopen_index(archive_.get(), place, 0));
    std::string bytes(entry ? status.size : 0, '\0');
    // libzip compares the checksum when a read finds the end, so one more byte is wanted.
    char beyond = 0;
    if (!entry ||
        ::zip_fread(entry.get(), bytes.data(), bytes.size()) !=
            static_cast<zip_int64_t>(bytes.size()) ||
        ::zip_fread(entry.get(), &beyond, 1) != 0) {
        zip_error_t* const error =
            entry ? ::zip_file_get_error(entry.get()) : ::zip_get_error(archive_.get());
        throw std::runtime_error("its part " + name + " cannot be read: " +
                                 (::zip_error_code_zip(error) != ZIP_ER_OK
                                      ? ::zip_error_strerror(error)
                                      : "its size is not the " + std::to_string(status.size) +
                                            " bytes that it declares"));
    }
    return bytes;
}

}  // namespace cdprep::import
