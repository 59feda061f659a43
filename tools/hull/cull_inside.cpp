// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/cull_inside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "hull/exact_hull.h"
#include "mesh/with_avx2.h"

// Points are tested against polytopes inside the hull, whose corners are input points. Each next
// polytope adds the points farthest outside the facets of the one before. The first few use only
// a sample. A point strictly inside a polytope is strictly inside the hull, so it is no corner
// of the hull. The corners of the polytopes stay, and so does the hull.
//
// The test for "strictly inside" uses floats, with a proof. Let y = (p - centre) * scale,
// exactly, with |y| <= 1 in each coordinate (`scale` is a power of two). Let x be the floats for
// y: the rounding of the difference and the rounding to float change it by less than 2^-24. Let
// N be the exact outward normal of a facet, a cross product of differences of y. Let m be the
// largest of its computed coordinates, and e the bound on their errors divided by m. Let n be
// the floats for N / m. Then for y in the box
//   |N/m y - n y| <= 3 (2^-24 + e)       |n y - n x| <= 3 (1 + 2^-24) 2^-24
//   |n x as computed - n x| <= 8.1 * 2^-24: three products of at most 1, sums up to 2 and 3
//   |N/m a as computed from doubles - N/m a| <= 3 e + 2^-48
// The sum is less than 15 * 2^-24 + 6 e. A value below the facet's height minus 2^-19 - 8 e is
// behind the exact facet. A normal too short to be reliable has a large e and drops nothing.
namespace cdprep::convex {
namespace {

constexpr double kMargin = 0x1p-19;       ///< in the unit box: derived above
constexpr double kNormalError = 0x1p-47;  ///< error of a coordinate of N: see plane_of()
/// The largest e of a plane that is used: terms of the second order stay far below 2 e.
constexpr double kReliable = 0.01;
constexpr std::size_t kLanes = 8;  ///< floats of an AVX2 register
// The sizes and limits below trade the time of passes against that of the exact hull of the points
// that are left. They change no hull, and were chosen by trial.
constexpr std::size_t kChunk = 1024;       ///< points per task: 16 KiB
constexpr std::size_t kFewPoints = 512;    ///< fewer are not culled
constexpr std::size_t kSample = 1 << 14;   ///< most points in the sample
constexpr std::size_t kSampleFacets = 64;  ///< beyond it, a polytope takes in no more of the sample
constexpr std::size_t kMostFacets = 256;   ///< the same of all points
/// With fewer corners, the polytope still grows much by each pass, even if it drops few points.
constexpr std::size_t kFirstCorners = 50;
/// A pass that drops fewer than one point in this many is the last.
constexpr std::size_t kWorthwhile = 10;
/// Sizes whose squares and quotients are far from the limits of double.
constexpr double kLeastSize = 1e-150, kLargestSize = 1e150;

/// Eight points, stored by coordinate.
struct Block {
    alignas(32) std::array<float, kLanes> x, y, z;
};

struct Plane {
    float x, y, z;
    float height;  ///< a lower point is certainly behind the facet
};

using Float3 = std::array<float, 3>;

/// At most kChunk points. Copies of the last one fill its block.
struct Chunk {
    std::vector<Block> blocks;
    std::vector<std::uint32_t> numbers;

    void add(std::uint32_t number, const Float3& x) {
        if (numbers.size() % kLanes == 0) blocks.emplace_back();
        put(numbers.size(), x);
        numbers.push_back(number);
    }
    void fill_last_block() {
        if (numbers.empty()) return;
        const Float3 last = at(numbers.size() - 1);
        for (std::size_t i = numbers.size(); i < blocks.size() * kLanes; ++i) put(i, last);
    }
    [[nodiscard]] Float3 at(std::size_t place) const {
        const Block& block = blocks[place / kLanes];
        const std::size_t lane = place % kLanes;
        return {block.x[lane], block.y[lane], block.z[lane]};
    }

private:
    void put(std::size_t place, const Float3& x) {
        Block& block = blocks[place / kLanes];
        const std::size_t lane = place % kLanes;
        block.x[lane] = x[0];
        block.y[lane] = x[1];
        block.z[lane] = x[2];
    }
};

using Chunks = std::vector<Chunk>;

/// The map from input coordinates to the unit box.
class UnitBox {
public:
    /// Scales by a power of two greater than half the largest side, so that |y| is at most 1.
    UnitBox(const Double3& lower, const Double3& upper)
        : centre_{0.5 * lower.x + 0.5 * upper.x, 0.5 * lower.y + 0.5 * upper.y,
                  0.5 * lower.z + 0.5 * upper.z} {
        const Double3 a = (*this)(lower), b = (*this)(upper);
        size_ = std::max({-a.x, -a.y, -a.z, b.x, b.y, b.z});
        if (usable()) scale_ = std::ldexp(1.0, -std::ilogb(size_) - 1);
    }
    [[nodiscard]] bool usable() const {
        return size_ > kLeastSize && size_ < kLargestSize;
    }
    [[nodiscard]] Double3 operator()(const Double3& p) const {
        return {(p.x - centre_.x) * scale_, (p.y - centre_.y) * scale_, (p.z - centre_.z) * scale_};
    }
    [[nodiscard]] Float3 floats(const Double3& p) const {
        const Double3 y = (*this)(p);
        return {static_cast<float>(y.x), static_cast<float>(y.y), static_cast<float>(y.z)};
    }

private:
    Double3 centre_;
    double size_ = 0, scale_ = 1;
};

/// Four points are three vectors of four coordinates, so the loop over twelve is vectorised.
CDPREP_WITH_AVX2
UnitBox box_of(std::span<const Double3> points) {
    constexpr std::size_t kRow = 12;
    const double* const coordinates = &points[0].x;
    const std::size_t count = points.size() * 3;
    std::array<double, kRow> lower, upper;
    for (std::size_t i = 0; i < kRow; ++i) lower[i] = upper[i] = coordinates[i % 3];
    for (std::size_t first = 0; first + kRow <= count; first += kRow) {
        for (std::size_t i = 0; i < kRow; ++i) {
            const double x = coordinates[first + i];
            lower[i] = x < lower[i] ? x : lower[i];
            upper[i] = x > upper[i] ? x : upper[i];
        }
    }
    for (std::size_t i = count - count % kRow; i < count; ++i) {
        lower[i % 3] = std::min(lower[i % 3], coordinates[i]);
        upper[i % 3] = std::max(upper[i % 3], coordinates[i]);
    }
    for (std::size_t i = 3; i < kRow; ++i) {
        lower[i % 3] = std::min(lower[i % 3], lower[i]);
        upper[i % 3] = std::max(upper[i % 3], upper[i]);
    }
    return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
}

using Lanes = float __attribute__((vector_size(4 * kLanes)));
using LaneMask = std::int32_t __attribute__((vector_size(4 * kLanes)));
using Flags = std::array<std::int32_t, kLanes>;

/// Sets flags in `kept` for points that the plane does not prove to be behind it. Returns the
/// largest height along the plane's normal.
CDPREP_WITH_AVX2
float weigh(std::span<const Block> blocks, const Plane& plane, Flags* kept) {
    Lanes most = Lanes{} - std::numeric_limits<float>::infinity();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        Lanes x, y, z;
        LaneMask keep;
        std::memcpy(&x, blocks[b].x.data(), sizeof x);
        std::memcpy(&y, blocks[b].y.data(), sizeof y);
        std::memcpy(&z, blocks[b].z.data(), sizeof z);
        std::memcpy(&keep, kept[b].data(), sizeof keep);
        const Lanes height = x * plane.x + y * plane.y + z * plane.z;
        keep |= height >= plane.height;
        most = height > most ? height : most;
        std::memcpy(kept[b].data(), &keep, sizeof keep);
    }
    float highest = most[0];
    for (std::size_t lane = 1; lane < kLanes; ++lane) highest = std::max(highest, most[lane]);
    return highest;
}

/// Returns the remaining points of a chunk; sets one entry of `highest` per plane.
Chunk kept_of(const Chunk& chunk, std::span<const Plane> planes, float* highest) {
    std::array<Flags, kChunk / kLanes> kept = {};
    for (std::size_t p = 0; p < planes.size(); ++p) {
        highest[p] = weigh(chunk.blocks, planes[p], kept.data());
    }
    Chunk left;
    left.blocks.reserve(chunk.blocks.size());
    left.numbers.reserve(chunk.numbers.size());
    for (std::size_t i = 0; i < chunk.numbers.size(); ++i) {
        if (kept[i / kLanes][i % kLanes] != 0) left.add(chunk.numbers[i], chunk.at(i));
    }
    left.fill_last_block();
    return left;
}

struct Pass {
    Chunks kept;
    std::vector<float> highest;  ///< by chunk and plane
};

/// Tests all chunks against the planes; `chunk_at` returns a chunk by number.
template <class ChunkAt>
Pass pass_over(std::size_t chunk_count, const ChunkAt& chunk_at, std::span<const Plane> planes,
               ParallelFor run) {
    Pass pass = {Chunks(chunk_count), std::vector<float>(chunk_count * planes.size())};
    const auto weigh_chunk = [&](std::size_t i) {
        pass.kept[i] = kept_of(chunk_at(i), planes, &pass.highest[i * planes.size()]);
    };
    run(chunk_count, weigh_chunk);
    return pass;
}

/// Adds the farthest point in front of each plane. The pass has kept it.
void add_farthest(const Pass& pass, std::span<const Plane> planes,
                  std::vector<std::uint32_t>& corners) {
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const Plane& plane = planes[p];
        std::size_t best = 0;
        const auto highest = [&](std::size_t i) { return pass.highest[i * planes.size() + p]; };
        for (std::size_t i = 1; i < pass.kept.size(); ++i) {
            if (highest(i) > highest(best)) best = i;
        }
        if (highest(best) <= plane.height + 4 * static_cast<float>(kMargin)) continue;
        const Chunk& chunk = pass.kept[best];
        for (std::size_t i = 0; i < chunk.numbers.size(); ++i) {
            const Float3 x = chunk.at(i);
            if (x[0] * plane.x + x[1] * plane.y + x[2] * plane.z < highest(best)) continue;
            corners.push_back(chunk.numbers[i]);
            break;
        }
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
}

/// Returns the same points in full chunks.
Chunks joined(const Chunks& parts) {
    Chunks all;
    for (const Chunk& part : parts) {
        for (std::size_t i = 0; i < part.numbers.size(); ++i) {
            if (all.empty() || all.back().numbers.size() == kChunk) {
                if (!all.empty()) all.back().fill_last_block();
                all.emplace_back();
            }
            all.back().add(part.numbers[i], part.at(i));
        }
    }
    if (!all.empty()) all.back().fill_last_block();
    return all;
}

std::size_t count_of(const Chunks& chunks) {
    std::size_t count = 0;
    for (const Chunk& chunk : chunks) count += chunk.numbers.size();
    return count;
}

/// Returns the plane of a facet. With u = 2^-53, the error of a coordinate of y is at most u,
/// and of a difference of two 4 u. The error of a product of these, at most 4, is 20 u. That of
/// the difference of two products is 48 u, below 2^-47.
Plane plane_of(const Double3& a, const Double3& b, const Double3& c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double most = std::max({std::fabs(nx), std::fabs(ny), std::fabs(nz)});
    const double error = kNormalError / most;
    // Also if `most` is 0 and the error infinite: such a plane has everything in front.
    if (!(error < kReliable)) return {0, 0, 0, -1};
    const double height = (nx * a.x + ny * a.y + nz * a.z) / most;
    return {static_cast<float>(nx / most), static_cast<float>(ny / most),
            static_cast<float>(nz / most), static_cast<float>(height - kMargin - 8 * error)};
}

/// Returns the planes of the exact hull of some of the points; none if it is flat.
std::vector<Plane> planes_of(std::span<const Double3> points,
                             std::span<const std::uint32_t> corners, const UnitBox& unit) {
    std::vector<Double3> some;
    some.reserve(corners.size());
    for (const std::uint32_t corner : corners) some.push_back(points[corner]);
    const ConvexHull hull = exact_hull(some);
    std::vector<Plane> planes;
    if (hull.dimension < 3) return planes;
    for (std::size_t g = 0; g + 1 < hull.groups.size(); ++g) {
        const auto& facet = hull.facets[hull.groups[g]];
        planes.push_back(plane_of(unit(hull.points[facet[0]]), unit(hull.points[facet[1]]),
                                  unit(hull.points[facet[2]])));
    }
    return planes;
}

/// Returns every `step`-th point.
Chunks sample_of(std::span<const Double3> points, std::size_t step, const UnitBox& unit) {
    Chunks sample;
    for (std::size_t i = 0; i < points.size(); i += step) {
        if (sample.empty() || sample.back().numbers.size() == kChunk) sample.emplace_back();
        sample.back().add(static_cast<std::uint32_t>(i), unit.floats(points[i]));
    }
    for (Chunk& chunk : sample) chunk.fill_last_block();
    return sample;
}

/// Returns the least and greatest points along the axes: all points are in front of these
/// planes.
std::vector<std::uint32_t> first_corners(const Chunks& sample) {
    std::vector<Plane> planes;
    for (const float sign : {-1.0F, 1.0F}) {
        planes.push_back({sign, 0, 0, -2});
        planes.push_back({0, sign, 0, -2});
        planes.push_back({0, 0, sign, -2});
    }
    std::vector<std::uint32_t> corners;
    const auto chunk_at = [&](std::size_t i) -> const Chunk& { return sample[i]; };
    add_farthest(pass_over(sample.size(), chunk_at, planes, ParallelFor(serial_for)), planes,
                 corners);
    return corners;
}

/// The state of polytopes grown over `points`.
struct Grown {
    std::vector<std::uint32_t> corners;
    std::vector<Plane> planes;  ///< of the hull of the corners
    std::vector<Plane> before;  ///< of the previous polytope
};

/// Repeats passes over the chunks while they drop enough points and the facets are few.
void grow(Chunks& chunks, Grown& grown, std::span<const Double3> points, const UnitBox& unit,
          std::size_t most_facets, ParallelFor run) {
    while (!grown.planes.empty() && grown.planes.size() <= most_facets) {
        const auto chunk_at = [&](std::size_t i) -> const Chunk& { return chunks[i]; };
        const Pass pass = pass_over(chunks.size(), chunk_at, grown.planes, run);
        const std::size_t before = count_of(chunks), corner_count = grown.corners.size();
        chunks = joined(pass.kept);
        const std::size_t dropped = before - count_of(chunks);
        add_farthest(pass, grown.planes, grown.corners);
        if (grown.corners.size() == corner_count) return;
        const bool last = corner_count > kFirstCorners && dropped * kWorthwhile < before;
        if (last) return;
        grown.before = std::move(grown.planes);
        grown.planes = planes_of(points, grown.corners, unit);
    }
}

/// Returns the `number`-th run of kChunk input points.
Chunk chunk_of(std::span<const Double3> points, std::size_t number, const UnitBox& unit) {
    const std::size_t first = number * kChunk;
    const std::size_t count = std::min(kChunk, points.size() - first);
    Chunk chunk;
    chunk.numbers.resize(count);
    std::iota(chunk.numbers.begin(), chunk.numbers.end(), static_cast<std::uint32_t>(first));
    chunk.blocks.resize((count + kLanes - 1) / kLanes);
    for (std::size_t b = 0; b < chunk.blocks.size(); ++b) {
        Block& block = chunk.blocks[b];
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const Double3& p = points[first + std::min(b * kLanes + lane, count - 1)];
            const Float3 x = unit.floats(p);
            block.x[lane] = x[0];
            block.y[lane] = x[1];
            block.z[lane] = x[2];
        }
    }
    return chunk;
}

/// Passes over all points. The few planes of the previous polytope drop most points, before the
/// many planes of the last one.
Chunks first_pass(std::span<const Double3> points, Grown& grown, const UnitBox& unit,
                  ParallelFor run) {
    const auto chunk_at = [&](std::size_t i) {
        std::vector<float> unused(grown.before.size());
        const Chunk chunk = chunk_of(points, i, unit);
        return grown.before.empty() ? chunk : kept_of(chunk, grown.before, unused.data());
    };
    const Pass pass = pass_over((points.size() + kChunk - 1) / kChunk, chunk_at, grown.planes, run);
    add_farthest(pass, grown.planes, grown.corners);
    return joined(pass.kept);
}

std::vector<std::uint32_t> numbers_of(const Chunks& chunks) {
    std::vector<std::uint32_t> numbers;
    for (const Chunk& chunk : chunks) {
        numbers.insert(numbers.end(), chunk.numbers.begin(), chunk.numbers.end());
    }
    return numbers;
}

std::vector<std::uint32_t> all_numbers(std::size_t count) {
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

}  // namespace

std::vector<std::uint32_t> cull_inside(std::span<const Double3> points, ParallelFor run) {
    if (points.size() < kFewPoints) return all_numbers(points.size());
    const UnitBox unit = box_of(points);
    if (!unit.usable()) return all_numbers(points.size());
    const std::size_t step = (points.size() + kSample - 1) / kSample;
    Chunks sample = sample_of(points, step, unit);
    Grown grown;
    grown.corners = first_corners(sample);
    grown.planes = planes_of(points, grown.corners, unit);
    grow(sample, grown, points, unit, kSampleFacets, run);
    if (step == 1) {  // the sample contains all points
        if (count_of(sample) < kFewPoints) return numbers_of(sample);
        grown.planes = planes_of(points, grown.corners, unit);
        grow(sample, grown, points, unit, kMostFacets, run);
        return numbers_of(sample);
    }
    if (grown.planes.empty()) return all_numbers(points.size());
    Chunks outer = first_pass(points, grown, unit, run);
    grown.planes = planes_of(points, grown.corners, unit);
    grow(outer, grown, points, unit, kMostFacets, run);
    return numbers_of(outer);
}

}  // namespace cdprep::convex
