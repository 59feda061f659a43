// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "import/parse_number.h"
#include "import/plain_rows.h"
#include "import/read_ply_body.h"
#include "import/text_chunks.h"

namespace cdprep::import {
namespace {

/// Reads the rows of one chunk, whichever elements they belong to.
class PlyRowReader {
public:
    PlyRowReader(const PlyHeader& header, const RowChunk& rows, PolygonChunk& chunk)
        : elements_(header.elements),
          chunk_(chunk),
          at_(rows.text.data()),
          end_(at_ + rows.text.size()),
          row_(rows.first_row) {}

    std::optional<Fault> read() {
        std::uint64_t last = 0;  // row after the element's
        std::size_t element = 0;
        at_ = next_row(at_, end_);
        while (at_ < end_) {
            while (element < elements_.size() && row_ >= last) last += elements_[element++].count;
            if (row_ >= last) break;  // more rows than the header declares
            if (!read_row(elements_[element - 1])) return std::move(fault_);
            at_ = next_row(next_line(at_, end_), end_);
            ++row_;
        }
        return std::nullopt;
    }

private:
    bool fail(const PlyElement& element, std::size_t property) {
        at_ = skip_blanks(at_, end_);
        const bool ended = at_ == end_ || *at_ == '\n';
        fault_ = Fault{at_, "found " + (ended ? "the end of the line" : quoted_word(at_, end_)) +
                                "; expected '" + std::string(element.properties[property].name) +
                                "' of element '" + std::string(element.name) + "'"};
        return false;
    }

    bool read_row(const PlyElement& element) {
        switch (element.role) {
            case PlyRole::vertices:
                return read_vertex(element);
            case PlyRole::faces:
            case PlyRole::strips:
                return read_list(element);
            case PlyRole::other:
                return true;
        }
        return true;
    }

    bool read_vertex(const PlyElement& element) {
        if (element.x == 0 && element.y == 1 && element.z == 2) {
            if (const char* const next = take_vertex(at_, end_, chunk_)) {
                at_ = next;
                return true;
            }
        }
        mesh::Double3 position{0, 0, 0};
        const std::size_t last = std::max({element.x, element.y, element.z});
        for (std::size_t i = 0; i <= last; ++i) {
            const bool wanted = i == element.x || i == element.y || i == element.z;
            if (!wanted) {
                if (!skip_property(element.properties[i])) return fail(element, i);
                continue;
            }
            at_ = skip_blanks(at_, end_);
            const Number number = parse_number(at_, end_);
            if (!number.next) return fail(element, i);
            (i == element.x ? position.x : i == element.y ? position.y : position.z) = number.value;
            chunk_.single_precision = chunk_.single_precision && number.single;
            at_ = number.next;
        }
        chunk_.positions.push_back(position);
        return true;
    }

    bool read_list(const PlyElement& element) {
        if (element.role == PlyRole::faces && element.indices == 0) {
            if (const char* const next = take_triangle(at_, end_, chunk_)) {
                at_ = next;
                return true;
            }
        }
        for (std::size_t i = 0; i < element.indices; ++i) {
            if (!skip_property(element.properties[i])) return fail(element, i);
        }
        const WholeNumber size = take_whole_number();
        if (!size.next || size.value < 0) return fail(element, element.indices);
        const bool is_strip = element.role == PlyRole::strips;
        strip_.clear();
        for (std::int64_t i = 0; i < size.value; ++i) {
            const WholeNumber index = take_whole_number();
            if (!index.next) return fail(element, element.indices);
            if (is_strip) strip_.push_back(index.value);
            if (!is_strip) chunk_.add_corner(index.value, index.value);
        }
        if (is_strip) add_strip(strip_, chunk_);
        if (!is_strip) chunk_.end_face(static_cast<std::size_t>(size.value));
        return true;
    }

    WholeNumber take_whole_number() {
        at_ = skip_blanks(at_, end_);
        const WholeNumber number = parse_whole_number(at_, end_);
        if (number.next) at_ = number.next;
        return number;
    }

    bool skip_property(const PlyProperty& property) {
        std::int64_t words = 1;
        if (property.count_type != PlyType::none) {
            const WholeNumber count = take_whole_number();
            if (!count.next) return false;
            words = count.value;
        }
        for (; words > 0; --words) {
            at_ = skip_blanks(at_, end_);
            if (at_ == end_ || *at_ == '\n') return false;
            while (at_<end_&& static_cast<unsigned char>(*at_)> ' ') ++at_;
        }
        return true;
    }

    const std::vector<PlyElement>& elements_;
    PolygonChunk& chunk_;
    const char* at_;
    const char* end_;
    std::uint64_t row_;
    std::vector<std::int64_t> strip_;
    std::optional<Fault> fault_;
};

/// Returns the error for a file with fewer rows than its header declares, or nothing.
std::optional<Error> find_missing_rows(const SourceFile& file, const PlyHeader& header,
                                       std::uint64_t rows) {
    for (const PlyElement& element : header.elements) {
        if (rows < element.count) {
            return file.unreadable("the file ends after " + std::to_string(rows) + " of the " +
                                   std::to_string(element.count) +
                                   " lines that the header declares for element '" +
                                   std::string(element.name) + "'");
        }
        rows -= element.count;
    }
    return std::nullopt;
}

}  // namespace

Result<std::vector<PolygonChunk>> read_ply_text(const SourceFile& file, const PlyHeader& header,
                                                const ImportOptions& options) {
    const auto header_bytes = static_cast<std::size_t>(header.body - file.bytes().data());
    const std::vector<RowChunk> rows =
        split_rows(file.bytes().substr(header_bytes), options.parallel_for);
    const std::uint64_t count = rows.empty() ? 0 : rows.back().first_row + rows.back().row_count;
    if (auto missing = find_missing_rows(file, header, count)) return *std::move(missing);
    std::vector<PolygonChunk> chunks(rows.size());
    std::vector<std::optional<Fault>> faults(rows.size());
    options.parallel_for(rows.size(), [&](std::size_t i) {
        faults[i] = PlyRowReader(header, rows[i], chunks[i]).read();
    });
    for (const std::optional<Fault>& fault : faults) {
        if (fault) return file.unreadable_line(fault->at, fault->what);
    }
    return chunks;
}

}  // namespace cdprep::import
