// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/contacts.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "cdprep/time_of_impact.h"

namespace cdprep::test {

/// Query results as bytes, without padding. It copies values without arithmetic, which a
/// floating-point mode would change.
class AnswerBytes {
public:
    template <class Number>
    requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
    void add(Number number) {
        const auto* from = reinterpret_cast<const std::byte*>(&number);
        bytes_.insert(bytes_.end(), from, from + sizeof(Number));
    }
    void add(const Double3& p) {
        add(p.x);
        add(p.y);
        add(p.z);
    }
    void add(const TrianglePair& pair) {
        add(pair.a);
        add(pair.b);
    }
    void add(const RayHit& hit) {
        add(hit.t);
        add(hit.point);
        add(hit.triangle);
    }
    void add(const Crossing& crossing) {
        add(crossing.pair);
        add(crossing.is_flat);
        add(crossing.from);
        add(crossing.to);
    }
    void add(const Distance& d) {
        add(d.lower);
        add(d.upper);
        add(d.witness_a);
        add(d.witness_b);
        add(d.triangle_a);
        add(d.triangle_b);
    }
    void add(const Impact& impact) {
        add(impact.kind);
        add(impact.lower);
        add(impact.upper);
        add(impact.steps);
        add(impact.nearest);
    }
    void add(const ShapeDistance& d) {
        add(d.lower);
        add(d.upper);
        add(d.on_model);
        add(d.on_shape);
        add(d.triangle);
    }
    void add(const ClosestPoint& d) {
        add(d.point);
        add(d.lower);
        add(d.upper);
        add(d.triangle);
    }
    void add(const ConvexDistance& d) {
        add(d.lower);
        add(d.upper);
        add(d.witness_a);
        add(d.witness_b);
    }
    void add(const Penetration& d) {
        add(d.lower);
        add(d.upper);
        add(d.normal);
        add(d.witness_a);
        add(d.witness_b);
    }
    void add(const ClosestFeatures& f) {
        add(f.a.kind);
        add(f.a.number);
        add(f.b.kind);
        add(f.b.number);
        add(f.lower);
        add(f.upper);
        add(f.witness_a);
        add(f.witness_b);
        add(f.parallel);
    }
    void add(const Inclusion& found) {
        add(found.answer);
        add(found.on_surface);
        add(found.winding);
    }
    void add(const Containment& found) {
        add(found.answer);
        add(found.winding);
        add(found.a_inside_b);
    }
    void add(const Collision& found) {
        add(found.hit);
        add(found.containment);
    }
    void add(const Contact& c) {
        add(c.piece_a);
        add(c.piece_b);
        add(c.id);
        add(c.members);
        add(c.point_a);
        add(c.point_b);
        add(c.normal);
        add(c.lower);
        add(c.upper);
        add(c.flags);
        for (std::uint32_t i = 0; i < c.point_count; ++i) add(c.points[i].on_a);
        for (std::uint32_t i = 0; i < c.point_count; ++i) add(c.points[i].on_b);
        for (std::uint32_t i = 0; i < c.point_count; ++i) add(c.points[i].distance);
        for (std::uint32_t i = 0; i < c.point_count; ++i) add(c.points[i].id);
    }
    void add(const ContactsVerdict& v) {
        add(v.count);
        add(v.found);
        add(v.computed);
        add(v.work);
        add(v.searched);
        add(v.complete);
    }
    void add(const Pose& pose) {
        for (const double number : pose.rotation()) add(number);
        add(pose.translation());
    }
    template <class Answer>
    void add(const std::optional<Answer>& answer) {
        add(answer.has_value());
        if (answer) add(*answer);
    }
    void add(const std::optional<format::Damage>& damage) {
        add(damage.has_value());
    }
    /// Adds `count` and the first `count` elements of a list, or all if there are fewer.
    template <class Answer>
    void add(const std::vector<Answer>& list, std::size_t count) {
        add(count);
        for (std::size_t i = 0; i < std::min(count, list.size()); ++i) add(list[i]);
    }
    /// Adds the stored bytes of elements. The type must have no padding.
    template <class Element>
    void add_stored(const std::vector<Element>& list) {
        const auto bytes = std::as_bytes(std::span(list));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    [[nodiscard]] std::size_t size() const {
        return bytes_.size();
    }
    friend bool operator==(const AnswerBytes&, const AnswerBytes&) = default;

private:
    std::vector<std::byte> bytes_;
};

}  // namespace cdprep::test
