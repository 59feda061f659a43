// SPDX-License-Identifier: GPL-3.0-or-later
#include "gltf_accessors.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <utility>

#include "readers.h"

namespace cdprep::import {
namespace {

enum Component : std::uint64_t {
    i8 = 5120,
    u8 = 5121,
    i16 = 5122,
    u16 = 5123,
    u32 = 5125,
    f32 = 5126
};

std::uint64_t size_of(std::uint64_t component) {
    switch (component) {
        case i8:
        case u8:
            return 1;
        case i16:
        case u16:
            return 2;
        case u32:
        case f32:
            return 4;
        default:
            fail("component type " + std::to_string(component) + " is not a type of glTF");
    }
}

/// Returns the value of one component. Integers are divided by their limit if `normalized`.
float load_component(std::uint64_t component, const char* at, bool normalized) {
    const auto scaled = [&](auto value, float limit) {
        const auto x = static_cast<float>(value);
        return normalized ? std::max(x / limit, -1.0f) : x;
    };
    switch (component) {
        case i8:
            return scaled(load<std::int8_t>(at), 127);
        case u8:
            return scaled(load<std::uint8_t>(at), 255);
        case i16:
            return scaled(load<std::int16_t>(at), 32767);
        case u16:
            return scaled(load<std::uint16_t>(at), 65535);
        case f32:
            return load<float>(at);
        default:
            fail("a number has component type " + std::to_string(component) +
                 ", which is not supported");
    }
}

std::uint32_t load_index(std::uint64_t component, const char* at) {
    switch (component) {
        case u8:
            return load<std::uint8_t>(at);
        case u16:
            return load<std::uint16_t>(at);
        case u32:
            return load<std::uint32_t>(at);
        default:
            fail("an index has component type " + std::to_string(component) +
                 ", which is not supported");
    }
}

/// assimp has such a function, but does not export it.
std::string decode_base64(std::string_view text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos) break;  // padding
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 0xff);
    }
    return bytes;
}

std::string decode_percent(std::string_view uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const bool escaped =
            uri[i] == '%' && i + 2 < uri.size() &&
            std::sscanf(std::string(uri.substr(i + 1, 2)).c_str(), "%2x", &code) == 1;
        name += escaped ? static_cast<char>(code) : uri[i];
        if (escaped) i += 2;
    }
    return name;
}

/// Returns the name of the type whose elements have `width` numbers.
constexpr std::string_view type_of(std::size_t width) {
    return width == 3 ? "VEC3" : width == 4 ? "VEC4" : "MAT4";
}

/// Returns one element. It lies at `at`.
template <std::size_t Width>
std::array<double, Width> load_element(std::uint64_t component, const char* at, bool normalized) {
    const std::uint64_t bytes = size_of(component);
    std::array<double, Width> element{};
    for (std::size_t i = 0; i < Width; ++i) {
        element[i] = load_component(component, at + i * bytes, normalized);
    }
    return element;
}

}  // namespace

std::string read_bytes(const std::filesystem::path& path, InputFiles& files) {
    const std::uint64_t size = std::filesystem::file_size(path);
    files.note_opened(path, size);
    std::string bytes(size, '\0');
    std::ifstream stream(path, std::ios::binary);
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream) fail(path.filename().string() + " cannot be read completely");
    return bytes;
}

void GltfAccessors::read_buffers() {
    for (const JsonValue buffer : root_["buffers"].items()) {
        const std::string& uri = buffer["uri"].text();
        if (uri.empty()) {
            owned_.emplace_back();
            buffers_.push_back(buffers_.empty() ? binary_ : std::string_view());
            continue;
        }
        if (uri.starts_with("data:")) {
            const std::size_t comma = std::min(uri.find(','), uri.size() - 1);
            owned_.push_back(decode_base64(std::string_view(uri).substr(comma + 1)));
        } else {
            owned_.push_back(read_buffer_file(decode_percent(uri)));
        }
        buffers_.push_back(owned_.back());
    }
    // The bytes of a string may have moved with it.
    for (std::size_t i = 0; i < owned_.size(); ++i) {
        if (!owned_[i].empty()) buffers_[i] = owned_[i];
    }
}

std::string GltfAccessors::read_buffer_file(const std::string& name) const {
    const auto file = files_.find(path_.parent_path() / name);
    if (!file) {
        fail("buffer " + std::to_string(buffers_.size()) + ", " + name +
             ", cannot be opened or is not in the file's folder");
    }
    return read_bytes(*file, files_);
}

JsonValue GltfAccessors::find(std::uint64_t number) const {
    const JsonValue accessor = root_["accessors"][number];
    if (!accessor.exists()) fail("accessor " + std::to_string(number) + " does not exist");
    return accessor;
}

/// Returns the accessor, which must have the type.
JsonValue GltfAccessors::find(std::uint64_t number, std::string_view type) const {
    const JsonValue accessor = find(number);
    if (accessor["type"].text() != type) {
        fail("accessor " + std::to_string(number) + " is not a " + std::string(type));
    }
    return accessor;
}

std::uint64_t GltfAccessors::count_of(std::uint64_t number) const {
    return find(number)["count"].count("count", 0);
}

/// Finds the view of `name`, an accessor. Proves that it lies in its buffer.
GltfAccessors::View GltfAccessors::find_view(const std::string& name, std::uint64_t number) const {
    const JsonValue view = root_["bufferViews"][number];
    const std::uint64_t buffer = view["buffer"].count("buffer", buffers_.size());
    if (buffer >= buffers_.size()) fail(name + " is in a buffer that does not exist");
    const std::string_view bytes = buffers_[buffer];
    const std::string buffer_name = "buffer " + std::to_string(buffer);
    const std::uint64_t first = view["byteOffset"].count("byteOffset", 0);
    if (!view["byteLength"].exists()) return {bytes, first, buffer_name};
    const std::uint64_t length = view["byteLength"].count("byteLength", 0);
    const std::string view_name = "buffer view " + std::to_string(number);
    if (first > bytes.size() || length > bytes.size() - first) {
        fail(view_name + " declares " + std::to_string(length) + " bytes from byte " +
             std::to_string(first) + " of " + buffer_name + ", which has " +
             std::to_string(bytes.size()) + " bytes");
    }
    return {bytes.substr(first, length), 0, view_name};
}

/// Finds `count` elements of `width` components at `place`, an accessor or a part of a sparse
/// one. Proves that all of them lie in their view.
GltfAccessors::Place GltfAccessors::find_elements(const std::string& name, JsonValue place,
                                                  std::uint64_t component, std::uint64_t count,
                                                  std::uint64_t width) const {
    Place result;
    result.component = component;
    result.count = count;
    const std::uint64_t element = width * size_of(result.component);
    if (!place["bufferView"].exists()) fail(name + " has no data");
    const std::uint64_t number = place["bufferView"].count("bufferView", 0);
    const View view = find_view(name, number);
    result.stride = root_["bufferViews"][number]["byteStride"].count("byteStride", element);
    if (result.stride < element) fail(name + " has elements that overlap");
    const std::uint64_t offset = view.first + place["byteOffset"].count("byteOffset", 0);
    const std::uint64_t size = view.bytes.size();
    const bool fits =
        offset <= size && (result.count == 0 || size - offset >= element) &&
        (result.count == 0 || result.count - 1 <= (size - offset - element) / result.stride);
    if (!fits) {
        fail(name + " declares " + std::to_string(result.count) + " elements from byte " +
             std::to_string(offset) + " of " + view.name + ", which has " + std::to_string(size) +
             " bytes");
    }
    result.at = view.bytes.data() + offset;
    return result;
}

template <std::size_t Width>
std::vector<std::array<double, Width>> GltfAccessors::read(std::uint64_t number,
                                                           NoData no_data) const {
    const JsonValue accessor = find(number, type_of(Width));
    const std::string name = "accessor " + std::to_string(number);
    const std::uint64_t component = accessor["componentType"].count("componentType", 0);
    const std::uint64_t count = accessor["count"].count("count", 0);
    const JsonValue sparse = accessor["sparse"];
    const bool normalized = accessor["normalized"].is_true();
    std::vector<std::array<double, Width>> elements;
    const bool may_lack_data = sparse.exists() || no_data == NoData::zeros;
    if (accessor["bufferView"].exists() || !may_lack_data) {
        const Place all = find_elements(name, accessor, component, count, Width);
        elements.reserve(count);
        for (std::uint64_t i = 0; i < count; ++i) {
            elements.push_back(
                load_element<Width>(all.component, all.at + i * all.stride, normalized));
        }
    } else {
        elements.resize(count);
    }
    if (sparse.exists()) replace_some(name, accessor, elements);
    return elements;
}

template <std::size_t Width>
void GltfAccessors::replace_some(const std::string& name, JsonValue accessor,
                                 std::vector<std::array<double, Width>>& elements) const {
    const JsonValue sparse = accessor["sparse"];
    const std::uint64_t count = sparse["count"].count("count", 0);
    const bool normalized = accessor["normalized"].is_true();
    const Place numbers = find_elements(
        name, sparse["indices"], sparse["indices"]["componentType"].count("type", 0), count, 1);
    const Place values = find_elements(name, sparse["values"],
                                       accessor["componentType"].count("type", 0), count, Width);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t at = load_index(numbers.component, numbers.at + i * numbers.stride);
        if (at >= elements.size()) {
            fail(name + " replaces element " + std::to_string(at) + " of " +
                 std::to_string(elements.size()));
        }
        elements[at] =
            load_element<Width>(values.component, values.at + i * values.stride, normalized);
    }
}

template std::vector<std::array<double, 3>> GltfAccessors::read<3>(std::uint64_t, NoData) const;
template std::vector<std::array<double, 4>> GltfAccessors::read<4>(std::uint64_t, NoData) const;
template std::vector<std::array<double, 16>> GltfAccessors::read<16>(std::uint64_t, NoData) const;

std::vector<std::uint32_t> GltfAccessors::read_indices(std::uint64_t number) const {
    const JsonValue accessor = find(number, "SCALAR");
    const std::string name = "accessor " + std::to_string(number);
    if (accessor["sparse"].exists()) {
        fail(name + " of indices is sparse, which is not supported");
    }
    const Place list =
        find_elements(name, accessor, accessor["componentType"].count("componentType", 0),
                      accessor["count"].count("count", 0), 1);
    std::vector<std::uint32_t> indices;
    indices.reserve(list.count);
    for (std::uint64_t i = 0; i < list.count; ++i) {
        indices.push_back(load_index(list.component, list.at + i * list.stride));
    }
    return indices;
}

}  // namespace cdprep::import
