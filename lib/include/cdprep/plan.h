// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/ask.h"
#include "cdprep/broad_phase.h"
#include "cdprep/contacts.h"
#include "cdprep/format/api.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "cdprep/time_of_impact.h"

namespace cdprep {

/// The number of layers of a scene. An object is in one of them.
inline constexpr std::uint32_t kLayers = 32;

/// The effects that a scene computes.
inline constexpr std::array kSceneEffects = {Ask::collide,  Ask::overlap,  Ask::within,
                                             Ask::distance, Ask::contacts, Ask::continuous,
                                             Ask::self,     Ask::haptic};

/// What a pair of layers says of its models: between two steps, they may change as a LiveModel
/// does. A scene then looks for changes in each step. Ask::tear includes Ask::deform.
inline constexpr Ask kSceneChanges = Ask::deform | Ask::tear;

/// The effects for pairs of objects of two layers. The two may be the same layer.
///
/// `self` is about each object of one layer, and its own surface: a and b are that layer.
/// `continuous` tells when two objects touch on the way from their last poses to the present ones.
/// `haptic` is a distance within a limit of work. Contacts, and `continuous`, are refused together
/// with Ask::deform and Ask::tear: pieces and motions do not follow a surface that changes. If only
/// another pair of layers says that a model changes, `continuous` moves its present shape. `haptic`
/// is refused together with `distance`, and with solid bodies.
struct LayerPair {
    std::uint32_t a = 0;  ///< a layer, below kLayers
    std::uint32_t b = 0;
    /// Any of kSceneEffects and kSceneChanges; others are refused. Nothing: the pair is dropped.
    Ask effects = Ask::nothing;
    double tolerance = 0;  ///< of `within`, in units of the models; finite, at least 0
    /// Of `distance` and `haptic`: farther objects have none. In units of the models; finite, at
    /// least 0.
    double max_distance = 0;
    /// Of `distance`: the error that its answers may have, and those that follow from them (Rung).
    /// In units of the models; finite, at least 0. 0: answers are exact.
    double max_error = 0;
    Body body = Body::surface;          ///< of `collide`, `distance`, `contacts` and `continuous`
    Overlap overlap = Overlap::closed;  ///< of `collide` and `overlap`
    /// Of `contacts`: the tolerance is finite, and `most` is at least 1.
    ContactOptions contacts = {.most = 16};
    ImpactOptions impact = {};  ///< of `continuous`
    std::uint64_t work = 0;     ///< of `haptic`: DistanceBudget::work, at least 1
    /// Also lists an event in each step for an effect that goes on.
    bool lists_stays = false;
};

/// How distances are computed that LayerPair::max_error permits to be inexact. The plan chooses the
/// cheapest way that is certified for every model of both layers. It reads numbers of the files and
/// never a clock, so the same files give the same plan.
///
/// `distance`: [lower, upper] contains the exact distance, and is at most PairRung::error wide,
/// plus rounding. Rounding is at most 3e-12 of `upper`, and 1e-13 of the largest coordinate of a
/// model or a translation.
///
/// Flags: a `no` is right. A `yes` may be wrong if the exact distance is above the threshold by at
/// most PairRung::error, plus rounding. The threshold is 0 for `collide`, max_distance for
/// `distance`, and the tolerance for `within`. `within` is exact unless the pair also has
/// `distance` of surfaces. `collide` is exact unless parts decide it. While `distance` is paused,
/// both are exact. So are all other effects: they are as cheap.
///
/// Levels of a tetra-tree are no rung: a scene does not need cdprep::cells, a library of its own.
enum class Rung : std::uint8_t {
    /// Through the BVH. The search of `distance` ends at max_error; all else is exact.
    walk,
    /// Of solids: through their enclosing parts (EnclosingParts). Witnesses lie on parts, as far
    /// from the solids as the parts' errors say, and have no triangles: kNoTriangleNumber. If parts
    /// touch, solids count as colliding, and `collide` reports no containment. With
    /// Overlap::proper, `collide` is exact and reports it. Two objects whose own parts do not
    /// certify PairRung::error take the walk.
    parts,
};

/// The largest product of part counts of two models for which parts are cheaper than the walk:
/// measured, see lib/scene/part_distance.h.
inline constexpr std::uint64_t kMostPartPairs = 6;

/// Instead of a triangle of a Distance: its witness lies on no triangle.
inline constexpr std::uint32_t kNoTriangleNumber = 0xffffffffU;

/// The rung of a pair of layers.
struct PairRung {
    Rung rung = Rung::walk;
    double error = 0;  ///< certified: the largest error of an answer, model units
    /// Of Rung::parts: the most parts of a model of LayerPair::a and ::b, otherwise 0.
    std::uint32_t parts_a = 0;
    std::uint32_t parts_b = 0;
};

/// The use of a model in a scene.
struct ModelUse {
    std::string_view name;  ///< for refusals
    Ask serves;             ///< Model::asks()
    std::uint32_t layers;   ///< of its objects: bit i for layer i
    /// enclosing_parts() of the model. Rung::parts needs them of all models of a layer, and that
    /// these serve Ask::hulls.
    EnclosingParts parts = {};
};

struct SceneLimits {
    std::uint32_t objects = 0;
    /// Pairs of objects whose boxes meet at a time, as BroadPhaseLimits::pairs. An object that is
    /// asked about itself counts as a pair.
    std::uint32_t pairs = 0;
    std::uint32_t threads = 1;  ///< tasks that a step runs at a time; at least one
    /// The maximum length of all lists of `overlap` and `self` together, and of all lists of
    /// `contacts`. Takes memory only if a pair of layers asks for the effect.
    std::uint32_t triangle_pairs = 0;
    std::uint32_t contacts = 0;
};

struct PlanOptions {
    std::span<const LayerPair> pairs;
    std::span<const ModelUse> models = {};
    SceneLimits limits;
    /// A point near the objects, finite and at most 2^1000. Their boxes are relative to it, so that
    /// they stay tight in float. It changes which boxes meet, and so how many pairs need room. It
    /// changes no result.
    Double3 origin{};
    /// Of layers 0, 1, ..., for refusals and Plan::describe(). A layer without a name is a number
    /// there.
    std::span<const std::string_view> layer_names = {};
};

/// What a scene computes, and nothing else: compiled once from the effects of pairs of layers.
///
/// Objects of layers that are not paired are never looked at together, not even their boxes. A
/// query runs only for effects that its pair of layers asks for.
class Plan {
public:
    struct Compiled;
    /// Returns the plan, or every reason why there is none, a sentence each. Refuses unknown
    /// layers, a pair of layers that occurs twice, effects that are not built, and numbers out of
    /// range. Also refuses options that no effect reads, and models that do not serve an effect of
    /// their layers.
    [[nodiscard]] CDPREP_API static Compiled compile(const PlanOptions& options);

    [[nodiscard]] const SceneLimits& limits() const noexcept {
        return limits_;
    }
    [[nodiscard]] const Double3& origin() const noexcept {
        return origin_;
    }
    /// The pairs of layers that ask for something, in their order.
    [[nodiscard]] std::span<const LayerPair> pairs() const noexcept {
        return pairs_;
    }
    /// The rung of each pair of pairs(). It is exact if LayerPair::max_error is 0.
    [[nodiscard]] std::span<const PairRung> rungs() const noexcept {
        return rungs_;
    }
    /// Returns the number of the pair of two layers among pairs(), or nothing if they are not
    /// paired.
    [[nodiscard]] CDPREP_API std::optional<std::uint32_t> find_pair(std::uint32_t a,
                                                                    std::uint32_t b) const noexcept;
    /// Returns what the objects of a layer are asked for: open their models for this. It includes
    /// Ask::hulls for Rung::parts.
    [[nodiscard]] CDPREP_API Ask asks_of(std::uint32_t layer) const noexcept;
    /// Returns the layers with which a layer is paired. A pair counts as none if it asks for no
    /// effect of two objects, but for `self`, Ask::deform or Ask::tear.
    [[nodiscard]] CDPREP_API BoxFilter filter_of(std::uint32_t layer) const noexcept;
    /// Returns the margin by which the boxes of a layer's objects are enlarged, in units of the
    /// models.
    [[nodiscard]] CDPREP_API double reach_of(std::uint32_t layer) const noexcept;
    /// Returns the layers whose pairs ask for any of these effects: bit i for layer i.
    [[nodiscard]] CDPREP_API std::uint32_t layers_of(Ask effects) const noexcept;
    /// Returns all effects of all pairs.
    [[nodiscard]] CDPREP_API Ask effects() const noexcept;

    /// Returns a page of text. Its first lines are those of pairs(), one each: the effects, and the
    /// queries that run. With a max_error, also the rung and its error. Then it lists what is not
    /// computed, and the layers that are not looked at. At the end are the sections that are read
    /// of the models, and the size of a Scene.
    [[nodiscard]] CDPREP_API std::string describe() const;

private:
    explicit Plan(const PlanOptions& options);
    [[nodiscard]] std::string unpaired_text() const;
    [[nodiscard]] std::string models_text() const;

    SceneLimits limits_;
    Double3 origin_{};
    /// Those that have a name, a model or a pair in the options: bit i for layer i.
    std::uint32_t layers_ = 0;
    std::vector<LayerPair> pairs_;
    std::vector<PairRung> rungs_;  ///< of pairs_
    std::vector<std::string> layer_names_;
    /// [a][b]: 1 more than the pair's number.
    std::array<std::uint16_t, std::size_t{kLayers} * kLayers> number_{};
};

struct Plan::Compiled {
    std::optional<Plan> plan;
    std::vector<std::string> refusals;  ///< empty if and only if there is a plan
};

}  // namespace cdprep
