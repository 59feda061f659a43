// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "input_files.h"
#include "json_value.h"

namespace cdprep::import {

/// Returns the bytes of a file, and records that it was opened. Throws std::runtime_error if they
/// cannot be read.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, InputFiles& files);

/// Returns the value at a place that need not be aligned.
template <class T>
[[nodiscard]] T load(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// How to read an accessor without a buffer view that is not sparse either.
enum class NoData : std::uint8_t {
    refused,  ///< compressed meshes look like that
    zeros,    ///< as glTF 2.0 defines it
};

/// The buffers of a glTF document, and the elements that its accessors find in them. All members
/// throw std::runtime_error if the document contradicts itself; the message has the numbers.
class GltfAccessors {
public:
    /// `binary` is the binary part of a GLB. All arguments must outlive the object.
    GltfAccessors(const std::filesystem::path& path, JsonValue root, std::string_view binary,
                  InputFiles& files)
        : path_(path), root_(root), binary_(binary), files_(files) {}

    /// Reads all buffers. Call it first.
    void read_buffers();

    /// Returns the elements of an accessor: VEC3, VEC4 or MAT4, as `Width` says. Integers are
    /// divided by their limit if they are normalized. A sparse accessor without a buffer view has
    /// zeros where it replaces nothing.
    template <std::size_t Width>
    [[nodiscard]] std::vector<std::array<double, Width>> read(
        std::uint64_t number, NoData no_data = NoData::refused) const;

    /// Returns the number of elements that an accessor declares. Without data, it may be any.
    [[nodiscard]] std::uint64_t count_of(std::uint64_t number) const;

    /// Returns the elements of an accessor of indices.
    [[nodiscard]] std::vector<std::uint32_t> read_indices(std::uint64_t number) const;

private:
    struct Place {
        const char* at = nullptr;
        std::uint64_t count = 0;
        std::uint64_t stride = 0;
        std::uint64_t component = 0;
    };
    /// The bytes in which the elements of a buffer view must lie.
    struct View {
        std::string_view bytes;   ///< of the view; of its whole buffer if it states no length
        std::uint64_t first = 0;  ///< of these bytes, where the view begins
        std::string name;         ///< of what has these bytes
    };

    [[nodiscard]] std::string read_buffer_file(const std::string& name) const;
    [[nodiscard]] JsonValue find(std::uint64_t number) const;
    [[nodiscard]] JsonValue find(std::uint64_t number, std::string_view type) const;
    [[nodiscard]] View find_view(const std::string& name, std::uint64_t number) const;
    [[nodiscard]] Place find_elements(const std::string& name, JsonValue place,
                                      std::uint64_t component, std::uint64_t count,
                                      std::uint64_t width) const;
    template <std::size_t Width>
    void replace_some(const std::string& name, JsonValue accessor,
                      std::vector<std::array<double, Width>>& elements) const;

    const std::filesystem::path& path_;
    JsonValue root_;
    std::string_view binary_;
    InputFiles& files_;
    std::vector<std::string> owned_;
    std::vector<std::string_view> buffers_;
};

}  // namespace cdprep::import
