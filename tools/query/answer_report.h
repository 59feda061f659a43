// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace cdprep::report {

enum class AnswerFormat : std::uint8_t { text, json, ndjson };

/// The answer about two models in one pose.
struct PairAnswer {
    std::size_t pose = 0;
    bool hit = false;
    std::optional<std::size_t> count;                    ///< overlap only
    std::optional<std::span<const TrianglePair>> pairs;  ///< overlap without --count
    std::optional<std::span<const Crossing>> crossings;  ///< instead, with --segments
    std::optional<Containment> containment;              ///< solid only
    bool is_approximate = false;                         ///< pairs may be missing
};

/// What one level of detail says about two solids in one pose.
struct CoarseAnswer {
    std::size_t pose = 0;
    CoarseCollision collision;
};

/// How far two models are apart in one pose; nothing when farther than asked for.
struct DistanceAnswer {
    std::size_t pose = 0;
    std::optional<Distance> distance;
};

/// What two models' hulls say in one pose: where they do not touch, nor do the models, which
/// are at least as far apart.
struct HullCollideAnswer {
    std::size_t pose = 0;
    bool hit = false;
};
struct HullDistanceAnswer {
    std::size_t pose = 0;
    std::optional<ConvexDistance> distance;  ///< nothing when farther than asked for
};

/// Whether two models are within the tolerance in one pose.
struct WithinAnswer {
    std::size_t pose = 0;
    bool within = false;
    std::optional<std::size_t> count;                    ///< with --pairs or --count
    std::optional<std::span<const TrianglePair>> pairs;  ///< with --pairs
};

/// How two models touch in one pose.
struct ContactsAnswer {
    std::size_t pose = 0;
    std::span<const Contact> contacts;
};

/// Whether point number `point` is inside.
struct InsideAnswer {
    std::size_t point = 0;
    Inclusion inclusion;
};

/// What lies nearest to point number `point`; nothing in an empty model.
struct ClosestAnswer {
    std::size_t point = 0;
    std::optional<ClosestPoint> closest;
};

/// What ray number `ray` meets first.
struct RayAnswer {
    std::size_t ray = 0;
    std::optional<RayHit> hit;
};

/// Writes answers one after the other: lines of text, elements of one JSON
/// array, or lines of NDJSON such as
/// {"pose": 0, "hit": true, "count": 2, "pairs": [[17, 4], [18, 4]]}. Segments stand in
/// the order of the pairs, six numbers each or null for flat ones.
/// Numbers read back as the same doubles.
class Answers {
public:
    /// `out` outlives the object.
    Answers(std::ostream& out, AnswerFormat format) : out_(out), format_(format) {}

    void add(const PairAnswer& answer);
    void add(const CoarseAnswer& answer);
    void add(const DistanceAnswer& answer);
    void add(const HullCollideAnswer& answer);
    void add(const HullDistanceAnswer& answer);
    void add(const WithinAnswer& answer);
    void add(const ContactsAnswer& answer);
    void add(const InsideAnswer& answer);
    void add(const ClosestAnswer& answer);
    void add(const RayAnswer& answer);

    /// Call once, after the last answer.
    void finish();

private:
    void write(const std::string& answer);

    std::ostream& out_;
    AnswerFormat format_;
    bool is_first_ = true;
};

}  // namespace cdprep::report
