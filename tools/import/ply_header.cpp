// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/ply_header.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "import/parse_number.h"
#include "import/text_chunks.h"

namespace cdprep::import {
namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr std::array<TypeName, 16> kTypeNames = {{
    {"char", PlyType::i8},
    {"int8", PlyType::i8},
    {"uchar", PlyType::u8},
    {"uint8", PlyType::u8},
    {"short", PlyType::i16},
    {"int16", PlyType::i16},
    {"ushort", PlyType::u16},
    {"uint16", PlyType::u16},
    {"int", PlyType::i32},
    {"int32", PlyType::i32},
    {"uint", PlyType::u32},
    {"uint32", PlyType::u32},
    {"float", PlyType::f32},
    {"float32", PlyType::f32},
    {"double", PlyType::f64},
    {"float64", PlyType::f64},
}};

PlyType type_named(std::string_view name) noexcept {
    const auto found = std::find_if(kTypeNames.begin(), kTypeNames.end(),
                                    [&](const TypeName& entry) { return entry.name == name; });
    return found == kTypeNames.end() ? PlyType::none : found->type;
}

bool is_integer(PlyType type) noexcept {
    return type != PlyType::none && type < PlyType::f32;
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = line.find_first_not_of(" \t"); at < line.size();) {
        const std::size_t last = std::min(line.find_first_of(" \t", at), line.size());
        words.push_back(line.substr(at, last - at));
        at = line.find_first_not_of(" \t", last);
    }
    return words;
}

std::optional<std::size_t> place_of(const PlyElement& element, std::string_view name) {
    const auto found =
        std::find_if(element.properties.begin(), element.properties.end(),
                     [&](const PlyProperty& property) { return property.name == name; });
    if (found == element.properties.end()) return std::nullopt;
    return static_cast<std::size_t>(found - element.properties.begin());
}

/// Sets the role of the element. Returns a description of its error, or "".
std::string assign_role(PlyElement& element) {
    if (element.name == "vertex") {
        const auto x = place_of(element, "x");
        const auto y = place_of(element, "y");
        const auto z = place_of(element, "z");
        if (!x || !y || !z) return "the vertices lack x, y or z";
        element.x = *x, element.y = *y, element.z = *z;
        for (const std::size_t i : {*x, *y, *z}) {
            if (element.properties[i].count_type != PlyType::none) return "a coordinate is a list";
        }
        element.role = PlyRole::vertices;
        return {};
    }
    auto indices = place_of(element, "vertex_indices");
    if (!indices) indices = place_of(element, "vertex_index");
    if (!indices) return {};
    const PlyProperty& list = element.properties[*indices];
    if (!is_integer(list.count_type) || !is_integer(list.type)) {
        return "the vertex numbers of element '" + std::string(element.name) +
               "' are not a list of whole numbers";
    }
    element.indices = *indices;
    if (element.name == "face") element.role = PlyRole::faces;
    if (element.name == "tristrips") element.role = PlyRole::strips;
    return {};
}

/// Reads one line after another into a PlyHeader.
class HeaderReader {
public:
    explicit HeaderReader(const SourceFile& file) : file_(file) {}

    Result<PlyHeader> read() {
        const char* at = file_.bytes().data();
        const char* const end = at + file_.bytes().size();
        for (at = next_line(at, end); at < end; at = next_line(at, end)) {
            const std::string_view line = trimmed_line(at, end);
            if (line == "end_header") {
                header_.body = next_line(at, end);
                return finish(at);
            }
            if (std::string what = add_line(line); !what.empty()) {
                return file_.unreadable_line(at, what);
            }
        }
        return file_.unreadable_line(end, "the file ends inside the PLY header");
    }

private:
    std::string add_line(std::string_view line) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return {};
        if (words[0] == "format" && words.size() >= 2) return set_format(words[1]);
        if (words[0] == "element" && words.size() == 3) return add_element(words[1], words[2]);
        if (words[0] == "property" && words.size() >= 3) return add_property(words);
        return "the PLY header has an invalid line that begins with " +
               quoted_word(line.data(), line.data() + line.size());
    }

    std::string set_format(std::string_view name) {
        has_format_ = true;
        if (name == "ascii") return {};
        header_.format = name == "binary_big_endian" ? PlyHeader::Format::big_endian
                                                     : PlyHeader::Format::little_endian;
        if (name == "binary_little_endian" || name == "binary_big_endian") return {};
        return "unknown PLY format " + quoted_word(name.data(), name.data() + name.size());
    }

    std::string add_element(std::string_view name, std::string_view count) {
        const WholeNumber number = parse_whole_number(count.data(), count.data() + count.size());
        if (!number.next || number.value < 0) {
            return quoted_word(count.data(), count.data() + count.size()) + " is not a count";
        }
        header_.elements.push_back({});
        header_.elements.back().name = name;
        header_.elements.back().count = static_cast<std::uint64_t>(number.value);
        return {};
    }

    std::string add_property(const std::vector<std::string_view>& words) {
        if (header_.elements.empty()) return "a property comes before the first element";
        const bool is_list = words[1] == "list";
        if (words.size() != (is_list ? 5 : 3)) return "a property has too many or too few words";
        const PlyProperty property{words.back(), type_named(words[words.size() - 2]),
                                   is_list ? type_named(words[2]) : PlyType::none};
        if (property.type == PlyType::none || (is_list && !is_integer(property.count_type))) {
            return "a property has an unknown type";
        }
        header_.elements.back().properties.push_back(property);
        return {};
    }

    Result<PlyHeader> finish(const char* at) {
        if (!has_format_) return file_.unreadable_line(at, "the PLY header has no format line");
        std::size_t vertex_elements = 0;
        for (PlyElement& element : header_.elements) {
            if (std::string what = assign_role(element); !what.empty()) {
                return file_.unreadable_line(at, what);
            }
            if (element.role == PlyRole::vertices) ++vertex_elements;
        }
        if (vertex_elements != 1) {
            return file_.unreadable_line(at, "the PLY header has " +
                                                 std::to_string(vertex_elements) +
                                                 " elements 'vertex'; expected 1");
        }
        return std::move(header_);
    }

    const SourceFile& file_;
    PlyHeader header_;
    bool has_format_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) noexcept {
    constexpr std::array<std::size_t, 9> kSizes = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::least_bytes() const noexcept {
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties) {
        const bool is_list = property.count_type != PlyType::none;
        bytes += size_of(is_list ? property.count_type : property.type);
    }
    return bytes;
}

Result<PlyHeader> read_ply_header(const SourceFile& file) {
    return HeaderReader(file).read();
}

}  // namespace cdprep::import
