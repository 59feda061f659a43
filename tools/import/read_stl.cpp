// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/readers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "cdprep/format/limits.h"
#include "import/join_chunks.h"
#include "import/parse_number.h"
#include "import/resize_large.h"
#include "import/text_chunks.h"

namespace cdprep::import {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kNormalBytes = 12;

std::uint32_t header_count(std::string_view bytes) noexcept {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof count, sizeof count);
    return count;
}

Result<mesh::TriangleSoup> read_binary(const SourceFile& file, const ImportOptions& options) {
    const std::string_view bytes = file.bytes();
    const std::size_t count = header_count(bytes);
    if (count > format::kMaxVertices / 3) {
        return file.over_budget("has " + std::to_string(count) + " triangles; at most " +
                                std::to_string(format::kMaxVertices / 3) + " are allowed");
    }
    const std::size_t needed = count * (3 * sizeof(mesh::Double3) + sizeof(mesh::Triangle));
    if (needed > options.memory_bytes) {
        return file.over_budget("needs " + std::to_string(needed >> 20) + " MiB of memory; " +
                                std::to_string(options.memory_bytes >> 20) +
                                " MiB are allowed. Raise --import-memory to read it");
    }
    mesh::TriangleSoup soup;
    soup.single_precision = true;
    resize_large(soup.positions, 3 * count);
    resize_large(soup.triangles, count);
    constexpr std::size_t kBlock = 16384;
    options.parallel_for((count + kBlock - 1) / kBlock, [&](std::size_t block) {
        const std::size_t last = std::min((block + 1) * kBlock, count);
        for (std::size_t i = block * kBlock; i < last; ++i) {
            std::array<float, 9> x;
            const char* const at = bytes.data() + kHeaderBytes + i * kTriangleBytes + kNormalBytes;
            std::memcpy(x.data(), at, sizeof x);
            for (std::size_t corner = 0; corner < 3; ++corner) {
                soup.positions[3 * i + corner] = {x[3 * corner], x[3 * corner + 1],
                                                  x[3 * corner + 2]};
            }
            const auto vertex = static_cast<std::uint32_t>(3 * i);
            soup.triangles[i] = {{vertex, vertex + 1, vertex + 2}};
        }
    });
    list_bad_numbers(soup, {}, options.parallel_for);
    return soup;
}

/// Returns true if a word of a file, in upper or lower case, equals a lower-case word.
bool is_word(std::string_view word, std::string_view lower) noexcept {
    return word.size() == lower.size() &&
           std::equal(word.begin(), word.end(), lower.begin(),
                      [](char a, char b) { return (a | 0x20) == b; });
}

std::string_view word_at(const char* at, const char* end) noexcept {
    const char* last = at;
    while (last<end&& static_cast<unsigned char>(*last)> ' ') ++last;
    return {at, static_cast<std::size_t>(last - at)};
}

const char* skip_space(const char* at, const char* end) noexcept {
    while (at < end && static_cast<unsigned char>(*at) <= ' ') ++at;
    return at;
}

/// Returns the place of a lower-case word, in upper or lower case, or `end`.
const char* find_word(std::string_view lower, const char* at, const char* end) noexcept {
    at = skip_space(at, end);
    while (at < end && !is_word(word_at(at, end), lower)) {
        at = skip_space(at + word_at(at, end).size(), end);
    }
    return at;
}

/// Reads facets word by word, because some files have a whole facet on one line. Words without a
/// position (normals, loops) are skipped.
class StlChunkReader {
public:
    StlChunkReader(std::string_view text, PolygonChunk& chunk)
        : chunk_(chunk), at_(text.data()), end_(at_ + text.size()), line_end_(at_) {
        chunk_.positions.reserve(text.size() / 60);
    }

    std::optional<Fault> read() {
        for (at_ = skip_space(at_, end_); at_ < end_; at_ = skip_space(at_, end_)) {
            const std::string_view word = word_at(at_, end_);
            const char* const start = at_;
            at_ += word.size();
            switch (word[0] | 0x20) {
                case 'v':
                    if (is_word(word, "vertex") && !read_vertex()) return std::move(fault_);
                    break;
                case 'f':
                    if (is_word(word, "facet") && !start_facet(start)) return std::move(fault_);
                    break;
                case 'e':
                    if (is_word(word, "endfacet") && !end_facet(start)) return std::move(fault_);
                    if (is_word(word, "endsolid")) end_solid();
                    break;
                case 's':
                    if (is_word(word, "solid")) start_solid();
                    break;
                default:
                    break;
            }
        }
        if (open_facet_) {
            (void)fail(open_facet_, "a facet without its endfacet: the file is cut off or damaged");
            return std::move(fault_);
        }
        if (!no_stray_vertex(end_)) return std::move(fault_);
        add_triangles();
        return std::nullopt;
    }

    [[nodiscard]] bool saw_end() const {
        return saw_end_;
    }

private:
    bool fail(const char* at, std::string what) {
        fault_ = Fault{at, std::move(what)};
        return false;
    }

    bool read_vertex() {
        std::array<double, 3> x{};
        for (double& value : x) {
            at_ = skip_space(at_, end_);
            const Number number = parse_number(at_, end_);
            if (!number.next) {
                return at_ == end_ ? fail(at_, "the file ends inside a vertex")
                                   : fail(at_, quoted_word(at_, end_) + " is not a number");
            }
            value = number.value;
            chunk_.single_precision = chunk_.single_precision && number.single;
            at_ = number.next;
        }
        chunk_.positions.push_back({x[0], x[1], x[2]});
        return true;
    }

    bool start_facet(const char* start) {
        if (open_facet_) {
            return fail(open_facet_, "a facet without its endfacet: the file is damaged");
        }
        if (!no_stray_vertex(start)) return false;
        open_facet_ = start;
        saw_end_ = false;
        return true;
    }

    bool no_stray_vertex(const char* place) {
        return chunk_.positions.size() == first_vertex_ ||
               fail(place, "a vertex that belongs to no facet");
    }

    bool end_facet(const char* start) {
        const std::size_t count = chunk_.positions.size() - first_vertex_;
        if (!open_facet_) return fail(start, "an endfacet without its facet");
        if (count != 3) {
            return fail(open_facet_,
                        "a facet has " + std::to_string(count) + " vertices; expected 3");
        }
        open_facet_ = nullptr;
        first_vertex_ = chunk_.positions.size();
        return true;
    }

    /// Returns the start of the line after that of at_. It is stored, because any number of solids
    /// may share a line.
    [[nodiscard]] const char* end_of_line() {
        if (at_ >= line_end_) line_end_ = next_line(at_, end_);
        return line_end_;
    }

    /// Returns the end of a solid's name at at_: the end of the line, or the first facet if a whole
    /// facet follows on the line. Names may have any words, and some files any number of solids on
    /// a line.
    [[nodiscard]] const char* end_of_name() {
        const char* const line_end = end_of_line();
        const char* facet = line_end;
        bool has_vertex = false;
        for (const char* at = skip_space(at_, line_end); at < line_end;) {
            const std::string_view word = word_at(at, line_end);
            if (is_word(word, "endfacet") && has_vertex) return facet;
            if (is_word(word, "facet")) {
                facet = at;
                has_vertex = false;
            }
            has_vertex = has_vertex || (facet < line_end && is_word(word, "vertex"));
            at = skip_space(at + word.size(), line_end);
        }
        return line_end;
    }

    void start_solid() {
        const char* const name_end = end_of_name();
        const std::string_view name = trimmed_line(at_, name_end);
        const auto triangle = static_cast<std::uint32_t>(chunk_.positions.size() / 3);
        chunk_.groups.push_back({triangle, std::string(name)});
        saw_end_ = false;
        at_ = name_end;
    }

    /// Another solid may begin on the line.
    void end_solid() {
        saw_end_ = true;
        const char* const name_end = end_of_name();
        const bool is_whole_line = name_end == end_of_line();
        at_ = is_whole_line ? name_end : find_word("solid", at_, name_end);
    }

    void add_triangles() {
        chunk_.triangle_count = chunk_.positions.size() / 3;
        chunk_.corners.resize(3 * chunk_.triangle_count);
        for (std::size_t i = 0; i < chunk_.corners.size(); ++i) {
            chunk_.corners[i] = PolygonChunk::kFromChunkStart | static_cast<std::uint32_t>(i);
        }
    }

    PolygonChunk& chunk_;
    const char* at_;
    const char* end_;
    const char* line_end_;  ///< of the last line asked for
    const char* open_facet_ = nullptr;
    std::size_t first_vertex_ = 0;
    bool saw_end_ = false;
    std::optional<Fault> fault_;
};

bool starts_facet(const char* line, const char* end) noexcept {
    return is_word(word_at(skip_space(line, end), end), "facet");
}

Result<mesh::TriangleSoup> read_text(const SourceFile& file, const ImportOptions& options) {
    const std::vector<std::string_view> texts =
        split_lines(without_byte_order_mark(file.bytes()), starts_facet);
    std::vector<PolygonChunk> chunks(texts.size());
    std::vector<std::optional<Fault>> faults(texts.size());
    std::vector<std::uint8_t> ended(texts.size(), 0);
    options.parallel_for(texts.size(), [&](std::size_t i) {
        StlChunkReader reader(texts[i], chunks[i]);
        faults[i] = reader.read();
        ended[i] = reader.saw_end();
    });
    for (const std::optional<Fault>& fault : faults) {
        if (fault) return file.unreadable_line(fault->at, fault->what);
    }
    if (!ended.back()) {
        return file.unreadable_line(file.bytes().data() + file.bytes().size(),
                                    "the file ends without endsolid: it is cut off");
    }
    return join_chunks(
        file, std::move(chunks),
        {.memory_bytes = options.memory_bytes, .parallel_for = options.parallel_for});
}

}  // namespace

bool is_binary_stl(std::string_view bytes) noexcept {
    return bytes.size() >= kHeaderBytes &&
           bytes.size() == kHeaderBytes + kTriangleBytes * std::size_t{header_count(bytes)};
}

bool looks_like_text_stl(std::string_view bytes) noexcept {
    constexpr std::size_t kLookedAt = 1024;  // names may be long
    bytes = without_byte_order_mark(bytes);
    const char* const end = bytes.data() + std::min(bytes.size(), kLookedAt);
    const char* at = skip_space(bytes.data(), end);
    const std::string_view first = word_at(at, end);
    if (!is_word(first, "solid")) return false;
    if (std::find(at, end, '\0') != end) return false;
    if (bytes.size() < kHeaderBytes) return true;
    // The first line may have a facet too.
    for (at = skip_space(at + first.size(), end); at < end; at = skip_space(at, end)) {
        const std::string_view word = word_at(at, end);
        if (is_word(word, "facet") || is_word(word, "endsolid")) return true;
        at += word.size();
    }
    return false;
}

Result<mesh::TriangleSoup> read_stl(const SourceFile& file, const ImportOptions& options) {
    const std::string_view bytes = file.bytes();
    if (is_binary_stl(bytes)) return read_binary(file, options);
    if (looks_like_text_stl(bytes)) return read_text(file, options);
    if (bytes.size() < kHeaderBytes) {
        return file.unreadable("has " + std::to_string(bytes.size()) +
                               " bytes; the header of an STL file alone has " +
                               std::to_string(kHeaderBytes));
    }
    const std::uint64_t count = header_count(bytes);
    return file.unreadable("the header declares " + std::to_string(count) +
                           " triangles, which take " +
                           std::to_string(kHeaderBytes + kTriangleBytes * count) +
                           " bytes, but the file has " + std::to_string(bytes.size()));
}

}  // namespace cdprep::import
