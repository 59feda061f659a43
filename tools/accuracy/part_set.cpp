// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/part_set.h"

#include <chrono>
#include <cmath>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/query_counts.h"
#include "decompose/enclose/approximate_parts.h"

namespace cdprep::study {
namespace {

constexpr std::uint32_t kMostCorners = 64;

struct Stopped {};

ConvexPoints points_of(const convex::HullSections& sections, std::size_t number) {
    const format::Hull& hull = sections.hulls[number];
    ConvexPoints points;
    points.blocks = std::span(sections.blocks).subspan(hull.first_block);
    points.count = hull.point_count;
    points.reach = hull.reach;
    return points;
}

BoundingSphere sphere_around(const convex::ConvexHull& hull) {
    mesh::Mesh corners;
    corners.positions = hull.points;
    return bounding_sphere(corners);
}

std::size_t bytes_of(const ConvexPoints& points) {
    const std::size_t blocks = (points.count + format::kHullLanes - 1) / format::kHullLanes;
    return blocks * sizeof(format::HullBlock);
}

double size_of(const Double3& p) {
    return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
}

}  // namespace

std::uint64_t PartSet::bytes() const noexcept {
    return sections.blocks.size() * sizeof(format::HullBlock) +
           sections.hulls.size() * sizeof(format::Hull) + around.size() * sizeof(BoundingSphere);
}

std::optional<PartSet> make_part_set(const mesh::Mesh& mesh, std::size_t count, std::size_t work,
                                     ParallelFor parallel_for, const std::function<bool()>& stop) {
    using Clock = std::chrono::steady_clock;
    const auto run = [&](std::size_t tasks, Task task) {
        const auto unless_stopped = [&](std::size_t i) {
            if (stop && stop()) throw Stopped{};
            task(i);
        };
        parallel_for(tasks, unless_stopped);
    };
    const Clock::time_point begun = Clock::now();
    PartSet set;
    try {
        convex::ApproximateOptions how;
        how.max_parts = count;
        how.max_vertices = kMostCorners;
        how.work = work;
        how.merge_components = true;
        how.parallel_for = run;
        const convex::ApproximateParts found = convex::find_approximate_parts(mesh, how);
        convex::add_parts(set.sections, found.parts);
        for (const convex::ApproximatePart& part : found.parts) {
            set.around.push_back(sphere_around(part.hull));
        }
        set.outer_error = found.outer_error;
    } catch (const Stopped&) {
        return std::nullopt;
    }
    set.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    return set;
}

bool parts_touch(const PartSet& a, const PartSet& b, const Pose& a_from_b,
                 std::vector<Double3>& moved_centres, std::uint64_t* read) {
    moved_centres.clear();
    for (const BoundingSphere& sphere : b.around) {
        moved_centres.push_back(transform_point(a_from_b, sphere.centre));
    }
    const Placement placement = Placement::b_moves(a_from_b);
    const double shift = size_of(a_from_b.translation());
    const auto reads = [&](std::size_t bytes) {
        if (read != nullptr) *read += bytes;
    };
    reads(sizeof(BoundingSphere) * b.around.size());
    for (std::size_t i = 0; i < a.around.size(); ++i) {
        const BoundingSphere& of_a = a.around[i];
        for (std::size_t j = 0; j < b.around.size(); ++j) {
            const BoundingSphere& of_b = b.around[j];
            reads(2 * sizeof(BoundingSphere));
            const double slack = kSlack * (size_of(of_a.centre) + of_a.radius +
                                           size_of(of_b.centre) + of_b.radius + shift);
            const double x = moved_centres[j].x - of_a.centre.x;
            const double y = moved_centres[j].y - of_a.centre.y;
            const double z = moved_centres[j].z - of_a.centre.z;
            const double reach = of_a.radius + of_b.radius + slack;
            if (x * x + y * y + z * z > reach * reach) continue;
            const ConvexPoints in_a = points_of(a.sections, i);
            const ConvexPoints in_b = points_of(b.sections, j);
            QueryCounts counts;
            const bool touch =
                convex_collide(in_a, in_b, placement, nullptr, read != nullptr ? &counts : nullptr);
            // Without hull neighbours, each step reads all points of both.
            reads(counts.hull_steps * (bytes_of(in_a) + bytes_of(in_b)));
            if (touch) return true;
        }
    }
    return false;
}

}  // namespace cdprep::study
