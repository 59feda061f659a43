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

/// Flags in LayerPair::effects: models of the two layers may change between steps, as a LiveModel
/// does. A scene then looks for changes in each step. Models that may tear (Ask::tear) may also
/// deform: Ask::deform is then not needed.
inline constexpr Ask kSceneChanges = Ask::deform | Ask::tear;

/// The effects for pairs of objects of two layers. The two layers may be the same.
///
/// `self` tests each object of one layer against itself: a and b are both that layer. `continuous`
/// finds when two objects touch on the way from their last poses to the present ones. `haptic`
/// computes a distance within a limit of work. With Ask::deform or Ask::tear, `contacts` and
/// `continuous` are refused: pieces and motions do not follow a surface that changes. If only
/// another pair of layers has these flags, `continuous` moves the model's present shape. `haptic`
/// is refused together with `distance`, and with solid bodies.
struct LayerPair {
    std::uint32_t a = 0;  ///< a layer, below kLayers
    std::uint32_t b = 0;
    /// Any of kSceneEffects and kSceneChanges; others are refused. Ask::nothing: the pair is
    /// dropped.
    Ask effects = Ask::nothing;
    double tolerance = 0;  ///< of `within`, in units of the models; finite, at least 0
    /// Of `distance` and `haptic`: objects farther apart have no distance. In units of the models;
    /// finite, at least 0.
    double max_distance = 0;
    /// Of `distance`: the permitted error of its answers, and of answers that follow from them (see
    /// Rung). In units of the models; finite, at least 0. 0: answers are exact.
    double max_error = 0;
    Body body = Body::surface;          ///< of `collide`, `distance`, `contacts` and `continuous`
    Overlap overlap = Overlap::closed;  ///< of `collide` and `overlap`
    /// Of `contacts`: the tolerance and the angle are finite and at least 0, and `most` is 1 to
    /// kMostListedContacts.
    ContactOptions contacts = {.most = 16};
    ImpactOptions impact = {};  ///< of `continuous`; `most_steps` is at least 1
    std::uint64_t work = 0;     ///< of `haptic`: DistanceBudget::work, at least 1
    /// Also lists an event in each step for an effect that goes on.
    bool lists_stays = false;
};

/// The method to compute distances for which LayerPair::max_error permits an error. The plan
/// chooses the cheapest method that is certified for every model of both layers. The plan reads
/// ModelUse::parts and never a clock, so the same files give the same plan.
///
/// For `distance`, [lower, upper] contains the exact distance. Its width is at most
/// PairRung::error, plus rounding. Rounding is at most 3e-12 of `upper`, plus 1e-13 of the largest
/// coordinate of a model or a translation.
///
/// An error never removes an effect from SceneHit::holds. It may add one if the exact distance is
/// above the threshold by at most PairRung::error, plus rounding. This threshold is 0 for
/// `collide`, max_distance for `distance`, and the tolerance for `within`. `within` is exact unless
/// the pair also has `distance` of surfaces. `collide` is exact unless parts decide it. While
/// `distance` is paused, both are exact. max_error changes no other effect: an error would make
/// none of them cheaper.
///
/// No rung uses a tetra-tree, so a scene does not need the separate library cdprep::cells.
enum class Rung : std::uint8_t {
    /// Through the BVH. The search of `distance` ends at max_error.
    walk,
    /// Of solids: through their enclosing parts (EnclosingParts). Layers whose models may change
    /// (kSceneChanges) do not use them. Witnesses lie on parts, at most the parts' errors away from
    /// the solids. Their triangles are kNoTriangleNumber. If parts touch, solids count as
    /// colliding, and `collide` reports no containment. With Overlap::proper, `collide` is exact
    /// and reports containment. If the parts of two objects do not certify PairRung::error, these
    /// objects use Rung::walk.
    parts,
};

/// The largest product of the part counts of two models for which the plan chooses parts. In
/// measurements, parts are cheaper than the walk up to a product of 4, and not at 9: see
/// lib/scene/part_distance.h.
inline constexpr std::uint64_t kMostPartPairs = 6;

/// The number in Distance::triangle_a and triangle_b if the witness lies on no triangle.
inline constexpr std::uint32_t kNoTriangleNumber = 0xffffffffU;

/// The rung of a pair of layers.
struct PairRung {
    Rung rung = Rung::walk;
    double error = 0;  ///< certified: the largest error of an answer, model units
    /// With Rung::parts, the largest part count of a model of LayerPair::a, and of LayerPair::b.
    /// Otherwise 0.
    std::uint32_t parts_a = 0;
    std::uint32_t parts_b = 0;
};

/// The use of a model in a scene.
struct ModelUse {
    std::string_view name;  ///< for refusals
    Ask serves;             ///< Model::asks()
    std::uint32_t layers;   ///< of its objects: bit i for layer i
    /// The result of enclosing_parts(). Rung::parts requires that all models of both layers have
    /// parts and serve Ask::hulls.
    EnclosingParts parts = {};
};

struct SceneLimits {
    std::uint32_t objects = 0;
    /// The maximum number of pairs of objects whose boxes meet, as in BroadPhaseLimits::pairs. An
    /// object that is tested against itself counts as a pair.
    std::uint32_t pairs = 0;
    std::uint32_t threads = 1;  ///< the maximum number of tasks at once; at least one
    /// The maximum total length of the lists of `overlap` and `self`. Lists take memory only if a
    /// pair of layers asks for the effect.
    std::uint32_t triangle_pairs = 0;
    std::uint32_t contacts = 0;  ///< the maximum total length of the lists of `contacts`
};

struct PlanOptions {
    std::span<const LayerPair> pairs;
    std::span<const ModelUse> models = {};
    SceneLimits limits;
    /// A point near the objects. Its coordinates are finite, and at most 2^1000 in absolute value.
    /// Boxes of objects are relative to it, so that they stay tight in float. It affects which
    /// boxes meet, and so how many pairs need room. It changes no result, except what `haptic`
    /// keeps from earlier steps.
    Double3 origin{};
    /// The names of layers 0, 1, ..., for refusals and Plan::describe(). There, a layer without a
    /// name appears as its number.
    std::span<const std::string_view> layer_names = {};
};

/// The queries that a scene runs, compiled once from the effects of pairs of layers.
///
/// Two objects whose layers are not paired are never a candidate. A query runs only for effects
/// that its pair of layers asks for.
class Plan {
public:
    struct Compiled;
    /// Returns the plan, or every reason why there is none, a sentence each. Refuses unknown
    /// layers, repeated pairs of layers, effects that a scene does not support, and numbers out of
    /// range. Also refuses options that no effect reads, and models that do not serve an effect of
    /// their layers. If a pair of layers has an effect that scenes do not support, the other
    /// options of this pair are not checked.
    [[nodiscard]] CDPREP_API static Compiled compile(const PlanOptions& options);

    [[nodiscard]] const SceneLimits& limits() const noexcept {
        return limits_;
    }
    [[nodiscard]] const Double3& origin() const noexcept {
        return origin_;
    }
    /// The pairs of layers that ask for something, in the order of PlanOptions::pairs.
    [[nodiscard]] std::span<const LayerPair> pairs() const noexcept {
        return pairs_;
    }
    /// The rung of each pair of pairs(). Its error is 0 if LayerPair::max_error is 0.
    [[nodiscard]] std::span<const PairRung> rungs() const noexcept {
        return rungs_;
    }
    /// Returns the index in pairs() of the pair of two layers, or nothing if they are not paired.
    [[nodiscard]] CDPREP_API std::optional<std::uint32_t> find_pair(std::uint32_t a,
                                                                    std::uint32_t b) const noexcept;
    /// Returns the features that the models of a layer must serve: open them for these. They
    /// include Ask::solid for Body::solid, and Ask::hulls for Rung::parts.
    [[nodiscard]] CDPREP_API Ask asks_of(std::uint32_t layer) const noexcept;
    /// Returns a filter with this layer and the layers that are paired with it. A pair of layers
    /// counts only if it has an effect between two objects: not only `self`, Ask::deform or
    /// Ask::tear.
    [[nodiscard]] CDPREP_API BoxFilter filter_of(std::uint32_t layer) const noexcept;
    /// Returns the margin by which the boxes of a layer's objects are enlarged, in units of the
    /// models.
    [[nodiscard]] CDPREP_API double reach_of(std::uint32_t layer) const noexcept;
    /// Returns the layers whose pairs ask for any of these effects: bit i for layer i.
    [[nodiscard]] CDPREP_API std::uint32_t layers_of(Ask effects) const noexcept;
    /// Returns all effects of all pairs.
    [[nodiscard]] CDPREP_API Ask effects() const noexcept;

    /// Returns a report of about a page. It begins with a line for each of pairs(): the effects,
    /// and the queries from which some of them follow. With a max_error, the line also has the rung
    /// and its error. Then the report lists the effects that are not computed. It lists layers that
    /// are never tested together. It lists layers in no pair only if the options mention them. It
    /// ends with the sections of the models that are read, and the size of a Scene.
    [[nodiscard]] CDPREP_API std::string describe() const;

private:
    explicit Plan(const PlanOptions& options);
    [[nodiscard]] std::string unpaired_text() const;
    [[nodiscard]] std::string models_text() const;

    SceneLimits limits_;
    Double3 origin_{};
    /// The layers that have a name, a model or a pair in the options: bit i for layer i.
    std::uint32_t layers_ = 0;
    std::vector<LayerPair> pairs_;
    std::vector<PairRung> rungs_;  ///< of pairs_
    std::vector<std::string> layer_names_;
    /// [a][b]: 1 more than the pair's number; 0: not paired.
    std::array<std::uint16_t, std::size_t{kLayers} * kLayers> number_{};
};

struct Plan::Compiled {
    std::optional<Plan> plan;
    std::vector<std::string> refusals;  ///< empty if and only if there is a plan
};

}  // namespace cdprep
