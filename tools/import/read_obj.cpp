// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/readers.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "import/join_chunks.h"
#include "import/parse_number.h"
#include "import/text_chunks.h"

namespace cdprep::import {
namespace {

constexpr std::array<std::string_view, 28> kStatements = {
    "v",    "vt",   "vn",     "vp",     "f",      "fo",     "l",      "p",   "g",    "o",
    "s",    "mg",   "usemtl", "usemap", "mtllib", "maplib", "cstype", "deg", "curv", "curv2",
    "surf", "parm", "trim",   "hole",   "scrv",   "sp",     "end",    "con"};

/// An error that stops the reading of a line.
/// Returns true if a backslash precedes the line end at `feed`, so that the line continues.
bool is_continued(const char* begin, const char* feed) noexcept {
    if (feed > begin && feed[-1] == '\r') --feed;
    return feed > begin && feed[-1] == '\\';
}

/// Skips blanks and backslashes at line ends.
const char* skip_to_word(const char* at, const char* end) noexcept {
    while (at < end) {
        if (is_blank(*at)) {
            ++at;
        } else if (*at == '\\') {
            const char* after = at + 1;
            if (after < end && *after == '\r') ++after;
            if (after < end && *after != '\n') return at;
            at = after < end ? after + 1 : end;
        } else {
            break;
        }
    }
    return at;
}

bool ends_statement(const char* at, const char* end) noexcept {
    return at >= end || *at == '\n' || *at == '#';
}

bool ends_word(const char* at, const char* end) noexcept {
    return at >= end || static_cast<unsigned char>(*at) <= ' ' || *at == '\\' || *at == '#';
}

/// Reads the statements of one chunk of whole lines.
class ObjChunkReader {
public:
    ObjChunkReader(std::string_view text, PolygonChunk& chunk)
        : chunk_(chunk), at_(text.data()), end_(at_ + text.size()) {
        // Half of the text may be vertices of 30 bytes each, half faces of 25.
        chunk_.positions.reserve(text.size() / 60);
        chunk_.corners.reserve(3 * text.size() / 25);
    }

    std::optional<Fault> read() {
        while (at_ < end_) {
            const char first = *at_;
            const bool one_letter = ends_word(at_ + 1, end_);
            if (first == 'v' && one_letter) {
                ++at_;
                if (!read_vertex()) return std::move(fault_);
            } else if (first == 'f' && one_letter) {
                ++at_;
                if (!read_face()) return std::move(fault_);
            } else if (is_blank(first)) {
                ++at_;
                continue;
            } else {
                read_names();
            }
            at_ = next_line(at_, end_);
        }
        return std::nullopt;
    }

private:
    bool fail(std::string what) {
        fault_ = Fault{at_, std::move(what)};
        return false;
    }

    bool read_vertex() {
        std::array<double, 3> x{};
        bool single = true;
        const char* at = at_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at = skip_to_word(at, end_);
            const Number number = parse_number(at, end_);
            if (!number.next) {
                at_ = at;
                return fail_vertex(axis);
            }
            x[axis] = number.value;
            single = single && number.single;
            at = number.next;
        }
        at_ = at;
        chunk_.positions.push_back({x[0], x[1], x[2]});
        chunk_.single_precision = chunk_.single_precision && single;
        return true;
    }

    bool fail_vertex(std::size_t axis) {
        if (!ends_statement(at_, end_)) return fail(quoted_word(at_, end_) + " is not a number");
        return fail("a vertex has " + std::to_string(axis) + " coordinates; expected 3");
    }

    /// Reads the usual face: three numbers from 1 on, perhaps with slashes. Returns false and
    /// reads nothing for any other face.
    bool read_plain_triangle() {
        constexpr std::ptrdiff_t kMaxDigits = 9;  // below kFromChunkStart
        std::array<std::uint32_t, 3> corners{};
        const char* at = at_;
        for (std::uint32_t& corner : corners) {
            while (at < end_ && *at == ' ') ++at;
            std::uint64_t index = 0;
            const char* const digits = at;
            at = take_digits(at, end_, index);
            if (index == 0 || at - digits > kMaxDigits) return false;
            if (at < end_ && *at == '/') {
                while (at < end_ && (detail::is_digit(*at) || *at == '/' || *at == '-')) ++at;
            }
            corner = static_cast<std::uint32_t>(index - 1);
        }
        while (at < end_ && is_blank(*at)) ++at;
        if (at < end_ && *at != '\n') return false;
        chunk_.corners.insert(chunk_.corners.end(), corners.begin(), corners.end());
        chunk_.end_face(3);
        at_ = at;
        return true;
    }

    bool read_face() {
        if (read_plain_triangle()) return true;
        const std::size_t first = chunk_.corners.size();
        for (;;) {
            at_ = skip_to_word(at_, end_);
            if (ends_statement(at_, end_)) break;
            if (!read_corner()) return fail(quoted_word(at_, end_) + " is not a corner of a face");
        }
        chunk_.end_face(chunk_.corners.size() - first);
        return true;
    }

    /// Reads v, v/vt, v//vn or v/vt/vn; only v matters.
    bool read_corner() {
        const char* at = at_;
        const bool negative = *at == '-';
        if (negative || *at == '+') ++at;
        std::uint64_t index = 0;
        const char* const digits = at;
        at = take_digits(at, end_, index);
        if (at == digits || at - digits > 18) return false;
        if (at < end_ && *at == '/') {
            while (!ends_word(at, end_)) ++at;
        }
        if (!ends_word(at, end_)) return false;
        add_corner(negative ? -static_cast<std::int64_t>(index) : static_cast<std::int64_t>(index));
        at_ = at;
        return true;
    }

    void add_corner(std::int64_t index) {
        if (index >= 0) {
            chunk_.add_corner(index, index - 1);
            return;
        }
        const auto vertex = static_cast<std::int64_t>(chunk_.positions.size()) + index;
        if (vertex >= 0) {
            chunk_.corners.push_back(PolygonChunk::kFromChunkStart |
                                     static_cast<std::uint32_t>(vertex));
        } else {
            chunk_.odd.push_back({chunk_.corners.size(), index, vertex, true});
            chunk_.corners.push_back(0);
        }
    }

    /// Reads g, o and usemtl; leaves any other line unread.
    void read_names() {
        const char first = *at_;
        if (first != 'g' && first != 'o' && first != 'u') return;
        const std::string_view line = trimmed_line(at_, end_);
        const std::size_t word = std::min(line.find_first_of(" \t"), line.size());
        std::size_t name = std::min(line.find_first_not_of(" \t", word), line.size());
        const std::string_view keyword = line.substr(0, word);
        const auto triangle = static_cast<std::uint32_t>(chunk_.triangle_count);
        if (keyword == "usemtl") {
            chunk_.materials.push_back({triangle, std::string(line.substr(name))});
        } else if (keyword == "g" || keyword == "o") {
            chunk_.groups.push_back(
                {triangle, name == line.size() ? "default" : std::string(line.substr(name))});
        }
    }

    PolygonChunk& chunk_;
    const char* at_;
    const char* end_;
    std::optional<Fault> fault_;
};

}  // namespace

Result<mesh::TriangleSoup> read_obj(const SourceFile& file, const ImportOptions& options) {
    constexpr std::size_t kLookedAt = 4096;
    const char* const begin = file.bytes().data();
    if (const std::size_t zero = file.bytes().substr(0, kLookedAt).find('\0');
        zero != std::string_view::npos) {
        return file.unreadable("byte " + std::to_string(zero) +
                               " is zero: the file is not OBJ text");
    }
    const std::vector<std::string_view> texts =
        split_lines(without_byte_order_mark(file.bytes()),
                    [&](const char* line, const char*) { return !is_continued(begin, line - 1); });
    std::vector<PolygonChunk> chunks(texts.size());
    std::vector<std::optional<Fault>> faults(texts.size());
    options.parallel_for(texts.size(), [&](std::size_t i) {
        faults[i] = ObjChunkReader(texts[i], chunks[i]).read();
    });
    for (const std::optional<Fault>& fault : faults) {
        if (fault) return file.unreadable_line(fault->at, fault->what);
    }
    return join_chunks(file, std::move(chunks),
                       {.first_index = 1,
                        .memory_bytes = options.memory_bytes,
                        .parallel_for = options.parallel_for});
}

bool looks_like_obj(std::string_view bytes) noexcept {
    constexpr std::size_t kLookedAt = 65536;
    bytes = without_byte_order_mark(bytes);
    const bool is_cut = bytes.size() > kLookedAt;
    const char* at = bytes.data();
    const char* const end = at + std::min(bytes.size(), kLookedAt);
    bool continued = false;
    for (; at < end; at = next_line(at, end)) {
        const std::string_view line = trimmed_line(at, end);
        if (line.find('\0') != std::string_view::npos) return false;
        const std::string_view word = line.substr(0, line.find_first_of(" \t\\"));
        const bool is_last = is_cut && at + line.size() + 2 >= end;
        const bool known =
            std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end();
        if (!continued && word == "v") return true;
        if (!continued && !is_last && !line.empty() && line[0] != '#' && !known) return false;
        continued = !line.empty() && line.back() == '\\';
    }
    return false;
}

}  // namespace cdprep::import
