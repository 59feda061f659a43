// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"
#include "mesh/point_tree.h"

namespace cdprep::convex {

using format::Double3;

/// Points stored by coordinate, for many dot products.
class PointRows {
public:
    void add(const Double3& p) {
        x_.push_back(p.x);
        y_.push_back(p.y);
        z_.push_back(p.z);
    }
    [[nodiscard]] std::size_t size() const {
        return x_.size();
    }
    [[nodiscard]] Double3 at(std::size_t i) const {
        return {x_[i], y_[i], z_[i]};
    }
    /// Returns the first of the points that lie farthest along a direction. Must not be empty.
    [[nodiscard]] std::size_t farthest(const Double3& along) const;

private:
    std::vector<double> x_, y_, z_;
};

/// Points in groups of neighbours.
class PointGroups {
public:
    struct Group {
        mesh::Box box;
        std::uint32_t first;  ///< of its points
        std::uint32_t count;
    };

    PointGroups() = default;
    /// Starts with the groups of `base`, to which more can be added. `base` must outlive this and
    /// must not change meanwhile.
    explicit PointGroups(const PointGroups* base) : base_(base), base_size_(base->size()) {}

    void add(std::span<const Double3> points);

    /// Returns the number of groups. Those of the base come first.
    [[nodiscard]] std::size_t size() const {
        return base_size_ + groups_.size();
    }
    [[nodiscard]] const mesh::Box& box_of(std::size_t group) const {
        return group < base_size_ ? base_->box_of(group) : groups_[group - base_size_].box;
    }
    [[nodiscard]] std::span<const Double3> points_of(std::size_t group) const {
        if (group < base_size_) return base_->points_of(group);
        const Group& own = groups_[group - base_size_];
        return std::span(points_).subspan(own.first, own.count);
    }

    /// Calls visit(group) for each group whose box meets this one, ascending. Returns the number of
    /// boxes tested.
    template <class Visit>
    std::size_t in_box(const mesh::Box& box, const Visit& visit) const {
        std::size_t looks = base_ == nullptr ? 0 : base_->in_box(box, visit);
        looks += bundles_.size();
        for (std::size_t k = 0; k < bundles_.size(); ++k) {
            if (!bundles_[k].meets(box)) continue;
            const std::size_t end = std::min((k + 1) * kBundle, groups_.size());
            looks += end - k * kBundle;
            for (std::size_t i = k * kBundle; i < end; ++i) {
                if (groups_[i].box.meets(box)) visit(base_size_ + i);
            }
        }
        return looks;
    }

private:
    static constexpr std::size_t kBundle = 32;  ///< groups that share one box: changes no result

    const PointGroups* base_ = nullptr;
    std::size_t base_size_ = 0;
    std::vector<Group> groups_;
    std::vector<mesh::Box> bundles_;  ///< around kBundle consecutive groups each
    std::vector<Double3> points_;
};

/// A growing convex hull that keeps certain points out, each with a separating plane. A whole group
/// shares one plane while possible; later each point has its own. Points beyond the hull's box need
/// no plane.
///
/// Values are rounded: decisions here are choices, and the result is measured afterwards. Points
/// nearer to the hull than about 1e-9 of their distances count as inside.
class SeparatedPoints {
public:
    /// `kept_out` must outlive this.
    explicit SeparatedPoints(const PointGroups& kept_out);

    /// Adds points to the hull. If a kept-out point would then be inside, adds nothing and returns
    /// false. `centre` and `radius` describe a ball around the points.
    bool add(std::span<const Double3> points, const Double3& centre, double radius);

    /// Returns all added points that are not inside the hull of others, and some that are.
    [[nodiscard]] std::vector<Double3> outer_points() const;

    /// Returns the number of planes and points tested.
    [[nodiscard]] std::size_t work() const {
        return work_;
    }

private:
    /// A plane that touches the hull: points beyond it are outside.
    struct Touching {
        Double3 normal;
        double offset;
    };
    /// Sets of kept-out points, with one plane each.
    struct Planes {
        std::vector<double> x, y, z;  ///< normals, away from the hull
        std::vector<double> offset;   ///< of the nearest point of the set
        [[nodiscard]] std::size_t size() const {
            return x.size();
        }
        void resize(std::size_t count);
        void forbid(std::size_t i);
        void swap(std::size_t i, std::size_t k);
    };
    /// A group that the hull's box reaches.
    struct Near {
        std::uint32_t group;
        std::uint32_t single;  ///< index of its first point's plane; kClosed: none
    };
    /// Points that are being added.
    struct Added {
        std::span<const Double3> points;
        Double3 centre;
        double radius;
    };
    struct Change {
        Planes* planes;
        std::size_t of;
        std::size_t plane;
        double offset;
    };
    [[nodiscard]] std::optional<Touching> find_plane(const Double3& kept_out, const Double3& first,
                                                     std::span<const Double3> more);
    bool keep_out(Planes& planes, std::size_t i, std::span<const Double3> kept_out,
                  const Double3& centre, const Added& added);
    bool keep_out_points(const Near& near, const Added& added);
    bool keep_out_group(std::size_t i, const Added& added);
    bool keep_out_all(const Added& added);
    void look_around(const mesh::Box& box);
    void forget(std::size_t near_count, std::size_t single_count);
    void prune();

    const PointGroups& kept_out_;
    PointRows points_;
    mesh::Box box_;
    std::size_t pruned_size_ = 0;
    std::vector<Near> near_;
    Planes planes_;  ///< of near groups
    Planes single_;
    std::vector<std::uint8_t> is_near_;  ///< of each group
    std::vector<std::size_t> opened_;    ///< groups opened while points are added
    std::vector<Touching> found_;
    std::vector<Change> changes_;
    std::size_t blocking_ = 0;  ///< the near group that blocked the last add()
    std::size_t work_ = 0;
};

}  // namespace cdprep::convex
