// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/join_chunks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cdprep/format/limits.h"
#include "import/resize_large.h"
#include "mesh/triangulate_polygon.h"
#include "mesh/vectors.h"

namespace cdprep::import {
namespace {

using mesh::BadNumber;
using mesh::Double3;
using mesh::Triangle;

constexpr std::uint32_t kNoVertex = 0xffffffff;
constexpr std::size_t kMaxListed = 1000;  // TriangleSoup::bad_numbers

/// The start of a chunk's parts in the soup.
struct Place {
    std::uint64_t first_vertex = 0;
    std::uint64_t first_triangle = 0;
    std::uint64_t first_face = 0;
};

/// A face that could not be cut into triangles within the limit of steps.
struct UncutFace {
    std::uint64_t face;
    std::uint64_t first_triangle;
    std::uint32_t corners;
};

bool fits_predicates(const Double3& p) noexcept {
    const auto small = [](double x) { return std::fabs(x) <= format::kMaxCoordinate; };
    return small(p.x) && small(p.y) && small(p.z);
}

/// One chunk on its way into the soup.
class ChunkJoiner {
public:
    ChunkJoiner(mesh::TriangleSoup& soup, PolygonChunk& chunk, Place place,
                const JoinOptions& options)
        : soup_(soup),
          chunk_(chunk),
          place_(place),
          first_index_(options.first_index),
          max_polygon_steps_(options.max_polygon_steps) {}

    /// Turns every corner into a vertex number of the soup, or kNoVertex.
    void resolve_corners() {
        const auto limit = soup_.positions.size();
        std::size_t next_odd = 0;
        for (std::size_t slot = 0; slot < chunk_.corners.size(); ++slot) {
            std::uint32_t& corner = chunk_.corners[slot];
            std::int64_t vertex = corner & ~PolygonChunk::kFromChunkStart;
            if (corner & PolygonChunk::kFromChunkStart) vertex += first_vertex();
            std::int64_t found = vertex + first_index_;
            if (next_odd < chunk_.odd.size() && chunk_.odd[next_odd].slot == slot) {
                const OddCorner& odd = chunk_.odd[next_odd++];
                found = odd.found;
                vertex = odd.vertex + (odd.from_chunk_start ? first_vertex() : 0);
            }
            if (vertex >= 0 && static_cast<std::uint64_t>(vertex) < limit) {
                corner = static_cast<std::uint32_t>(vertex);
            } else {
                corner = kNoVertex;
                bad_corners_.push_back({slot, found});
            }
        }
    }

    /// Does both steps at once for a chunk of triangles whose corners are all in range. Returns
    /// false for any other chunk; what it wrote is then invalid.
    bool write_plain_triangles() {
        if (!chunk_.sizes.empty() || !chunk_.odd.empty()) return false;
        const auto limit = static_cast<std::uint32_t>(soup_.positions.size());
        const auto base = static_cast<std::uint32_t>(place_.first_vertex);
        Triangle* const triangles = soup_.triangles.data() + place_.first_triangle;
        std::uint32_t bad = 0;
        for (std::size_t i = 0; i < chunk_.triangle_count; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t corner = chunk_.corners[3 * i + k];
                const std::uint32_t own = corner >> 31;  // kFromChunkStart
                const std::uint32_t vertex = (corner & 0x7fffffff) + own * base;
                bad |= static_cast<std::uint32_t>(vertex >= limit);
                triangles[i].vertex[k] = vertex;
            }
        }
        if (bad) return false;
        write_face_numbers();
        return true;
    }

    /// Stops at the first face that cannot be cut.
    void write_triangles() {
        std::uint64_t triangle = place_.first_triangle;
        if (chunk_.sizes.empty()) {
            for (std::size_t slot = 0; slot + 3 <= chunk_.corners.size(); slot += 3) {
                write_triangle(triangle, slot, slot / 3, {0, 1, 2});
                ++triangle;
            }
            return;
        }
        std::size_t slot = 0;
        for (std::size_t face = 0; face < chunk_.sizes.size(); ++face) {
            const std::uint32_t size = chunk_.sizes[face];
            if (!cut_face(slot, size)) {
                uncut = {place_.first_face + face, triangle, size};
                return;
            }
            for (const std::array<std::uint32_t, 3>& corners : cut_) {
                write_triangle(triangle++, slot, face, corners);
            }
            slot += size;
        }
    }

    std::vector<BadNumber> bad_triangles;
    std::optional<UncutFace> uncut;

private:
    struct BadCorner {
        std::size_t slot;
        std::int64_t found;
    };

    [[nodiscard]] std::int64_t first_vertex() const {
        return static_cast<std::int64_t>(place_.first_vertex);
    }

    /// Fills cut_ with the triangles of the face of `size` corners from `slot`. Returns false if
    /// the steps for that end first.
    bool cut_face(std::size_t slot, std::uint32_t size) {
        cut_.clear();
        if (size <= 3) {
            if (size == 3) cut_.push_back({0, 1, 2});
            return true;
        }
        outline_.clear();
        bool usable = true;
        for (std::size_t i = slot; usable && i < slot + size; ++i) {
            const std::uint32_t vertex = chunk_.corners[i];
            usable = vertex != kNoVertex && fits_predicates(soup_.positions[vertex]);
            if (usable) outline_.push_back(soup_.positions[vertex]);
        }
        if (usable) {
            // A fan of a face that crosses itself still has the face's outline.
            return mesh::triangulate_polygon(outline_, cut_, max_polygon_steps_) !=
                   mesh::PolygonCut::unfinished;
        }
        for (std::uint32_t i = 1; i + 1 < size; ++i) cut_.push_back({0, i, i + 1});
        return true;
    }

    void write_triangle(std::uint64_t number, std::size_t slot, std::size_t face,
                        const std::array<std::uint32_t, 3>& corners) {
        Triangle triangle{};
        std::size_t bad_slot = chunk_.corners.size();
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.vertex[i] = chunk_.corners[slot + corners[i]];
            if (triangle.vertex[i] == kNoVertex) bad_slot = std::min(bad_slot, slot + corners[i]);
        }
        if (bad_slot < chunk_.corners.size()) {
            triangle = Triangle{};
            add_bad_triangle(number, bad_slot);
        }
        soup_.triangles[number] = triangle;
        if (!soup_.face.empty()) {
            soup_.face[number] = static_cast<std::uint32_t>(place_.first_face + face);
        }
    }

    void write_face_numbers() {
        if (soup_.face.empty()) return;
        for (std::uint64_t i = 0; i < chunk_.triangle_count; ++i) {
            soup_.face[place_.first_triangle + i] =
                static_cast<std::uint32_t>(place_.first_face + i);
        }
    }

    void add_bad_triangle(std::uint64_t number, std::size_t slot) {
        const auto corner = std::lower_bound(
            bad_corners_.begin(), bad_corners_.end(), slot,
            [](const BadCorner& bad, std::size_t wanted) { return bad.slot < wanted; });
        bad_triangles.push_back({.kind = BadNumber::Kind::index_out_of_range,
                                 .triangle = static_cast<std::uint32_t>(number),
                                 .found = corner->found,
                                 .limit = static_cast<std::int64_t>(soup_.positions.size()),
                                 .first = first_index_});
    }

    mesh::TriangleSoup& soup_;
    PolygonChunk& chunk_;
    Place place_;
    std::int64_t first_index_;
    std::uint64_t max_polygon_steps_;
    std::vector<BadCorner> bad_corners_;  // sorted by slot
    std::vector<Double3> outline_;
    std::vector<std::array<std::uint32_t, 3>> cut_;
};

/// Returns the place of each chunk, after all chunks before it. The last entry is the total.
std::vector<Place> find_places(const std::vector<PolygonChunk>& chunks, FaceNumbers numbers) {
    std::vector<Place> places(1);
    for (const PolygonChunk& chunk : chunks) {
        const Place& last = places.back();
        std::size_t faces = chunk.sizes.empty() ? chunk.corners.size() / 3 : chunk.sizes.size();
        if (numbers == FaceNumbers::every_chunk) faces = 0;
        places.push_back({last.first_vertex + chunk.positions.size(),
                          last.first_triangle + chunk.triangle_count, last.first_face + faces});
    }
    return places;
}

std::optional<Error> find_excess(const SourceFile& file, const Place& total,
                                 std::uint64_t memory_bytes) {
    const auto more_than = [&](std::uint64_t found, std::uint64_t limit, const char* what) {
        return file.over_budget("has " + std::to_string(found) + what + "; at most " +
                                std::to_string(limit) + " are allowed");
    };
    if (total.first_vertex > format::kMaxVertices) {
        return more_than(total.first_vertex, format::kMaxVertices, " vertices");
    }
    if (total.first_triangle > format::kMaxTriangles) {
        return more_than(total.first_triangle, format::kMaxTriangles, " triangles");
    }
    if (total.first_vertex == 0 && total.first_triangle > 0) {
        return file.unreadable("has " + std::to_string(total.first_triangle) +
                               " triangles but no vertices");
    }
    // Chunks and soup exist at the same time.
    const std::uint64_t bytes =
        2 * (total.first_vertex * sizeof(Double3) + total.first_triangle * (sizeof(Triangle) + 4));
    if (bytes > memory_bytes) {
        return file.over_budget("needs about " + std::to_string(bytes >> 20) +
                                " MiB of memory; at most " + std::to_string(memory_bytes >> 20) +
                                " MiB are allowed. Raise --import-memory to read it");
    }
    return std::nullopt;
}

/// Returns the error for the first face of the file that could not be cut, if any.
std::optional<Error> find_uncut(const SourceFile& file,
                                const std::vector<std::optional<UncutFace>>& uncut,
                                std::uint64_t max_steps) {
    for (const std::optional<UncutFace>& face : uncut) {
        if (!face) continue;
        return file.over_budget(
            "face " + std::to_string(face->face) + ", whose first triangle is " +
            std::to_string(face->first_triangle) + ", has " + std::to_string(face->corners) +
            " corners, and cutting it into triangles takes more than the " +
            std::to_string(max_steps) + " steps allowed. Split it into smaller faces to read it");
    }
    return std::nullopt;
}

void move_positions(mesh::TriangleSoup& soup, std::vector<PolygonChunk>& chunks,
                    const std::vector<Place>& places, ParallelFor parallel_for) {
    soup.single_precision = std::all_of(chunks.begin(), chunks.end(),
                                        [](const PolygonChunk& c) { return c.single_precision; });
    if (!chunks.empty() && chunks[0].positions.size() == places.back().first_vertex) {
        soup.positions = std::move(chunks[0].positions);
    } else {
        resize_large(soup.positions, places.back().first_vertex);
        parallel_for(chunks.size(), [&](std::size_t i) {
            std::copy(chunks[i].positions.begin(), chunks[i].positions.end(),
                      soup.positions.data() + places[i].first_vertex);
            chunks[i].positions = {};
        });
    }
    if (!soup.single_precision) return;
    constexpr std::size_t kBlock = 65536;
    parallel_for((soup.positions.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
        const std::size_t first = block * kBlock;
        const std::size_t count = std::min(kBlock, soup.positions.size() - first);
        for (Double3& p : std::span(soup.positions).subspan(first, count)) {
            p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        }
    });
}

mesh::NamedRuns join_runs(std::vector<PolygonChunk>& chunks, const std::vector<Place>& places,
                          std::vector<NamedStart> PolygonChunk::*starts,
                          std::string_view default_name) {
    std::vector<NamedStart> all;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        for (NamedStart& start : chunks[i].*starts) {
            all.push_back(
                {static_cast<std::uint32_t>(places[i].first_triangle + start.first_triangle),
                 utf8_name(start.name)});
        }
    }
    return named_runs(all, static_cast<std::uint32_t>(places.back().first_triangle), default_name);
}

}  // namespace

void list_bad_numbers(mesh::TriangleSoup& soup, const std::vector<BadNumber>& bad_triangles,
                      ParallelFor parallel_for) {
    // Nothing but this list tells these triangles from others at vertex 0, so it must be complete.
    // Its memory grows with bad triangles only.
    soup.out_of_range.reserve(bad_triangles.size());
    for (const BadNumber& bad : bad_triangles) {
        soup.out_of_range.push_back({bad.triangle, bad.found});
    }
    constexpr std::size_t kBlock = 65536;
    std::vector<std::vector<std::uint32_t>> bad((soup.positions.size() + kBlock - 1) / kBlock);
    parallel_for(bad.size(), [&](std::size_t block) {
        const std::size_t last = std::min((block + 1) * kBlock, soup.positions.size());
        for (std::size_t i = block * kBlock; i < last; ++i) {
            if (!mesh::is_finite(soup.positions[i]))
                bad[block].push_back(static_cast<std::uint32_t>(i));
        }
    });
    for (const std::vector<std::uint32_t>& vertices : bad) {
        soup.bad_number_count += vertices.size();
        for (const std::uint32_t vertex : vertices) {
            if (soup.bad_numbers.size() == kMaxListed) break;
            soup.bad_numbers.push_back({.kind = BadNumber::Kind::not_finite, .vertex = vertex});
        }
    }
    soup.bad_number_count += bad_triangles.size();
    const std::size_t room = std::min(kMaxListed - soup.bad_numbers.size(), bad_triangles.size());
    soup.bad_numbers.insert(soup.bad_numbers.end(), bad_triangles.begin(),
                            bad_triangles.begin() + static_cast<std::ptrdiff_t>(room));
}

Result<mesh::TriangleSoup> join_chunks(const SourceFile& file, std::vector<PolygonChunk> chunks,
                                       const JoinOptions& options) {
    const std::vector<Place> places = find_places(chunks, options.face_numbers);
    const Place total = places.back();
    if (auto excess = find_excess(file, total, options.memory_bytes)) return *std::move(excess);

    mesh::TriangleSoup soup;
    move_positions(soup, chunks, places, options.parallel_for);
    soup.groups = join_runs(chunks, places, &PolygonChunk::groups, "default");
    soup.materials = join_runs(chunks, places, &PolygonChunk::materials, "");
    resize_large(soup.triangles, total.first_triangle);
    if (std::any_of(chunks.begin(), chunks.end(),
                    [](const PolygonChunk& chunk) { return !chunk.sizes.empty(); })) {
        resize_large(soup.face, total.first_triangle);
    }
    std::vector<std::vector<BadNumber>> bad_triangles(chunks.size());
    std::vector<std::optional<UncutFace>> uncut(chunks.size());
    options.parallel_for(chunks.size(), [&](std::size_t i) {
        ChunkJoiner joiner(soup, chunks[i], places[i], options);
        if (!joiner.write_plain_triangles()) {
            joiner.resolve_corners();
            joiner.write_triangles();
        }
        bad_triangles[i] = std::move(joiner.bad_triangles);
        uncut[i] = joiner.uncut;
        chunks[i] = {};
    });
    if (auto excess = find_uncut(file, uncut, options.max_polygon_steps)) return *std::move(excess);
    std::vector<BadNumber> all_bad;
    for (const std::vector<BadNumber>& part : bad_triangles) {
        all_bad.insert(all_bad.end(), part.begin(), part.end());
    }
    list_bad_numbers(soup, all_bad, options.parallel_for);
    return soup;
}

}  // namespace cdprep::import
