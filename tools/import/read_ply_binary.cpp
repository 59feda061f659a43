// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "import/read_ply_body.h"
#include "import/resize_large.h"

namespace cdprep::import {
namespace {

constexpr std::size_t kRecordsPerBlock = 16384;  // records that one parallel step reads

/// Returns the number at `at` in the file, converted to this machine's byte order if `swap`.
template <class T>
T load(const char* at, bool swap) noexcept {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if (swap) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

double load_number(PlyType type, const char* at, bool swap) noexcept {
    switch (type) {
        case PlyType::i8:
            return load<std::int8_t>(at, swap);
        case PlyType::u8:
            return load<std::uint8_t>(at, swap);
        case PlyType::i16:
            return load<std::int16_t>(at, swap);
        case PlyType::u16:
            return load<std::uint16_t>(at, swap);
        case PlyType::i32:
            return load<std::int32_t>(at, swap);
        case PlyType::u32:
            return load<std::uint32_t>(at, swap);
        case PlyType::f32:
            return load<float>(at, swap);
        case PlyType::f64:
            return load<double>(at, swap);
        case PlyType::none:
            break;
    }
    return 0;
}

/// Returns the whole number at `at`. Requires an integer type.
std::int64_t load_whole(PlyType type, const char* at, bool swap) noexcept {
    switch (type) {
        case PlyType::i32:
            return load<std::int32_t>(at, swap);
        case PlyType::u32:
            return load<std::uint32_t>(at, swap);
        default:
            return static_cast<std::int64_t>(load_number(type, at, swap));
    }
}

bool is_always_single(PlyType type) noexcept {
    return type != PlyType::f64 && type != PlyType::i32 && type != PlyType::u32;
}

bool has_lists(const PlyElement& element) noexcept {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [](const PlyProperty& p) { return p.count_type != PlyType::none; });
}

/// Reads the elements of a body one after the other.
class PlyRecordReader {
public:
    PlyRecordReader(const SourceFile& file, const PlyHeader& header, const ImportOptions& options)
        : file_(file),
          header_(header),
          options_(options),
          swap_((header.format == PlyHeader::Format::big_endian) ==
                (std::endian::native == std::endian::little)),
          at_(header.body),
          end_(file.bytes().data() + file.bytes().size()) {}

    Result<std::vector<PolygonChunk>> read() {
        chunks_.resize(1);  // of the vertices
        for (const PlyElement& element : header_.elements) {
            const std::size_t least = element.least_bytes();
            if (least > 0 && element.count > bytes_left() / least) return too_short(element);
            if (!read_element(element)) return std::move(*error_);
        }
        return std::move(chunks_);
    }

private:
    [[nodiscard]] std::size_t bytes_left() const {
        return static_cast<std::size_t>(end_ - at_);
    }

    Error too_short(const PlyElement& element) const {
        return file_.unreadable("the header declares " + std::to_string(element.count) +
                                " of element '" + std::string(element.name) +
                                "', which take at least " + std::to_string(element.least_bytes()) +
                                " bytes each, but only " + std::to_string(bytes_left()) +
                                " bytes follow");
    }

    bool read_element(const PlyElement& element) {
        const bool flat = !has_lists(element);
        if (flat && element.role == PlyRole::vertices) return read_flat_vertices(element);
        if (flat) {
            at_ += element.count * element.least_bytes();
            return true;
        }
        if (element.role == PlyRole::faces && read_triangles(element)) return true;
        return read_records(element);
    }

    bool read_flat_vertices(const PlyElement& element) {
        std::vector<std::size_t> offsets;
        std::size_t stride = 0;
        for (const PlyProperty& property : element.properties) {
            offsets.push_back(stride);
            stride += size_of(property.type);
        }
        const std::array<std::size_t, 3> places = {element.x, element.y, element.z};
        PolygonChunk& chunk = chunks_.front();
        resize_large(chunk.positions, element.count);
        std::atomic<bool> single = true;
        options_.parallel_for(
            (element.count + kRecordsPerBlock - 1) / kRecordsPerBlock, [&](std::size_t block) {
                const std::size_t last =
                    std::min<std::size_t>((block + 1) * kRecordsPerBlock, element.count);
                bool all_single = true;
                for (std::size_t i = block * kRecordsPerBlock; i < last; ++i) {
                    std::array<double, 3> x{};
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        const char* const at = at_ + i * stride + offsets[places[axis]];
                        const PlyType type = element.properties[places[axis]].type;
                        x[axis] = load_number(type, at, swap_);
                        all_single = all_single && counts_as_single(type, x[axis]);
                    }
                    chunk.positions[i] = {x[0], x[1], x[2]};
                }
                if (!all_single) single = false;
            });
        chunk.single_precision = single;
        at_ += element.count * stride;
        return true;
    }

    /// Returns true if a value counts as a float. Binary doubles stay doubles, whatever their
    /// value; integers count if they fit.
    static bool counts_as_single(PlyType type, double value) {
        return is_always_single(type) ||
               (type != PlyType::f64 && static_cast<double>(static_cast<float>(value)) == value);
    }

    /// Reads faces in parallel if all are triangles. The test assumes records of three corners:
    /// if every count at its place in this layout is 3, every record does start there.
    bool read_triangles(const PlyElement& element) {
        const PlyProperty& list = element.properties[element.indices];
        std::size_t before = 0;
        std::size_t stride = 3 * size_of(list.type);
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            const bool is_list = property.count_type != PlyType::none;
            if (is_list && i != element.indices) return false;
            const std::size_t bytes = size_of(is_list ? property.count_type : property.type);
            stride += bytes;
            if (i < element.indices) before += bytes;
        }
        if (element.count > bytes_left() / stride) return false;
        std::vector<PolygonChunk> parts((element.count + kRecordsPerBlock - 1) / kRecordsPerBlock);
        std::atomic<bool> all_triangles = true;
        options_.parallel_for(parts.size(), [&](std::size_t block) {
            const std::size_t last =
                std::min<std::size_t>((block + 1) * kRecordsPerBlock, element.count);
            const char* at = at_ + block * kRecordsPerBlock * stride + before;
            parts[block].corners.reserve(3 * (last - block * kRecordsPerBlock));
            for (std::size_t i = block * kRecordsPerBlock; i < last; ++i, at += stride) {
                if (load_whole(list.count_type, at, swap_) != 3) {
                    all_triangles = false;
                    return;
                }
                add_corners(list, at + size_of(list.count_type), 3, parts[block]);
            }
        });
        if (!all_triangles) return false;
        append(std::move(parts));
        at_ += element.count * stride;
        return true;
    }

    void add_corners(const PlyProperty& list, const char* at, std::size_t count,
                     PolygonChunk& chunk) const {
        for (std::size_t i = 0; i < count; ++i, at += size_of(list.type)) {
            const std::int64_t index = load_whole(list.type, at, swap_);
            chunk.add_corner(index, index);
        }
        chunk.end_face(count);
    }

    void append(std::vector<PolygonChunk>&& parts) {
        std::move(parts.begin(), parts.end(), std::back_inserter(chunks_));
    }

    /// Reads records of any shape, one after the other.
    bool read_records(const PlyElement& element) {
        std::vector<const char*> places(element.properties.size());
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (i % kRecordsPerBlock == 0 && element.role != PlyRole::vertices)
                chunks_.emplace_back();
            for (std::size_t p = 0; p < places.size(); ++p) {
                places[p] = at_;
                if (!skip(element, i, element.properties[p])) return false;
            }
            add_record(element, places);
        }
        return true;
    }

    void add_record(const PlyElement& element, const std::vector<const char*>& places) {
        if (element.role == PlyRole::vertices) {
            std::array<double, 3> x{};
            const std::array<std::size_t, 3> wanted = {element.x, element.y, element.z};
            PolygonChunk& chunk = chunks_.front();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const PlyType type = element.properties[wanted[axis]].type;
                x[axis] = load_number(type, places[wanted[axis]], swap_);
                if (!counts_as_single(type, x[axis])) chunk.single_precision = false;
            }
            chunk.positions.push_back({x[0], x[1], x[2]});
            return;
        }
        if (element.role == PlyRole::other) return;
        const PlyProperty& list = element.properties[element.indices];
        const char* at = places[element.indices];
        const auto count = static_cast<std::size_t>(load_whole(list.count_type, at, swap_));
        at += size_of(list.count_type);
        if (element.role == PlyRole::faces) {
            add_corners(list, at, count, chunks_.back());
            return;
        }
        std::vector<std::int64_t> strip(count);
        for (std::size_t i = 0; i < count; ++i) {
            strip[i] = load_whole(list.type, at + i * size_of(list.type), swap_);
        }
        add_strip(strip, chunks_.back());
    }

    /// Moves at_ past one property. Fails if the file is too short for it.
    bool skip(const PlyElement& element, std::uint64_t record, const PlyProperty& property) {
        const bool is_list = property.count_type != PlyType::none;
        const std::size_t first = size_of(is_list ? property.count_type : property.type);
        const auto place = static_cast<std::size_t>(at_ - file_.bytes().data());
        const auto fail = [&](const std::string& what) {
            error_ = file_.unreadable("byte " + std::to_string(place) + ": " + what +
                                      ", in record " + std::to_string(record) + " of the " +
                                      std::to_string(element.count) + " of element '" +
                                      std::string(element.name) + "'");
            return false;
        };
        if (first > bytes_left()) return fail("the file ends");
        const std::int64_t count = is_list ? load_whole(property.count_type, at_, swap_) : 0;
        at_ += first;
        if (count < 0) return fail("a list has " + std::to_string(count) + " entries");
        if (static_cast<std::uint64_t>(count) > bytes_left() / size_of(property.type)) {
            return fail("a list has " + std::to_string(count) + " entries, but only " +
                        std::to_string(bytes_left()) + " bytes follow");
        }
        at_ += static_cast<std::size_t>(count) * size_of(property.type);
        return true;
    }

    const SourceFile& file_;
    const PlyHeader& header_;
    const ImportOptions& options_;
    bool swap_;
    const char* at_;
    const char* end_;
    std::vector<PolygonChunk> chunks_;
    std::optional<Error> error_;
};

}  // namespace

Result<std::vector<PolygonChunk>> read_ply_binary(const SourceFile& file, const PlyHeader& header,
                                                  const ImportOptions& options) {
    return PlyRecordReader(file, header, options).read();
}

}  // namespace cdprep::import
