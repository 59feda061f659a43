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

/// The answer to a collide or overlap query in one pose.
struct PairAnswer {
    std::size_t pose = 0;
    bool hit = false;
    std::optional<std::size_t> count;                    ///< overlap only
    std::optional<std::span<const TrianglePair>> pairs;  ///< overlap without --count
    std::optional<std::span<const Crossing>> crossings;  ///< instead of pairs, with --segments
    std::optional<Containment> containment;              ///< solid only
    bool is_approximate = false;                         ///< pairs may be missing
};

/// The answer of one level of detail about two solids in one pose.
struct CoarseAnswer {
    std::size_t pose = 0;
    CoarseCollision collision;
};

/// The distance between two models in one pose; empty if it is beyond the maximum distance.
struct DistanceAnswer {
    std::size_t pose = 0;
    std::optional<Distance> distance;
};

/// The answers about the convex hulls of two models in one pose. If the hulls do not touch, the
/// models do not touch either. The models are at least as far apart as their hulls.
struct HullCollideAnswer {
    std::size_t pose = 0;
    bool hit = false;
};
struct HullDistanceAnswer {
    std::size_t pose = 0;
    std::optional<ConvexDistance> distance;  ///< empty if beyond the maximum distance
};

/// The answer of a within query: true if the models are within the tolerance in one pose.
struct WithinAnswer {
    std::size_t pose = 0;
    bool within = false;
    std::optional<std::size_t> count;                    ///< with --pairs or --count
    std::optional<std::span<const TrianglePair>> pairs;  ///< with --pairs
};

/// Returns the members of an answer in JSON without its pose: `, "hit": true, "count": 2`.
[[nodiscard]] std::string answer_members(const PairAnswer& answer);
[[nodiscard]] std::string answer_members(const DistanceAnswer& answer);
[[nodiscard]] std::string answer_members(const WithinAnswer& answer);

/// Returns an answer in words without its pose: ": hit, 2 pairs".
[[nodiscard]] std::string answer_words(const PairAnswer& answer);
[[nodiscard]] std::string answer_words(const DistanceAnswer& answer);
[[nodiscard]] std::string answer_words(const WithinAnswer& answer);

/// The contacts of two models in one pose.
struct ContactsAnswer {
    std::size_t pose = 0;
    std::span<const Contact> contacts;
    ContactsVerdict verdict{};
};

/// The inclusion of point number `point` in the model.
struct InsideAnswer {
    std::size_t point = 0;
    Inclusion inclusion;
};

/// The point of the model closest to point number `point`; nothing in an empty model.
struct ClosestAnswer {
    std::size_t point = 0;
    std::optional<ClosestPoint> closest;
};

/// The first triangle that ray number `ray` hits; nothing if it hits none.
struct RayAnswer {
    std::size_t ray = 0;
    std::optional<RayHit> hit;
};

/// Writes answers one after the other: lines of text, elements of one JSON array, or lines of
/// NDJSON. A line of NDJSON is {"pose": 0, "hit": true, "count": 2, "pairs": [[17, 4], [18, 4]]}.
/// Segments are in the order of the pairs: six numbers each, or null if Crossing::is_flat. Numbers
/// read back as the same doubles.
class Answers {
public:
    /// `out` must outlive the object.
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

    /// Ends the output. Call it once, after the last answer.
    void finish();

private:
    void write(const std::string& answer);

    std::ostream& out_;
    AnswerFormat format_;
    bool is_first_ = true;
};

}  // namespace cdprep::report
