// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/readers.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "import/join_chunks.h"
#include "import/parse_number.h"
#include "import/plain_rows.h"
#include "import/text_chunks.h"

namespace cdprep::import {
namespace {

struct Header {
    std::string_view prefix;  ///< before OFF
    std::uint64_t vertices = 0;
    std::uint64_t faces = 0;
    const char* body = nullptr;
};

/// Returns the length of the keyword at `at`, or 0. Digits may follow it directly.
std::size_t keyword_length(const char* at, const char* end) noexcept {
    constexpr std::string_view kPrefixLetters = "STCN4n";
    constexpr std::size_t kMaxPrefix = 6;
    const std::string_view text(at, static_cast<std::size_t>(end - at));
    const std::size_t prefix = std::min(text.find_first_not_of(kPrefixLetters), text.size());
    return prefix <= kMaxPrefix && text.substr(prefix, 3) == "OFF" ? prefix + 3 : 0;
}

/// Reads the header: an optional keyword, the counts of vertices and faces, and perhaps of edges.
std::optional<Fault> read_header(std::string_view text, Header& header) {
    text = without_byte_order_mark(text);
    const char* const end = text.data() + text.size();
    const char* at = next_row(text.data(), end);
    if (const std::size_t length = keyword_length(at, end)) {
        header.prefix = {at, length - 3};
        at = next_row(at + length, end);
    }
    if (header.prefix.find_first_of("4n") != std::string_view::npos) {
        return Fault{at, "the dimension of the OFF file is not 3"};
    }
    if (std::string_view(at, static_cast<std::size_t>(end - at)).starts_with("BINARY")) {
        return Fault{at, "binary OFF files are not supported. Save the file as text"};
    }
    for (std::uint64_t* count : {&header.vertices, &header.faces}) {
        at = next_row(at, end);
        const WholeNumber number = parse_whole_number(at, end);
        if (!number.next || number.value < 0) {
            return Fault{at, at == end ? "the file ends inside the OFF header"
                                       : quoted_word(at, end) + " is not a count of an OFF header"};
        }
        *count = static_cast<std::uint64_t>(number.value);
        at = number.next;
    }
    header.body = next_line(at, end);
    return std::nullopt;
}

/// Reads the rows of one chunk: first vertices, then faces.
class OffChunkReader {
public:
    OffChunkReader(const Header& header, const RowChunk& rows, PolygonChunk& chunk)
        : header_(header),
          chunk_(chunk),
          row_(rows.first_row),
          at_(rows.text.data()),
          end_(at_ + rows.text.size()) {
        // Rows of about 28 bytes.
        const bool has_vertices = rows.first_row < header.vertices;
        if (has_vertices) chunk_.positions.reserve(rows.text.size() / 28);
        if (!has_vertices) chunk_.corners.reserve(3 * rows.text.size() / 28);
    }

    std::optional<Fault> read() {
        const std::uint64_t last = header_.vertices + header_.faces;
        for (at_ = next_row(at_, end_); at_ < end_ && row_ < last; ++row_) {
            if (!(row_ < header_.vertices ? read_vertex() : read_face())) {
                return std::move(fault_);
            }
            at_ = next_row(next_line(at_, end_), end_);
        }
        return std::nullopt;
    }

private:
    bool fail(std::string_view needed) {
        at_ = skip_blanks(at_, end_);
        const bool ended = at_ == end_ || *at_ == '\n' || *at_ == '#';
        fault_ = Fault{at_, "found " + (ended ? "the end of the line" : quoted_word(at_, end_)) +
                                "; expected " + std::string(needed)};
        return false;
    }

    bool read_vertex() {
        if (const char* const next = take_vertex(at_, end_, chunk_)) {
            at_ = next;
            return true;
        }
        for (int axis = 0; axis < 3; ++axis) {
            at_ = skip_blanks(at_, end_);
            const Number number = parse_number(at_, end_);
            if (!number.next) break;
            at_ = number.next;
        }
        return fail("a coordinate of a vertex");
    }

    bool read_face() {
        if (const char* const next = take_triangle(at_, end_, chunk_)) {
            at_ = next;
            return true;
        }
        const WholeNumber size = parse_whole_number(at_, end_);
        if (!size.next || size.value < 0) return fail("the number of corners of a face");
        at_ = size.next;
        for (std::int64_t i = 0; i < size.value; ++i) {
            at_ = skip_blanks(at_, end_);
            const WholeNumber index = parse_whole_number(at_, end_);
            if (!index.next) {
                return fail("corner " + std::to_string(i + 1) + " of " +
                            std::to_string(size.value) + " of a face");
            }
            chunk_.add_corner(index.value, index.value);
            at_ = index.next;
        }
        chunk_.end_face(static_cast<std::size_t>(size.value));
        return true;
    }

    const Header& header_;
    PolygonChunk& chunk_;
    std::uint64_t row_;
    const char* at_;
    const char* end_;
    std::optional<Fault> fault_;
};

/// Reads a body whose rows are not lines. It must consist of exactly the numbers that the counts of
/// the header require. A file with colours or normals must be read by lines.
class FreeFormReader {
public:
    FreeFormReader(const Header& header, const char* end)
        : header_(header), at_(header.body), end_(end) {}

    std::optional<PolygonChunk> read() {
        if (!header_.prefix.empty()) return std::nullopt;
        for (std::uint64_t i = 0; i < header_.vertices; ++i) {
            if (!read_vertex()) return std::nullopt;
        }
        for (std::uint64_t i = 0; i < header_.faces; ++i) {
            if (!read_face()) return std::nullopt;
        }
        if (next_row(at_, end_) != end_) return std::nullopt;
        return std::move(chunk_);
    }

private:
    bool read_vertex() {
        std::array<double, 3> p{};
        for (double& coordinate : p) {
            at_ = next_row(at_, end_);
            const Number number = parse_number(at_, end_);
            if (!number.next) return false;
            coordinate = number.value;
            chunk_.single_precision &= number.single;
            at_ = number.next;
        }
        chunk_.positions.push_back({p[0], p[1], p[2]});
        return true;
    }

    bool read_index(std::int64_t& index) {
        at_ = next_row(at_, end_);
        const WholeNumber number = parse_whole_number(at_, end_);
        if (!number.next) return false;
        index = number.value;
        at_ = number.next;
        return true;
    }

    bool read_face() {
        std::int64_t size = 0;
        if (!read_index(size) || size < 0) return false;
        for (std::int64_t i = 0; i < size; ++i) {
            std::int64_t index = 0;
            if (!read_index(index)) return false;
            chunk_.add_corner(index, index);
        }
        chunk_.end_face(static_cast<std::size_t>(size));
        return true;
    }

    const Header& header_;
    const char* at_;
    const char* end_;
    PolygonChunk chunk_;
};

/// Reads a file as numbers alone after reading by lines failed. If this fails too, returns the
/// error of reading by lines, because most files have lines.
Result<mesh::TriangleSoup> read_free_form(const SourceFile& file, const Header& header,
                                          const ImportOptions& options, Error by_lines) {
    const char* const end = file.bytes().data() + file.bytes().size();
    std::optional<PolygonChunk> chunk = FreeFormReader(header, end).read();
    if (!chunk) return by_lines;
    std::vector<PolygonChunk> chunks;
    chunks.push_back(*std::move(chunk));
    return join_chunks(
        file, std::move(chunks),
        {.memory_bytes = options.memory_bytes, .parallel_for = options.parallel_for});
}

Error too_short(const SourceFile& file, const Header& header, std::uint64_t rows) {
    const std::string end = "; the file is cut off, or its header is wrong";
    if (rows < header.vertices) {
        return file.unreadable("the file has " + std::to_string(rows) +
                               " lines after the header, which declares " +
                               std::to_string(header.vertices) + " vertices and " +
                               std::to_string(header.faces) + " faces" + end);
    }
    return file.unreadable("the file ends after face " + std::to_string(rows - header.vertices) +
                           " of " + std::to_string(header.faces) + end);
}

}  // namespace

Result<mesh::TriangleSoup> read_off(const SourceFile& file, const ImportOptions& options) {
    Header header;
    if (const auto fault = read_header(file.bytes(), header)) {
        return file.unreadable_line(fault->at, fault->what);
    }
    const auto header_bytes = static_cast<std::size_t>(header.body - file.bytes().data());
    const std::vector<RowChunk> rows =
        split_rows(file.bytes().substr(header_bytes), options.parallel_for);
    const std::uint64_t count = rows.empty() ? 0 : rows.back().first_row + rows.back().row_count;
    if (count < header.vertices || count - header.vertices < header.faces) {
        return read_free_form(file, header, options, too_short(file, header, count));
    }
    std::vector<PolygonChunk> chunks(rows.size());
    std::vector<std::optional<Fault>> faults(rows.size());
    options.parallel_for(rows.size(), [&](std::size_t i) {
        faults[i] = OffChunkReader(header, rows[i], chunks[i]).read();
    });
    for (const std::optional<Fault>& fault : faults) {
        if (!fault) continue;
        return read_free_form(file, header, options, file.unreadable_line(fault->at, fault->what));
    }
    return join_chunks(
        file, std::move(chunks),
        {.memory_bytes = options.memory_bytes, .parallel_for = options.parallel_for});
}

bool looks_like_off(std::string_view bytes) noexcept {
    constexpr std::size_t kLookedAt = 65536;
    bytes = without_byte_order_mark(bytes);
    const char* const end = bytes.data() + std::min(bytes.size(), kLookedAt);
    const char* const at = next_row(bytes.data(), end);
    const std::size_t length = keyword_length(at, end);
    return length > 0 && (at + length == end || static_cast<unsigned char>(at[length]) <= ' ' ||
                          detail::is_digit(at[length]) || at[length] == '#');
}

}  // namespace cdprep::import
