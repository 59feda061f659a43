// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::study {

/// How two surfaces stand to each other. Shares are of PoseSet::diagonal. How deep is what B
/// has gone on since it first touched A on its way in: the way back, which parts them, so not
/// less than the shortest way out.
enum class Stratum : std::uint8_t {
    deep,      ///< they touch; more than 1 % deep, up to 15 %
    shallow,   ///< they touch; 0.1 % to 1 % deep
    touching,  ///< at most 0.1 % deep, or at most 0.1 % apart
    near,      ///< 0.1 % to 5 % apart
    far,       ///< 5 % to 100 % apart
};

inline constexpr std::size_t kStrata = 5;
inline constexpr std::array<const char*, kStrata> kStratumNames = {"deep", "shallow", "touching",
                                                                   "near", "far"};

/// A pose, and what is true in it: answers of the library at level E1, so of exact
/// arithmetic on B's vertices as transform_point().
struct StudyPose {
    Pose a_from_b;
    std::array<double, 4> quaternion{};  ///< that the rotation was made of: w, x, y, z
    Stratum stratum{};
    bool hit = false;           ///< the surfaces have a common point
    Answer solid = Answer::no;  ///< the solids have one; unknown where a model is open
    double gap_lower = 0;       ///< the surfaces' distance is in [gap_lower, gap_upper], model
    double gap_upper = 0;       ///< units, both 0 when they touch
    double depth = 0;           ///< model units; 0 when they do not touch, and of given poses
    /// `hit` is proved of the rotation by the quaternion as it stands, without rounding, too
    /// (level E3): the rounding of the pose cannot change the answer.
    bool is_rigid = false;
};

struct PoseSetOptions {
    std::uint64_t seed = 1;
    std::size_t per_stratum = 50;
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};  ///< true ends all soon: poses are then missing
};

struct PoseSet {
    std::uint64_t seed = 0;
    std::string source{};          ///< where the poses were read from; empty: they are drawn
    double diagonal = 0;           ///< of the smaller one of the models' boxes, model units
    std::vector<StudyPose> poses;  ///< by stratum
    std::array<std::size_t, kStrata> missing{};  ///< asked for and not found: see below

    [[nodiscard]] std::vector<std::size_t> of(Stratum stratum) const;
};

/// Draws poses of which the answers are known. B is turned evenly at random and comes to a
/// random place of A's box from a random direction, step by step as far as nothing can touch
/// (conservative advancement by distance()), until it first touches; from there it goes on,
/// or back, by what the stratum wants, evenly by factors where that covers several. Then the
/// answer and the distance are asked, and a pose that belongs elsewhere is drawn again,
/// a few times; where models are such that some stratum is hard to find, poses are missing.
///
/// Pose number i of a stratum depends on the models, the seed, the stratum and i alone: the
/// same for any parallel_for, and the first ones of a larger set are those of a smaller one.
/// Both models need what distance() needs, of solids. No poses of models without triangles or
/// extent. About 30 distances and 60 collisions a pose.
[[nodiscard]] PoseSet make_pose_set(const Model& a, const Model& b,
                                    const PoseSetOptions& options = {});

/// A pose that is not drawn, and the stratum that it is said to be of, if of any.
struct GivenPose {
    Pose a_from_b;
    std::optional<Stratum> stratum;
};

/// Asks what is true at given poses, and sorts them by stratum; in a stratum they keep their
/// order. How deep a pose is cannot be found from it: surfaces that touch are taken to be of the
/// stratum that they are said to be of, `deep` when none is said or when surfaces of it never
/// touch. Surfaces apart go by their distance; beyond the farthest they are `far`. The same for
/// any parallel_for; the seed and per_stratum are not used.
[[nodiscard]] PoseSet ask_poses(const Model& a, const Model& b, std::span<const GivenPose> given,
                                std::string source, const PoseSetOptions& options = {});

/// Checksum of the poses as they stand, twelve doubles each: equal sets have equal ones.
[[nodiscard]] std::uint64_t hash_of(const PoseSet& set);

/// The stratum of that name; nothing when there is none.
[[nodiscard]] std::optional<Stratum> find_stratum(std::string_view name) noexcept;

/// The stratum of a pose with that depth or gap, as shares of the diagonal; nothing beyond
/// the deepest and the farthest.
[[nodiscard]] std::optional<Stratum> stratum_of(bool hit, double depth, double gap) noexcept;

}  // namespace cdprep::study
