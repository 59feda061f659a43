// SPDX-License-Identifier: MIT
#include "cdprep/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cdprep/format/sections.h"
#include "cdprep/scene.h"
#include "scene/ask_pair.h"
#include "support/float_modes.h"

namespace cdprep {
namespace {

constexpr SceneLimits kLimits = {.objects = 10, .pairs = 100};

Plan::Compiled compiled(const std::vector<LayerPair>& pairs,
                        const std::vector<ModelUse>& models = {},
                        const SceneLimits& limits = kLimits) {
    return Plan::compile({.pairs = pairs, .models = models, .limits = limits});
}

using Sentences = std::vector<std::string>;

/// Returns the text of a plan up to what it says of models, which TellsSectionsAndSize checks.
std::string effects_of(const Plan& plan) {
    const std::string text = plan.describe();
    return text.substr(0, std::min(text.find("models of layer"), text.find("the state of")));
}

/// The line of a text that begins so, or nothing.
std::string line_of(const std::string& text, const std::string& begin) {
    const std::size_t at = text.find("\n" + begin);
    if (at == std::string::npos) return {};
    return text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

TEST(Plan, DropsWhatNobodyAsksFor) {
    const Plan::Compiled made = compiled({{.a = 0, .b = 1, .effects = Ask::collide},
                                          {.a = 2, .b = 2, .effects = Ask::nothing},
                                          {.a = 3,
                                           .b = 1,
                                           .effects = Ask::within | Ask::distance,
                                           .tolerance = 0.5,
                                           .max_distance = 2}});
    ASSERT_TRUE(made.plan);
    EXPECT_EQ(made.refusals, Sentences());
    const Plan& plan = *made.plan;
    EXPECT_EQ(plan.pairs().size(), 2U);
    EXPECT_EQ(plan.find_pair(0, 1), 0U);
    EXPECT_EQ(plan.find_pair(1, 3), 1U);
    EXPECT_EQ(plan.find_pair(2, 2), std::nullopt);
    EXPECT_EQ(plan.find_pair(99, 1), std::nullopt);
    EXPECT_EQ(plan.asks_of(1), Ask::collide | Ask::within | Ask::distance);
    EXPECT_EQ(plan.asks_of(2), Ask::nothing);
    EXPECT_EQ(plan.reach_of(0), 0);
    EXPECT_EQ(plan.reach_of(1), 1);
    EXPECT_FALSE(plan.filter_of(0).allows(plan.filter_of(3)));
    EXPECT_TRUE(plan.filter_of(3).allows(plan.filter_of(1)));
    EXPECT_EQ(effects_of(plan),
              "layers 0 and 1: collide\n"
              "layers 3 and 1: within 0.5 (mostly from distance), distance up to 2\n"
              "not requested by any pair of layers: overlap, contacts, continuous, self, haptic\n"
              "layers never tested against each other: 0 and 0, 0 and 3, 1 and 1, 3 and 3\n"
              "layers in no pair, whose objects are never tested: 2\n");
    EXPECT_EQ(effects_of(*compiled({}).plan),
              "not requested by any pair of layers: collide, overlap, within, distance, "
              "contacts, continuous, self, haptic\n");
}

TEST(Plan, RefusesAnOriginThatIsNoPoint) {
    constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(Plan::compile({.pairs = {}, .limits = kLimits, .origin = {1, kNoNumber, -HUGE_VAL}})
                  .refusals,
              Sentences({"origin holds nan; it must be finite, and at most 2^1000.",
                         "origin holds -inf; it must be finite, and at most 2^1000."}));
    EXPECT_TRUE(
        Plan::compile({.pairs = {}, .limits = kLimits, .origin = {0x1p1000, -0x1p1000, 0}}).plan);
    EXPECT_FALSE(
        Plan::compile({.pairs = {}, .limits = kLimits, .origin = {0, 0, 0x1.0000000000001p1000}})
            .plan);
}

// By hand: half a tolerance, also in modes that take it for 0.
TEST(Plan, IsToldAlikeInEveryFloatMode) {
    const Plan::Compiled made =
        compiled({{.a = 0, .b = 1, .effects = Ask::within, .tolerance = 0x1p-1060}});
    ASSERT_TRUE(made.plan);
    const std::string expected = made.plan->describe();
    for (const test::FloatMode& mode : test::float_modes()) {
        double reach = 1;
        std::string text;
        static_cast<void>(test::run_in(mode, [&] {
            reach = made.plan->reach_of(0);
            text = made.plan->describe();
        }));
        EXPECT_EQ(reach, 0x1p-1061) << mode.name;
        EXPECT_EQ(text, expected) << mode.name;
    }
}

TEST(Plan, AsksForSolidsWhereTheyAreRead) {
    const auto made = compiled({{.effects = Ask::collide, .body = Body::solid},
                                {.a = 1, .effects = Ask::contacts, .body = Body::solid}});
    EXPECT_EQ(made.plan->asks_of(0), Ask::collide | Ask::contacts | Ask::solid);
    EXPECT_EQ(made.plan->asks_of(1), Ask::contacts | Ask::solid);
}

TEST(Plan, DescribesListsAndTheirLimits) {
    const auto made = compiled({{.effects = Ask::collide | Ask::overlap | Ask::contacts,
                                 .overlap = Overlap::proper,
                                 .contacts = {.tolerance = 0.25, .most = 8, .work = 1000}}});
    EXPECT_EQ(effects_of(*made.plan),
              "layers 0 and 0: collide, proper (from overlap), overlap, proper, contacts within "
              "0.25, at most 8, work 1000\n"
              "not requested by any pair of layers: within, distance, continuous, self, "
              "haptic\n");
    EXPECT_EQ(made.plan->reach_of(0), 0.125);
}

constexpr const char* kChangingContacts =
    "Pair 0 of layers: contacts is not supported for models that deform or tear: pieces do not "
    "follow the surface. Use overlap, within or distance.";
constexpr const char* kChangingContinuous =
    "Pair 0 of layers: continuous is not supported for models that deform or tear. Use within or a "
    "Sweep.";
constexpr const char* kSelfOfTwo =
    "Pair 0 of layers: self tests single objects. Request it for a pair of one layer with itself.";
constexpr const char* kTwoDistances =
    "Pair 0 of layers: haptic is a distance within a limit of work. Request haptic or distance, "
    "not both.";
constexpr const char* kSolidHaptic =
    "Pair 0 of layers: haptic supports surfaces only. Use distance for solids.";

/// The refusal of an effect that scenes do not compute.
std::string unbuilt(const std::string& name) {
    return "Pair 0 of layers: " + name +
           " is not supported in a scene. Supported effects: collide, overlap, within, distance, "
           "contacts, continuous, self, haptic, deform and tear.";
}

/// The refusals of a pair of layers, as the header tells them.
Sentences refusals_of(const LayerPair& pair) {
    const auto asks = [&](Ask some) { return (pair.effects & some) != Ask::nothing; };
    const bool changes = asks(Ask::deform | Ask::tear);
    Sentences sentences;
    if (asks(Ask::response)) sentences.push_back(unbuilt("response"));
    if (asks(Ask::inside)) sentences.push_back(unbuilt("inside"));
    if (changes && asks(Ask::contacts)) sentences.emplace_back(kChangingContacts);
    if (changes && asks(Ask::continuous)) sentences.emplace_back(kChangingContinuous);
    if (asks(Ask::self) && pair.a != pair.b) sentences.emplace_back(kSelfOfTwo);
    if (asks(Ask::haptic) && asks(Ask::distance)) sentences.emplace_back(kTwoDistances);
    if (asks(Ask::haptic) && pair.body == Body::solid) sentences.emplace_back(kSolidHaptic);
    return sentences;
}

// All sets of the ten effects that a scene knows and of the two that it refuses. Each is asked for
// one layer and for two, of surfaces and of solids.
TEST(Plan, DecidesEverySetOfEffects) {
    constexpr std::array kKnown = {Ask::collide,  Ask::overlap,    Ask::within,   Ask::distance,
                                   Ask::contacts, Ask::continuous, Ask::self,     Ask::haptic,
                                   Ask::deform,   Ask::tear,       Ask::response, Ask::inside};
    constexpr Ask kOfBodies = Ask::collide | Ask::distance | Ask::contacts | Ask::continuous;
    int built = 0, refused = 0;
    for (unsigned set = 0; set < 1U << (kKnown.size() + 2); ++set) {
        LayerPair pair = {.a = 4, .b = (set & 1) != 0 ? 7U : 4U};
        for (std::size_t i = 0; i < kKnown.size(); ++i) {
            if ((set >> (i + 2) & 1) != 0) pair.effects = pair.effects | kKnown[i];
        }
        if (contains(pair.effects, Ask::haptic)) pair.work = 1;
        if ((set & 2) != 0) {
            if ((pair.effects & kOfBodies) == Ask::nothing) continue;
            pair.body = Body::solid;
        }
        const auto made = compiled({pair});
        const Sentences expected = refusals_of(pair);
        ASSERT_EQ(made.refusals, expected) << set;
        ASSERT_EQ(made.plan.has_value(), expected.empty());
        (expected.empty() ? built : refused)++;
        // Each set of effects of two objects has a kernel, and only those that are built together.
        const Ask of_two = effects_between(pair);
        if ((pair.effects & (Ask::response | Ask::inside)) != Ask::nothing) continue;
        ASSERT_EQ(pair_kernel(of_two) != nullptr, !contains(of_two, Ask::haptic | Ask::distance));
        if (expected.empty()) {
            ASSERT_EQ(made.plan->effects(), pair.effects);
            ASSERT_NE(pair_kernel(of_two), nullptr);
        }
    }
    // By hand. Of one layer, without and with a change: (3/4 * 256, of haptic and distance) and 3
    // times as many without contacts and continuous. Half of them, without self, of two layers.
    // Solids: without haptic, 128 sets, of which 120 read the body; with a change 32 and 24.
    EXPECT_EQ(built, 192 + 3 * 48 + 96 + 3 * 24 + 120 + 3 * 24 + 60 + 3 * 12);
    EXPECT_GT(refused, 10'000);
}

TEST(Plan, HasNoKernelForEffectsOfSingleObjects) {
    for (int bit = 0; bit < 32; ++bit) {
        const auto one = static_cast<Ask>(1U << bit);
        const bool is_of_two =
            std::find(kSceneEffects.begin(), kSceneEffects.end(), one) != kSceneEffects.end() &&
            one != Ask::self;
        EXPECT_EQ(pair_kernel(one) != nullptr, is_of_two) << bit;
        EXPECT_EQ(pair_kernel(one | Ask::overlap) != nullptr, is_of_two) << bit;
    }
    EXPECT_NE(pair_kernel(Ask::nothing), nullptr);
}

// Rungs ---------------------------------------------------------------------------------------

constexpr Ask kServesParts = Ask::collide | Ask::distance | Ask::solid | Ask::hulls;

ModelUse with_parts(std::uint32_t layers, std::uint32_t count, double error) {
    return {"m", kServesParts, layers, {.first = 3, .count = count, .error = error, .size = 1}};
}

LayerPair near_solids(double max_error) {
    return {.a = 0,
            .b = 1,
            .effects = Ask::collide | Ask::distance,
            .max_distance = 2,
            .max_error = max_error,
            .body = Body::solid};
}

PairRung rung_of(const LayerPair& pair, const std::vector<ModelUse>& models) {
    const auto made = compiled({pair}, models);
    EXPECT_EQ(made.refusals, Sentences());
    return made.plan->rungs()[0];
}

// By hand: 0.25 and 0.125 are the largest errors of the two layers, 3 and 2 the most parts.
TEST(Plan, ChoosesPartsThatCertifyTheError) {
    const std::vector<ModelUse> models = {with_parts(1, 3, 0.25), with_parts(2, 2, 0.125),
                                          with_parts(2, 1, 0)};
    const auto made = compiled({near_solids(0.375)}, models);
    ASSERT_TRUE(made.plan);
    const PairRung& rung = made.plan->rungs()[0];
    EXPECT_EQ(rung.rung, Rung::parts);
    EXPECT_EQ(rung.error, 0.375);
    EXPECT_EQ(rung.parts_a, 3U);
    EXPECT_EQ(rung.parts_b, 2U);
    for (const std::uint32_t layer : {0, 1}) {
        EXPECT_EQ(made.plan->asks_of(layer), kServesParts);
    }
    const std::string text = made.plan->describe();
    EXPECT_EQ(text.substr(0, text.find('\n')),
              "layers 0 and 1: collide of solids (from distance), distance of solids up to 2; "
              "max_error 0.375: by enclosing parts, at most 3 and 2, error at most 0.375");
    EXPECT_NE(text.find("hull_blocks"), std::string::npos);
}

TEST(Plan, ChoosesTheWalkWherePartsDoNotCertify) {
    const std::vector<ModelUse> models = {with_parts(1, 3, 0.25), with_parts(2, 2, 0.125)};
    const double less = std::nextafter(0.375, 0);
    const auto made = compiled({near_solids(less)}, models);
    ASSERT_TRUE(made.plan);
    EXPECT_EQ(made.plan->rungs()[0].rung, Rung::walk);
    EXPECT_EQ(made.plan->rungs()[0].error, less);
    EXPECT_EQ(made.plan->asks_of(0), without(kServesParts, Ask::hulls));
    const std::string text = made.plan->describe();
    EXPECT_EQ(text.substr(0, text.find('\n')),
              "layers 0 and 1: collide of solids, distance of solids up to 2; max_error "
              "0.37499999999999994: by BVH traversal, error at most 0.37499999999999994");
    // Without max_error, nothing is permitted, and nothing told.
    EXPECT_EQ(rung_of(near_solids(0), {with_parts(3, 1, 0)}).rung, Rung::walk);
    EXPECT_EQ(compiled({near_solids(0)}, models).plan->describe().find("max_error"),
              std::string::npos);
}

TEST(Plan, ChoosesPartsWhereTheyAreFew) {
    constexpr auto kMost = static_cast<std::uint32_t>(kMostPartPairs);
    EXPECT_EQ(rung_of(near_solids(1), {with_parts(1, kMost, 0), with_parts(2, 1, 0)}).rung,
              Rung::parts);
    EXPECT_EQ(rung_of(near_solids(1), {with_parts(1, kMost + 1, 0), with_parts(2, 1, 0)}).rung,
              Rung::walk);
    EXPECT_EQ(rung_of(near_solids(1), {with_parts(3, 1U << 31, 0)}).rung, Rung::walk);
}

// Each of these lacks parts that hold for every model of both layers.
TEST(Plan, ChoosesTheWalkWhereModelsLackParts) {
    const ModelUse good = with_parts(1, 1, 0), other = with_parts(2, 1, 0);
    ASSERT_EQ(rung_of(near_solids(1), {good, other}).rung, Rung::parts);
    ModelUse unserved = other;
    unserved.serves = without(kServesParts, Ask::hulls);
    constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
    for (const auto& models :
         std::vector<std::vector<ModelUse>>{{},
                                            {good},
                                            {good, with_parts(4, 1, 0)},
                                            {good, other, with_parts(2, 0, 0)},
                                            {good, unserved},
                                            {good, with_parts(2, 1, kNoNumber)},
                                            {good, with_parts(2, 1, -1)},
                                            {good, with_parts(2, 1, HUGE_VAL)}}) {
        EXPECT_EQ(rung_of(near_solids(1), models).rung, Rung::walk);
    }
    LayerPair surfaces = near_solids(1);
    surfaces.body = Body::surface;
    EXPECT_EQ(rung_of(surfaces, {good, other}).rung, Rung::walk);
    // Models of layer 1 may change, because another pair says so.
    const auto changing = compiled(
        {near_solids(1), {.a = 1, .b = 2, .effects = Ask::collide | Ask::deform}}, {good, other});
    ASSERT_TRUE(changing.plan);
    EXPECT_EQ(changing.plan->rungs()[0].rung, Rung::walk);
}

TEST(Plan, RefusesAnErrorThatNoEffectReads) {
    constexpr const char* kUnread = "max_error has no meaning without distance.";
    EXPECT_EQ(compiled({{.a = 0, .effects = Ask::collide | Ask::within, .max_error = 1},
                        {.a = 1, .effects = Ask::collide, .max_error = 1, .body = Body::solid},
                        {.a = 2, .effects = Ask::haptic, .max_error = 1, .work = 1},
                        {.a = 3, .effects = Ask::distance, .max_error = -1},
                        {.a = 4, .effects = Ask::distance, .max_error = HUGE_VAL}})
                  .refusals,
              Sentences({std::string("Pair 0 of layers: ") + kUnread,
                         std::string("Pair 1 of layers: ") + kUnread,
                         std::string("Pair 2 of layers: ") + kUnread,
                         "Pair 3 of layers: max_error is -1; it must be finite and at least 0.",
                         "Pair 4 of layers: max_error is inf; it must be finite and at least 0."}));
}

TEST(Plan, RefusesEachOtherEffectByItsName) {
    int others = 0;
    for (int bit = 0; bit < 32; ++bit) {
        const auto one = static_cast<Ask>(1U << bit);
        if ((one & (Ask::collide | Ask::overlap | Ask::within | Ask::distance | Ask::contacts |
                    Ask::continuous | Ask::self | Ask::haptic | Ask::deform | Ask::tear)) !=
            Ask::nothing) {
            continue;
        }
        const Needs* needs = find_needs(one);
        const std::string name =
            needs ? std::string(needs->name) : "effect bit " + std::to_string(bit);
        EXPECT_EQ(compiled({{.effects = one}}).refusals, Sentences({unbuilt(name)}));
        ++others;
    }
    EXPECT_EQ(others, 22);
}

TEST(Plan, DescribesMotionsChangesAndSingleObjects) {
    const auto made =
        compiled({{.effects = Ask::self | Ask::deform},
                  {.a = 0, .b = 1, .effects = Ask::collide | Ask::tear, .body = Body::solid},
                  {.a = 1, .b = 1, .effects = Ask::overlap | Ask::tear},
                  {.a = 2,
                   .b = 2,
                   .effects = Ask::continuous,
                   .body = Body::solid,
                   .impact = {.tolerance = 0.5}},
                  {.a = 2, .b = 3, .effects = Ask::haptic, .max_distance = 4, .work = 300}});
    ASSERT_TRUE(made.plan);
    EXPECT_EQ(effects_of(*made.plan),
              "layers 0 and 0: models may deform, self (each object)\n"
              "layers 0 and 1: models may tear, and whether solids touch may then be unknown, "
              "collide of solids\n"
              "layers 1 and 1: models may tear, overlap\n"
              "layers 2 and 2: continuous of solids with tolerance 0.5\n"
              "layers 2 and 3: haptic up to 4, work 300\n"
              "not requested by any pair of layers: within, distance, contacts\n"
              "layers never tested against each other: 0 and 0, 0 and 2, 0 and 3, 1 and 2, 1 "
              "and 3, 3 and 3\n");
    const Plan& plan = *made.plan;
    // Layers 0 and 1 have models that change, 2 and 3 have none.
    const std::string text = plan.describe();
    EXPECT_TRUE(
        line_of(text, "models of layer 0 must").ends_with("must also serve deform or tear"));
    EXPECT_TRUE(
        line_of(text, "models of layer 1 must").ends_with("must also serve deform or tear"));
    EXPECT_EQ(line_of(text, "models of layer 2 must").find("also serve"), std::string::npos);
    EXPECT_GT(line_of(text, "models of layer 3 must serve haptic;").size(), 50U);
    EXPECT_EQ(plan.effects(), Ask::self | Ask::deform | Ask::tear | Ask::collide | Ask::overlap |
                                  Ask::continuous | Ask::haptic);
    // A rigid partner of a model that tears need not serve that.
    EXPECT_EQ(plan.asks_of(0), Ask::self | Ask::collide | Ask::solid);
    EXPECT_EQ(plan.asks_of(2), Ask::continuous | Ask::solid | Ask::haptic);
    EXPECT_EQ(plan.layers_of(Ask::deform | Ask::tear), 3U);
    EXPECT_EQ(plan.layers_of(Ask::self), 1U);
    EXPECT_EQ(plan.reach_of(2), 2);
    EXPECT_EQ(
        compiled({{.effects = Ask::continuous, .impact = {.tolerance = 0.5}}}).plan->reach_of(0),
        0.25);
    // A pair that asks for nothing of two objects: not even their boxes are tested.
    EXPECT_FALSE(plan.filter_of(0).allows(plan.filter_of(0)));
    EXPECT_TRUE(plan.filter_of(0).allows(plan.filter_of(1)));
    EXPECT_TRUE(plan.filter_of(3).allows(plan.filter_of(2)));
}

TEST(Plan, RefusesOptionsOfMotionsThatNoEffectReads) {
    EXPECT_EQ(compiled({{.a = 0,
                         .effects = Ask::collide,
                         .impact = {.tolerance = 1, .most_steps = 3},
                         .work = 5},
                        {.a = 1, .effects = Ask::haptic, .max_distance = -1},
                        {.a = 2,
                         .effects = Ask::continuous,
                         .max_distance = 1,
                         .impact = {.tolerance = HUGE_VAL, .most_steps = 0}}})
                  .refusals,
              Sentences({"Pair 0 of layers: impact.tolerance has no meaning without continuous.",
                         "Pair 0 of layers: impact.most_steps has no meaning without continuous.",
                         "Pair 0 of layers: work has no meaning without haptic.",
                         "Pair 1 of layers: max_distance is -1; it must be finite and at least 0.",
                         "Pair 1 of layers: work is 0; haptic needs at least 1.",
                         "Pair 2 of layers: max_distance has no meaning without distance or "
                         "haptic.",
                         "Pair 2 of layers: impact.tolerance is inf; it must be finite and at "
                         "least 0.",
                         "Pair 2 of layers: impact.most_steps is 0; it must be at least 1."}));
}

TEST(Plan, NamesEveryRefusal) {
    constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
    const auto made =
        compiled({{.a = 32, .b = 0, .effects = Ask::collide},
                  {.a = 1, .b = 2, .effects = Ask::collide, .tolerance = 1},
                  {.a = 2, .b = 1, .effects = Ask::within, .tolerance = -1, .body = Body::solid},
                  {.a = 3,
                   .b = 3,
                   .effects = Ask::distance,
                   .max_distance = kNoNumber,
                   .overlap = Overlap::proper,
                   .contacts = {.tolerance = 2, .most = 8}},
                  {.a = 4,
                   .effects = Ask::contacts,
                   .contacts = {.tolerance = kNoNumber, .most = 0, .cluster_angle = -1}},
                  {.a = 5, .effects = Ask::contacts, .contacts = {.most = 257}}},
                 {}, {.objects = 1U << 30, .pairs = 1, .threads = 0});
    EXPECT_FALSE(made.plan);
    EXPECT_EQ(made.refusals,
              Sentences({"limits.objects is 1073741824; at most 536870912 are possible.",
                         "limits.threads is 0; at least 1 is needed.",
                         "Pair 0 of layers: layer 32 does not exist; there are 0 to 31.",
                         "Pair 1 of layers: tolerance has no meaning without within.",
                         "Pair 2 of layers: layers 2 and 1 are also those of pair 1.",
                         "Pair 2 of layers: tolerance is -1; it must be finite and at least 0.",
                         "Pair 2 of layers: body has no meaning without collide, distance, "
                         "contacts or continuous.",
                         "Pair 3 of layers: max_distance is nan; it must be finite and at least 0.",
                         "Pair 3 of layers: overlap has no meaning without collide or overlap.",
                         "Pair 3 of layers: contacts.tolerance has no meaning without contacts.",
                         "Pair 3 of layers: contacts has no meaning without the effect contacts.",
                         "Pair 4 of layers: contacts.tolerance is nan; it must be finite and at "
                         "least 0.",
                         "Pair 4 of layers: contacts.cluster_angle is -1; it must be finite and at "
                         "least 0.",
                         "Pair 4 of layers: contacts.most is 0; it must be 1 to 256.",
                         "Pair 5 of layers: contacts.most is 257; it must be 1 to 256."}));
}

// By hand: the third layer has no name. No pair names 'debris', nor the layer of a model.
TEST(Plan, TellsLayersInNoPair) {
    const std::vector<std::string_view> names = {"floor", "crates", "", "debris"};
    const std::vector<LayerPair> pairs = {{.a = 0, .b = 1, .effects = Ask::collide},
                                          {.a = 2, .b = 2, .effects = Ask::self}};
    const std::vector<ModelUse> models = {
        {.name = "arm.cdp.h5", .serves = Ask::collide, .layers = 1U << 9 | 1U << 31}};
    const auto made =
        Plan::compile({.pairs = pairs, .models = models, .limits = kLimits, .layer_names = names});
    ASSERT_TRUE(made.plan);
    EXPECT_EQ(effects_of(*made.plan),
              "layers 'floor' and 'crates': collide\n"
              "layers 2 and 2: self (each object)\n"
              "not requested by any pair of layers: overlap, within, distance, contacts, "
              "continuous, haptic\n"
              "layers never tested against each other: 'floor' and 'floor', 'floor' and 2, "
              "'crates' and 'crates', 'crates' and 2, 2 and 2\n"
              "layers in no pair, whose objects are never tested: 'debris', 9 and 31\n");
}

// The sections are those of the table of needs: each name is told, and no other.
TEST(Plan, TellsSectionsAndSize) {
    const auto made = compiled({{.a = 0, .b = 1, .effects = Ask::collide},
                                {.a = 1, .b = 2, .effects = Ask::collide},
                                {.a = 3,
                                 .b = 3,
                                 .effects = Ask::overlap | Ask::contacts,
                                 .body = Body::solid,
                                 .contacts = {.most = 4}}});
    ASSERT_TRUE(made.plan);
    const std::string text = made.plan->describe();
    const std::string flags = line_of(text, "models of layers 0, 1 and 2 must serve collide; ");
    const std::string lists =
        line_of(text, "models of layer 3 must serve overlap, contacts and solid; ");
    const auto expect_sections = [](const std::string& line, Ask asks) {
        std::vector<std::string> names;
        for (const format::SectionKind& kind : format::section_kinds()) {
            if (sections_for(asks).contains(kind.id)) names.emplace_back(kind.name);
        }
        std::string expected;
        for (std::size_t i = 0; i < names.size(); ++i) {
            expected += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
        }
        EXPECT_GT(names.size(), 2U);
        EXPECT_EQ(line.substr(std::min(line.size(), line.find(": ") + 2)), expected);
    };
    expect_sections(flags, Ask::collide);
    expect_sections(lists, Ask::overlap | Ask::contacts | Ask::solid);
    EXPECT_EQ(line_of(text, "the state of a scene: "),
              "the state of a scene: " + std::to_string(Scene::size(*made.plan)) +
                  " bytes for 10 objects, 100 pairs of boxes and 1 thread, 0 listed triangle "
                  "pairs, 0 listed contacts");
    // A plan that asks for nothing tells its size as well.
    const std::string none = compiled({}).plan->describe();
    EXPECT_EQ(none.find("models of"), std::string::npos);
    EXPECT_NE(none.find("the state of a scene: "), std::string::npos);
}

// By hand: the third layer has no name.
TEST(Plan, NamesLayers) {
    const std::vector<std::string_view> names = {"floor", "crates"};
    const std::vector<LayerPair> pairs = {
        {.a = 0, .b = 1, .effects = Ask::collide},
        {.a = 1, .b = 2, .effects = Ask::within, .tolerance = 0.5}};
    const auto made = Plan::compile({.pairs = pairs, .limits = kLimits, .layer_names = names});
    ASSERT_TRUE(made.plan);
    EXPECT_EQ(effects_of(*made.plan),
              "layers 'floor' and 'crates': collide\n"
              "layers 'crates' and 2: within 0.5\n"
              "not requested by any pair of layers: overlap, distance, contacts, continuous, "
              "self, haptic\n"
              "layers never tested against each other: 'floor' and 'floor', 'floor' and 2, "
              "'crates' and 'crates', 2 and 2\n");
    const std::vector<LayerPair> wrong = {{.a = 0, .b = 1, .effects = Ask::collide},
                                          {.a = 1, .b = 0, .effects = Ask::within},
                                          {.a = 2, .b = 2, .effects = Ask::ray}};
    const std::vector<ModelUse> models = {
        {.name = "arm.cdp.h5", .serves = Ask::collide, .layers = 6},
        {.name = "cup.cdp.h5", .serves = Ask::within, .layers = 3}};
    EXPECT_EQ(
        Plan::compile({.pairs = wrong, .models = models, .limits = kLimits, .layer_names = names})
            .refusals,
        Sentences({"Pair 1 of layers, 'crates' and 'floor': layers 'crates' and 'floor' are "
                   "also those of pair 0.",
                   "Pair 2 of layers, 2 and 2: ray is not supported in a scene. Supported effects: "
                   "collide, overlap, within, distance, contacts, continuous, self, haptic, deform "
                   "and tear.",
                   "arm.cdp.h5: its layer 'crates' requests within, which the model does not "
                   "serve. Bake it with --effects within.",
                   "cup.cdp.h5: its layers 'floor' and 'crates' request collide, which the "
                   "model does not serve. Bake it with --effects collide."}));
}

// One sentence for each model, with one option for all that it lacks.
TEST(Plan, SaysHowToBakeAllThatAModelLacks) {
    const std::vector<std::string_view> names = {"floor", "crates"};
    const std::vector<LayerPair> pairs = {
        {.a = 0, .b = 1, .effects = Ask::collide | Ask::contacts, .body = Body::solid},
        {.a = 1, .b = 1, .effects = Ask::distance, .max_distance = 1}};
    const std::vector<ModelUse> models = {{.name = "x", .serves = Ask::nothing, .layers = 1},
                                          {.name = "y", .serves = Ask::collide, .layers = 2}};
    EXPECT_EQ(
        Plan::compile({.pairs = pairs, .models = models, .limits = kLimits, .layer_names = names})
            .refusals,
        Sentences({"x: its layer 'floor' requests collide, contacts and solid, which the model "
                   "does not serve. Bake it with --effects collide,contacts.",
                   "y: its layer 'crates' requests distance, contacts and solid, which the model "
                   "does not serve. Bake it with --effects distance,contacts,collide."}));
}

TEST(Plan, SaysHowToBakeWhatAModelLacks) {
    const std::vector<LayerPair> pairs = {
        {.a = 0, .b = 1, .effects = Ask::distance, .max_distance = 1}};
    const std::vector<ModelUse> models = {
        {.name = "arm.cdp.h5", .serves = Ask::collide, .layers = 2},
        {.name = "cup.cdp.h5", .serves = Ask::collide, .layers = 4},
        {.name = "part.cdp.h5", .serves = Ask::distance | Ask::ray, .layers = 3}};
    EXPECT_EQ(compiled(pairs, models).refusals,
              Sentences({"arm.cdp.h5: its layers request distance, which the model does not serve. "
                         "Bake it with --effects distance."}));
}

}  // namespace
}  // namespace cdprep
