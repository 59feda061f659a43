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

/// The class of a pose by the depth or distance of the two surfaces, in percent of
/// PoseSet::diagonal. The depth is how far B moved since it first touched A on its way in. Moving
/// back by this length separates the surfaces, so it is not less than the penetration depth.
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

/// A pose and the true answers in it. They are the library's answers at level E1 (GLOSSARY.md):
/// exact for the vertices of B that transform_point() returns.
struct StudyPose {
    Pose a_from_b;
    std::array<double, 4> quaternion{};  ///< the source of the rotation: w, x, y, z
    Stratum stratum{};
    bool hit = false;           ///< the surfaces have a common point
    Answer solid = Answer::no;  ///< the solids have one; unknown if a model is unbalanced
    double gap_lower = 0;       ///< the surfaces' distance is in [gap_lower, gap_upper], model
    double gap_upper = 0;       ///< units; both are 0 if the surfaces touch
    double depth = 0;           ///< model units; 0 if they do not touch, and for given poses
    /// `hit` is also proved for the exact rotation of the quaternion (level E3). So the rounding of
    /// the pose cannot change the answer.
    bool is_rigid = false;
};

struct PoseSetOptions {
    std::uint64_t seed = 1;
    std::size_t per_stratum = 50;
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};  ///< true ends the search soon; poses are then missing
};

struct PoseSet {
    std::uint64_t seed = 0;
    std::string source{};          ///< where the poses were read from; empty: they are drawn
    double diagonal = 0;           ///< of the smaller of the models' boxes, model units
    std::vector<StudyPose> poses;  ///< by stratum
    std::array<std::size_t, kStrata> missing{};  ///< requested but not found: see make_pose_set()

    [[nodiscard]] std::vector<std::size_t> of(Stratum stratum) const;
};

/// Draws poses and computes their answers. B gets a uniformly random rotation and moves towards a
/// random place of A's box from a random direction. It advances by steps in which nothing can touch
/// (conservative advancement by distance()) until it first touches A. From there it moves on or
/// back by a random length from the stratum's range, log-uniform if the range covers several
/// factors. Then the answer and the distance are computed. A pose that belongs to another stratum
/// is drawn again, a few times. If poses of a stratum are rare for these models, some are missing.
///
/// Pose number i of a stratum depends only on the models, the seed, the stratum and i. So it is the
/// same for any parallel_for, and the first poses of a larger set are those of a smaller one. Both
/// models must serve distance() of solids. Models without triangles or extent give no poses.
/// Neither do models so large that a pose would leave the range of Pose. Costs about 30 distance
/// and 60 collision queries per pose.
[[nodiscard]] PoseSet make_pose_set(const Model& a, const Model& b,
                                    const PoseSetOptions& options = {});

/// A pose that is given, not drawn, and its stratum if that is given too.
struct GivenPose {
    Pose a_from_b;
    std::optional<Stratum> stratum;
};

/// Computes the answers for given poses and sorts the poses by stratum, stably. A pose does not
/// determine its depth. So surfaces that touch get the given stratum, or `deep` if none is given or
/// its surfaces never touch. Surfaces that are apart get the stratum of their distance, `far` if it
/// is beyond all strata. The result does not depend on parallel_for. The seed and per_stratum are
/// not used.
[[nodiscard]] PoseSet ask_poses(const Model& a, const Model& b, std::span<const GivenPose> given,
                                std::string source, const PoseSetOptions& options = {});

/// Returns a checksum of the poses in their order, twelve doubles each. Equal sets have equal
/// checksums.
[[nodiscard]] std::uint64_t hash_of(const PoseSet& set);

/// Returns the stratum with this name, or nothing.
[[nodiscard]] std::optional<Stratum> find_stratum(std::string_view name) noexcept;

/// Returns the stratum of a pose with this depth or gap, both as shares of the diagonal. Returns
/// nothing if it is beyond all strata.
[[nodiscard]] std::optional<Stratum> stratum_of(bool hit, double depth, double gap) noexcept;

}  // namespace cdprep::study
