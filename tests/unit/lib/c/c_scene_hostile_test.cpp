// SPDX-License-Identifier: MIT
// What a caller of plans, scenes and the broad phase can get wrong, field by field.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/advanced/object_box.h"
#include "cdprep/cdprep.h"
#include "support/aligned_bytes.h"
#include "support/c_lanes.h"
#include "support/c_mistakes.h"
#include "support/c_models.h"
#include "support/float_modes.h"
#include "support/meshes.h"
#include "support/random_pose.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

constexpr std::uint32_t kAll = CDPREP_ASK_COLLIDE | CDPREP_ASK_WITHIN | CDPREP_ASK_DISTANCE;

cdprep_layer_pair pair_of(std::uint32_t a, std::uint32_t b, std::uint32_t effects) {
    cdprep_layer_pair pair;
    cdprep_layer_pair_init(&pair, sizeof pair);
    pair.a = a;
    pair.b = b;
    pair.effects = effects;
    return pair;
}

cdprep_model_use use_of(const cdprep_model* model, std::uint32_t layers) {
    cdprep_model_use use;
    cdprep_model_use_init(&use, sizeof use);
    use.model = model;
    use.layers = layers;
    return use;
}

/// The sentences of refusals.
struct Told {
    std::vector<std::string> sentences;
    std::size_t most = SIZE_MAX;

    static int take(void* told, const char* sentence) {
        auto* const self = static_cast<Told*>(told);
        self->sentences.emplace_back(sentence);
        return self->sentences.size() < self->most ? 1 : 0;
    }
};

class CSceneHostile : public testing::Test {
protected:
    static AlignedBytes baked() {
        const TestMesh cube = unit_cube();
        return bake_tiny(cube.positions, cube.triangles);
    }
    static cdprep_build_options ray_options(const TestMesh& mesh) {
        cdprep_build_options options = build_options_of(mesh);
        options.ask = CDPREP_ASK_RAY;
        return options;
    }
    CSceneHostile() : rays_only_(ray_options(mesh_), workspace_.get()) {
        plan_ = compiled(options());
        EXPECT_EQ(cdprep_scene_make(plan_, nullptr, 0, &scene_, nullptr), CDPREP_OK);
    }
    ~CSceneHostile() override {
        cdprep_scene_end(scene_);
        cdprep_plan_end(plan_);
    }
    /// Layer 1 asks for everything, and layer 2 for nothing.
    [[nodiscard]] cdprep_plan_options options() const {
        cdprep_plan_options options;
        cdprep_plan_options_init(&options, sizeof options);
        options.layer_pairs = &pair_;
        options.layer_pair_count = 1;
        options.max_objects = 4;
        options.max_pairs = 8;
        return options;
    }
    static cdprep_plan* compiled(const cdprep_plan_options& options) {
        cdprep_plan* plan = nullptr;
        cdprep_error error;
        EXPECT_EQ(cdprep_plan_compile(&options, nullptr, nullptr, &plan, &error), CDPREP_OK)
            << error.message;
        return plan;
    }
    [[nodiscard]] cdprep_object_options object(double x = 0) const {
        cdprep_object_options options;
        cdprep_object_options_init(&options, sizeof options);
        options.model = cube_.get();
        options.layer = 1;
        options.world_from_model.rows[9] = x;
        return options;
    }
    cdprep_object added(double x = 0) {
        const cdprep_object_options options = object(x);
        cdprep_object id{};
        EXPECT_EQ(cdprep_scene_add(scene_, &options, 1, &id, nullptr), CDPREP_OK);
        return id;
    }
    /// Steps; returns the number of objects that had changed.
    std::uint64_t step() {
        cdprep_step step;
        cdprep_counts counts;
        EXPECT_EQ(cdprep_scene_step(scene_, workspace_.get(), &step, nullptr), CDPREP_OK);
        EXPECT_EQ(step.complete, std::uint32_t{CDPREP_YES});
        EXPECT_EQ(cdprep_scene_counts(scene_, &counts, nullptr), CDPREP_OK);
        return counts.n[CDPREP_SCENE_MOVED];
    }
    std::uint64_t object_count() {
        cdprep_counts counts;
        EXPECT_EQ(cdprep_scene_counts(scene_, &counts, nullptr), CDPREP_OK);
        return counts.n[CDPREP_SCENE_OBJECTS];
    }
    /// Compiles a plan that must be refused; returns the outcome.
    static Outcome outcome_of(const cdprep_plan_options* options) {
        auto* plan = reinterpret_cast<cdprep_plan*>(1);
        cdprep_error error;
        Told told;
        const int code = cdprep_plan_compile(options, Told::take, &told, &plan, &error);
        const Outcome result = outcome(code, error, plan == nullptr);
        cdprep_plan_end(plan);
        return result;
    }

    TestMesh mesh_ = unit_cube();
    AlignedBytes file_ = baked();
    CModel cube_{file_};
    CModel opened_for_rays_{file_, CDPREP_ASK_RAY};
    CWorkspace workspace_;
    CBuilt rays_only_;
    cdprep_layer_pair pair_ = pair_of(1, 1, kAll);
    cdprep_plan* plan_ = nullptr;
    cdprep_scene* scene_ = nullptr;
};

// Plans -------------------------------------------------------------------------------------------

TEST_F(CSceneHostile, LayerPairsAreCheckedFieldByField) {
    using P = cdprep_layer_pair;
    std::vector<Mistake<P>> all = struct_mistakes<P>("options.layer_pairs[0]");
    const auto word = [&](const char* name, std::uint32_t P::*field, std::uint32_t least) {
        for (const std::uint32_t value : {least, least | 1U, UINT32_MAX}) {
            all.push_back({name, [=](P& p) { p.*field = value; }, CDPREP_WHY_OUT_OF_RANGE, name});
        }
    };
    word("options.layer_pairs[0].a", &P::a, 32);
    word("options.layer_pairs[0].b", &P::b, 32);
    word("options.layer_pairs[0].effects", &P::effects, CDPREP_ASK_RAY);
    word("options.layer_pairs[0].effects", &P::effects, CDPREP_ASK_SOLID);
    word("options.layer_pairs[0].body", &P::body, 2);
    word("options.layer_pairs[0].overlap", &P::overlap, 2);
    word("options.layer_pairs[0].lists_stays", &P::lists_stays, 2);
    std::vector<std::pair<double, int>> numbers = bad_numbers();
    numbers.emplace_back(kInfinity, CDPREP_WHY_NOT_FINITE);
    numbers.emplace_back(-1, CDPREP_WHY_OUT_OF_RANGE);
    for (const auto& [number, why] : numbers) {
        const double bad = number;
        all.push_back({"tolerance", [bad](P& p) { p.tolerance = bad; }, why,
                       "options.layer_pairs[0].tolerance"});
        all.push_back({"max_distance", [bad](P& p) { p.max_distance = bad; }, why,
                       "options.layer_pairs[0].max_distance"});
        all.push_back({"max_error", [bad](P& p) { p.max_error = bad; }, why,
                       "options.layer_pairs[0].max_error"});
    }
    const auto unused = [&](const char* name, std::uint32_t effects, auto set) {
        all.push_back({name,
                       [=](P& p) {
                           p.effects = effects;
                           set(p);
                       },
                       CDPREP_WHY_NO_MEANING, name});
    };
    unused("options.layer_pairs[0].body", CDPREP_ASK_WITHIN, [](P& p) { p.body = CDPREP_SOLID; });
    unused("options.layer_pairs[0].overlap", CDPREP_ASK_DISTANCE,
           [](P& p) { p.overlap = CDPREP_PROPER; });
    unused("options.layer_pairs[0].tolerance", CDPREP_ASK_COLLIDE,
           [](P& p) { p.tolerance = 0x1p-1060; });
    cdprep_contact_options contacts;
    cdprep_contact_options_init(&contacts, sizeof contacts);
    unused("options.layer_pairs[0].contacts", kAll, [&](P& p) { p.contacts = &contacts; });
    unused("options.layer_pairs[0].max_distance", 0, [](P& p) { p.max_distance = 1; });
    unused("options.layer_pairs[0].max_error", CDPREP_ASK_COLLIDE, [](P& p) {
        p.max_error = 1;
        p.body = CDPREP_SOLID;
    });
    expect_refused(pair_, all, [&](const P* given) {
        cdprep_plan_options changed = options();
        changed.layer_pairs = given;
        return outcome_of(&changed);
    });
}

TEST_F(CSceneHostile, OptionsOfContactsAreCheckedFieldByField) {
    using C = cdprep_contact_options;
    std::vector<Mistake<C>> all = struct_mistakes<C>("options.layer_pairs[0].contacts");
    const auto word = [&](const char* name, std::uint32_t C::*field, std::uint32_t value) {
        all.push_back({name, [=](C& c) { c.*field = value; }, CDPREP_WHY_OUT_OF_RANGE, name});
    };
    for (const std::uint32_t number : {1U, 3U, 5U, UINT32_MAX}) {
        word("options.layer_pairs[0].contacts.manifold", &C::manifold, number);
    }
    for (const std::uint32_t number : {0U, 257U, UINT32_MAX}) {
        word("options.layer_pairs[0].contacts.most", &C::most, number);
    }
    std::vector<std::pair<double, int>> numbers = bad_numbers();
    numbers.emplace_back(kInfinity, CDPREP_WHY_NOT_FINITE);
    numbers.emplace_back(-1, CDPREP_WHY_OUT_OF_RANGE);
    for (const auto& [number, why] : numbers) {
        const double bad = number;
        all.push_back({"tolerance", [bad](C& c) { c.tolerance = bad; }, why,
                       "options.layer_pairs[0].contacts.tolerance"});
        all.push_back({"angle", [bad](C& c) { c.cluster_angle = bad; }, why,
                       "options.layer_pairs[0].contacts.cluster_angle"});
    }
    C right;
    cdprep_contact_options_init(&right, sizeof right);
    right.work = UINT64_MAX;
    right.manifold = 4;
    expect_refused(right, all, [&](const C* given) {
        cdprep_layer_pair pair = pair_of(1, 1, CDPREP_ASK_CONTACTS);
        pair.body = CDPREP_SOLID;
        pair.contacts = given;
        cdprep_plan_options changed = options();
        changed.layer_pairs = &pair;
        Outcome result = outcome_of(&changed);
        if (given == nullptr) result.why = CDPREP_WHY_NULL;  // null means the defaults
        return result;
    });
}

TEST_F(CSceneHostile, ModelUsesAreCheckedFieldByField) {
    using U = cdprep_model_use;
    std::vector<Mistake<U>> all = struct_mistakes<U>("options.models[0]");
    const char* const kModel = "options.models[0].model";
    const char* const kServes = "options.models[0].serves";
    all.push_back({"serves", [](U& u) { u.serves = 1; }, CDPREP_WHY_NO_MEANING, kServes});
    all.push_back({"no bit", [](U& u) { u.serves = 1 << 19; }, CDPREP_WHY_OUT_OF_RANGE, kServes});
    all.push_back(
        {"name", [](U& u) { u.name = "cube"; }, CDPREP_WHY_NO_MEANING, "options.models[0].name"});
    all.push_back({"parts of a model", [](U& u) { u.part_count = 1; }, CDPREP_WHY_NO_MEANING,
                   "options.models[0].part_count"});
    all.push_back({"an error of a model", [](U& u) { u.part_error = 1; }, CDPREP_WHY_NO_MEANING,
                   "options.models[0].part_error"});
    all.push_back({"an error without parts",
                   [](U& u) {
                       u.model = nullptr;
                       u.serves = CDPREP_ASK_COLLIDE;
                       u.part_error = 1;
                   },
                   CDPREP_WHY_NO_MEANING, "options.models[0].part_error"});
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        all.push_back({"part_error", [bad](U& u) { u.part_error = bad; }, why,
                       "options.models[0].part_error"});
    }
    all.push_back(
        {"not baked", [&](U& u) { u.model = rays_only_.get(); }, CDPREP_WHY_NOT_BAKED, kModel});
    all.push_back({"not opened", [&](U& u) { u.model = opened_for_rays_.get(); },
                   CDPREP_WHY_NOT_OPENED, kModel});
    all.push_back(
        {"serves nothing", [](U& u) { u.model = nullptr; }, CDPREP_WHY_NOT_BAKED, kServes});
    all.push_back({"serves little",
                   [](U& u) {
                       u.model = nullptr;
                       u.serves = CDPREP_ASK_COLLIDE | CDPREP_ASK_DISTANCE;
                   },
                   CDPREP_WHY_NOT_BAKED, kServes});
    expect_refused(use_of(cube_.get(), 1 << 1), all, [&](const U* given) {
        cdprep_plan_options changed = options();
        changed.models = given;
        changed.model_count = 1;
        return outcome_of(&changed);
    });
    // Layers that ask for nothing need nothing.
    const U other = use_of(rays_only_.get(), ~(1U << 1));
    cdprep_plan_options changed = options();
    changed.models = &other;
    changed.model_count = 1;
    EXPECT_EQ(outcome_of(&changed).code, CDPREP_OK);
}

TEST_F(CSceneHostile, PlanOptionsAreCheckedFieldByField) {
    using O = cdprep_plan_options;
    std::vector<Mistake<O>> all = struct_mistakes<O>("options");
    const auto word = [&](const char* name, std::uint32_t O::*field, std::uint32_t value) {
        all.push_back({name, [=](O& o) { o.*field = value; }, CDPREP_WHY_OUT_OF_RANGE, name});
    };
    for (const std::uint32_t many : {529U, UINT32_MAX}) {
        word("options.layer_pair_count", &O::layer_pair_count, many);
    }
    word("options.max_objects", &O::max_objects, (1U << 29) + 1);
    word("options.lanes", &O::lanes, 0);
    word("options.lanes", &O::lanes, 257);
    static const cdprep_allocator none = {nullptr, nullptr, nullptr};
    for (const std::uint32_t many : {33U, UINT32_MAX}) {
        word("options.layer_name_count", &O::layer_name_count, many);
    }
    static const std::array<const char*, 2> names = {"floor", nullptr};
    all.push_back(
        {"no names", [](O& o) { o.layer_name_count = 1; }, CDPREP_WHY_NULL, "options.layer_names"});
    all.push_back({"a name that is null",
                   [](O& o) {
                       o.layer_names = names.data();
                       o.layer_name_count = 2;
                   },
                   CDPREP_WHY_NULL, "options.layer_names[1]"});
    all.push_back({"an origin too far", [](O& o) { o.origin[2] = -0x1.0000000000001p1000; },
                   CDPREP_WHY_OUT_OF_RANGE, "options.origin[2]"});
    for (const double number : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        all.push_back({"an origin", [=](O& o) { o.origin[1] = number; }, CDPREP_WHY_NOT_FINITE,
                       "options.origin[1]"});
    }
    all.push_back({"no pairs", [](O& o) { o.layer_pairs = nullptr; }, CDPREP_WHY_NULL,
                   "options.layer_pairs"});
    all.push_back(
        {"no models", [](O& o) { o.model_count = 1; }, CDPREP_WHY_NULL, "options.models"});
    all.push_back(
        {"no functions", [](O& o) { o.allocator = &none; }, CDPREP_WHY_NULL, "options.allocator"});
    expect_refused(options(), all, [](const O* given) { return outcome_of(given); });
}

// By hand: three layer pairs and two models are invalid, each in one way.
TEST_F(CSceneHostile, APlanTellsEveryReason) {
    std::vector<cdprep_layer_pair> pairs = {
        pair_of(0, 1, CDPREP_ASK_COLLIDE), pair_of(40, 1, CDPREP_ASK_COLLIDE),
        pair_of(1, 0, CDPREP_ASK_WITHIN), pair_of(2, 2, CDPREP_ASK_RAY)};
    std::vector<cdprep_model_use> models = {use_of(rays_only_.get(), 1), use_of(cube_.get(), 3),
                                            use_of(nullptr, 2)};
    models[2].name = "bolt.cdp.h5";
    cdprep_plan_options changed = options();
    changed.layer_pairs = pairs.data();
    changed.layer_pair_count = 4;
    changed.models = models.data();
    changed.model_count = 3;
    cdprep_plan* plan = nullptr;
    cdprep_error error;
    Told told;
    EXPECT_EQ(cdprep_plan_compile(&changed, Told::take, &told, &plan, &error), CDPREP_BAD_ARGUMENT);
    ASSERT_EQ(told.sentences.size(), 5u);
    EXPECT_EQ(told.sentences[0], error.message);
    EXPECT_STREQ(error.argument, "options.layer_pairs[1].a");
    EXPECT_EQ(told.sentences[0], "options.layer_pairs[1].a is 40; the greatest value is 31.");
    EXPECT_EQ(told.sentences[1],
              "options.layer_pairs[2] has the layers 1 and 0, like options.layer_pairs[0].");
    EXPECT_EQ(told.sentences[2],
              "options.layer_pairs[3].effects is 0x1000; a scene computes only the bits 0x7df.");
    EXPECT_EQ(told.sentences[4],
              "options.models[2].serves is 0x0, but its layers request collide. Bake bolt.cdp.h5 "
              "with --effects collide.");
    Told two;
    two.most = 2;
    EXPECT_EQ(cdprep_plan_compile(&changed, Told::take, &two, &plan, nullptr), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(two.sentences.size(), 2u);
    EXPECT_EQ(cdprep_plan_compile(&changed, nullptr, nullptr, &plan, nullptr), CDPREP_BAD_ARGUMENT);
}

// An error of parts counts as one in every mode, however small it is.
TEST_F(CSceneHostile, NoFloatModeHidesAnError) {
    cdprep_model_use use = use_of(nullptr, 1);
    use.serves = CDPREP_ASK_COLLIDE | CDPREP_ASK_DISTANCE | CDPREP_ASK_WITHIN;
    use.part_error = 0x1p-1060;
    cdprep_plan_options changed = options();
    changed.models = &use;
    changed.model_count = 1;
    for (const FloatMode& mode : float_modes()) {
        cdprep_plan* plan = nullptr;
        cdprep_error error;
        int code = CDPREP_OK;
        (void)run_in(
            mode, [&] { code = cdprep_plan_compile(&changed, nullptr, nullptr, &plan, &error); });
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT) << mode.name;
        EXPECT_STREQ(error.argument, "options.models[0].part_error") << mode.name;
        cdprep_plan_end(plan);
    }
}

// By hand: models that are not open yet, with 2 and 3 parts whose errors add up to 0.75.
TEST_F(CSceneHostile, PartsOfModelsDecideTheRung) {
    cdprep_layer_pair pair = pair_of(0, 1, CDPREP_ASK_DISTANCE);
    pair.body = CDPREP_SOLID;
    pair.max_distance = 2;
    std::array<cdprep_model_use, 2> models = {use_of(nullptr, 1), use_of(nullptr, 2)};
    for (cdprep_model_use& use : models) {
        use.serves = CDPREP_ASK_DISTANCE | CDPREP_ASK_SOLID | CDPREP_ASK_HULLS;
        use.part_count = use.layers + 1;
        use.part_error = use.layers * 0.25;
    }
    cdprep_plan_options changed = options();
    changed.layer_pairs = &pair;
    changed.models = models.data();
    changed.model_count = 2;
    const auto told = [&](double max_error) {
        pair.max_error = max_error;
        cdprep_plan* const plan = compiled(changed);
        std::array<char, 2000> text{};
        std::size_t length = 0;
        EXPECT_EQ(cdprep_plan_text(plan, text.data(), text.size(), &length, nullptr), CDPREP_OK);
        std::uint32_t ask = 0;
        EXPECT_EQ(cdprep_plan_ask(plan, 1, &ask, nullptr), CDPREP_OK);
        cdprep_plan_end(plan);
        const std::string line = text.data();
        return line.substr(0, line.find('\n')) + ((ask & CDPREP_ASK_HULLS) != 0 ? " hulls" : "");
    };
    EXPECT_EQ(told(0.75),
              "layers 0 and 1: distance of solids up to 2; max_error 0.75: by enclosing parts, at "
              "most 2 and 3, error at most 0.75 hulls");
    EXPECT_EQ(
        told(0.5),
        "layers 0 and 1: distance of solids up to 2; max_error 0.5: by BVH traversal, error at "
        "most 0.5");
    // A model that will not serve hulls has no parts to ask.
    models[1].serves &= ~std::uint32_t{CDPREP_ASK_HULLS};
    EXPECT_EQ(
        told(0.75),
        "layers 0 and 1: distance of solids up to 2; max_error 0.75: by BVH traversal, error at "
        "most 0.75");
}

// By hand: the third layer has an empty name, and the fourth is in no pair.
TEST_F(CSceneHostile, MessagesAndTextsNameTheLayers) {
    const std::vector<cdprep_layer_pair> pairs = {pair_of(0, 2, CDPREP_ASK_COLLIDE),
                                                  pair_of(1, 0, CDPREP_ASK_COLLIDE),
                                                  pair_of(0, 1, CDPREP_ASK_COLLIDE)};
    const std::array<const char*, 4> names = {"floor", "crates", "", "debris"};
    cdprep_plan_options changed = options();
    changed.layer_pairs = pairs.data();
    changed.layer_pair_count = 3;
    changed.layer_names = names.data();
    changed.layer_name_count = 4;
    cdprep_plan* plan = nullptr;
    cdprep_error error;
    EXPECT_EQ(cdprep_plan_compile(&changed, nullptr, nullptr, &plan, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(
        error.message,
        "options.layer_pairs[2] has the layers 'floor' and 'crates', like options.layer_pairs[1].");
    changed.layer_pair_count = 2;
    plan = compiled(changed);
    std::array<char, 2000> text{};
    std::size_t length = 0, size = 0;
    EXPECT_EQ(cdprep_plan_text(plan, text.data(), text.size(), &length, nullptr), CDPREP_OK);
    const std::string told = text.data();
    EXPECT_EQ(told.size(), length);
    EXPECT_EQ(told.substr(0, told.find("models of layers ")),
              "layers 'floor' and 2: collide\n"
              "layers 'crates' and 'floor': collide\n"
              "not requested by any pair of layers: overlap, within, distance, contacts, "
              "continuous, self, haptic\n"
              "layers never tested against each other: 'floor' and 'floor', 'crates' and "
              "'crates', 'crates' and 2, 2 and 2\n"
              "layers in no pair, whose objects are never tested: 'debris'\n");
    EXPECT_NE(told.find("models of layers 'floor', 'crates' and 2 must serve collide; "),
              std::string::npos);
    EXPECT_EQ(cdprep_scene_size(plan, &size, nullptr), CDPREP_OK);
    EXPECT_NE(told.find("\nthe state of a scene: "), std::string::npos);
    const std::string end = "with the results of the C API: " + std::to_string(size) +
                            " bytes, as cdprep_scene_size() returns\n";
    EXPECT_EQ(told.substr(told.size() - std::min(told.size(), end.size())), end);
    cdprep_plan_end(plan);
}

// An element of another size, or one that is not initialised, is named; the others are checked.
TEST_F(CSceneHostile, LayerPairsOfAnotherSizeAreRefused) {
    std::array<cdprep_layer_pair, 3> pairs = {pair_of(0, 1, kAll), pair_of(0, 2, kAll),
                                              pair_of(0, 3, kAll)};
    cdprep_plan_options changed = options();
    changed.layer_pairs = pairs.data();
    changed.layer_pair_count = 3;
    EXPECT_EQ(outcome_of(&changed).code, CDPREP_OK);
    pairs[1].head.size += 8;
    EXPECT_EQ(outcome_of(&changed).argument, "options.layer_pairs[1]");
    pairs[1] = pairs[0];
    EXPECT_EQ(outcome_of(&changed).why, CDPREP_WHY_NO_MEANING);
    pairs[0].head.size = 0;
    EXPECT_EQ(outcome_of(&changed).argument, "options.layer_pairs[0]");
}

TEST_F(CSceneHostile, PlansAreReadWithCare) {
    cdprep_error error;
    std::size_t length = 9;
    std::uint32_t ask = 9;
    char text[4] = "abc";
    EXPECT_EQ(cdprep_plan_text(nullptr, text, 4, &length, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(length, 0u);
    EXPECT_EQ(cdprep_plan_text(plan_, nullptr, 4, &length, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "text");
    EXPECT_EQ(cdprep_plan_text(plan_, text, 4, nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "length");
    EXPECT_EQ(cdprep_plan_text(plan_, text, 1, &length, &error), CDPREP_OK);
    EXPECT_EQ(text[0], 0);
    EXPECT_EQ(text[1], 'b');
    for (const std::uint32_t layer : {32U, 77U, UINT32_MAX}) {
        EXPECT_EQ(cdprep_plan_ask(plan_, layer, &ask, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_STREQ(error.argument, "layer");
        EXPECT_EQ(ask, 0u);
    }
    cdprep_layer_info info = {9, {9, 9}, 9, 9};
    for (const std::uint32_t layer : {32U, 77U, UINT32_MAX}) {
        info.ask = 9;
        EXPECT_EQ(cdprep_plan_layer(plan_, layer, &info, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_STREQ(error.argument, "layer");
        EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
        EXPECT_EQ(info.ask, 0u);
    }
    EXPECT_EQ(cdprep_plan_layer(nullptr, 0, &info, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "plan");
    EXPECT_EQ(cdprep_plan_layer(plan_, 0, nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "info");
    cdprep_object id = {7, 7};
    EXPECT_EQ(cdprep_scene_object_at(scene_, 4, &id, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "slot is 4; the scene has 4 slots, numbered from 0.");
    EXPECT_EQ(id.generation, 0u);
    EXPECT_EQ(cdprep_plan_ask(nullptr, 0, &ask, nullptr), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(cdprep_plan_ask(plan_, 0, nullptr, nullptr), CDPREP_BAD_ARGUMENT);
    const cdprep_plan_options right = options();
    EXPECT_EQ(cdprep_plan_compile(&right, nullptr, nullptr, nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "plan");
    cdprep_plan_end(nullptr);
    cdprep_layer_pair_init(nullptr, sizeof(cdprep_layer_pair));
    cdprep_model_use_init(nullptr, sizeof(cdprep_model_use));
    cdprep_plan_options_init(nullptr, sizeof(cdprep_plan_options));
}

// Objects -----------------------------------------------------------------------------------------

TEST_F(CSceneHostile, ObjectsAreCheckedFieldByField) {
    using O = cdprep_object_options;
    std::vector<Mistake<O>> all = struct_mistakes<O>("objects[0]");
    const char* const kPose = "objects[0].world_from_model";
    all.push_back({"model", [](O& o) { o.model = nullptr; }, CDPREP_WHY_NULL, "objects[0].model"});
    for (const std::uint32_t layer : {32U, 77U, UINT32_MAX}) {
        all.push_back(
            {"layer", [=](O& o) { o.layer = layer; }, CDPREP_WHY_OUT_OF_RANGE, "objects[0].layer"});
    }
    all.push_back(
        {"reserved", [](O& o) { o.reserved = 1; }, CDPREP_WHY_NEWER_FIELD, "objects[0].reserved"});
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        all.push_back({"a number", [bad](O& o) { o.world_from_model.rows[11] = bad; }, why,
                       "objects[0].world_from_model[11]"});
    }
    const auto not_rigid = [&](auto make) {
        all.push_back({"not rigid", make, CDPREP_WHY_NOT_RIGID, kPose});
    };
    not_rigid([](O& o) { o.world_from_model = {}; });
    not_rigid([](O& o) { o.world_from_model.rows[0] = 1 + 1e-11; });
    not_rigid([](O& o) { o.world_from_model.rows[4] = -1; });
    all.push_back({"not baked", [&](O& o) { o.model = rays_only_.get(); }, CDPREP_WHY_NOT_BAKED,
                   "objects[0].model"});
    all.push_back({"not opened", [&](O& o) { o.model = opened_for_rays_.get(); },
                   CDPREP_WHY_NOT_OPENED, "objects[0].model"});
    expect_refused(object(), all, [&](const O* given) {
        cdprep_object id = {7, 7};
        cdprep_error error;
        const int code = cdprep_scene_add(scene_, given, 1, &id, &error);
        const Outcome result = outcome(code, error, id.slot == 0 && id.generation == 0);
        if (code == CDPREP_OK) {
            EXPECT_EQ(cdprep_scene_remove(scene_, &id, 1, nullptr), CDPREP_OK);
        }
        EXPECT_EQ(object_count(), 0u);
        return result;
    });
}

TEST_F(CSceneHostile, AnInvalidObjectKeepsAllFromBeingAdded) {
    std::array<cdprep_object_options, 3> objects = {object(), object(2), object(4)};
    std::array<cdprep_object, 3> ids{};
    cdprep_error error;
    objects[2].world_from_model.rows[9] = kNan;
    ids.fill({7, 7});
    EXPECT_EQ(cdprep_scene_add(scene_, objects.data(), 3, ids.data(), &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "objects[2].world_from_model[9]");
    EXPECT_EQ(object_count(), 0u);
    EXPECT_EQ(ids[0].generation, 0u);
    objects[2] = object(4);
    objects[1].head.size += 8;
    EXPECT_EQ(cdprep_scene_add(scene_, objects.data(), 3, ids.data(), &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "objects[1]");
    objects[1] = object(2);
    EXPECT_EQ(cdprep_scene_add(scene_, objects.data(), 3, ids.data(), &error), CDPREP_OK);
    EXPECT_EQ(cdprep_scene_add(scene_, objects.data(), 2, ids.data(), &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "count is 2; the scene has room for 1 more of its 4 objects.");
    EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(object_count(), 3u);
    EXPECT_EQ(cdprep_scene_add(scene_, objects.data(), SIZE_MAX, ids.data(), &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "count");
}

// Ids of a slot that was never used, beyond the last, removed, used again, and none.
TEST_F(CSceneHostile, StaleObjectsAreRefused) {
    const cdprep_object first = added(), second = added(5);
    EXPECT_EQ(cdprep_scene_remove(scene_, &first, 1, nullptr), CDPREP_OK);
    const cdprep_object again = added();
    ASSERT_EQ(again.slot, first.slot);
    ASSERT_NE(again.generation, first.generation);
    step();
    cdprep_pose pose{};
    pose.rows[0] = pose.rows[4] = pose.rows[8] = 1;
    for (const cdprep_object& id :
         {first, cdprep_object{3, 1}, cdprep_object{4, 1}, cdprep_object{UINT32_MAX, UINT32_MAX},
          cdprep_object{}, cdprep_object{second.slot, second.generation + 1}}) {
        const std::array<cdprep_object, 2> ids = {second, id};
        const std::array<cdprep_pose, 2> poses = {pose, pose};
        cdprep_error error;
        EXPECT_EQ(cdprep_scene_remove(scene_, ids.data(), 2, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_STALE);
        EXPECT_STREQ(error.argument, "ids[1]");
        EXPECT_EQ(cdprep_scene_set_poses(scene_, ids.data(), poses.data(), 2, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_STALE);
        EXPECT_STREQ(error.argument, "ids[1]");
        EXPECT_EQ(cdprep_scene_set_layer(scene_, id, 2, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_STALE);
        EXPECT_STREQ(error.argument, "id");
        cdprep_object_info info = {cube_.get(), 7, 7, {}};
        EXPECT_EQ(cdprep_scene_describe(scene_, id, &info, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_STALE);
        EXPECT_STREQ(error.argument, "id");
        EXPECT_EQ(info.model, nullptr);
        EXPECT_EQ(step(), 0u) << "nothing has changed";
        EXPECT_EQ(object_count(), 2u);
    }
    const std::array<cdprep_object, 3> thrice = {second, second, again};
    EXPECT_EQ(cdprep_scene_remove(scene_, thrice.data(), 3, nullptr), CDPREP_OK);
    EXPECT_EQ(object_count(), 0u);
}

TEST_F(CSceneHostile, PosesAreCheckedBeforeAnyIsSet) {
    const std::array<cdprep_object, 2> ids = {added(), added(5)};
    step();
    const cdprep_pose right = object().world_from_model;
    const auto expect = [&](const cdprep_pose& wrong, int why, const char* argument) {
        const std::array<cdprep_pose, 2> poses = {right, wrong};
        cdprep_error error;
        EXPECT_EQ(cdprep_scene_set_poses(scene_, ids.data(), poses.data(), 2, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why);
        EXPECT_STREQ(error.argument, argument);
        EXPECT_EQ(step(), 0u);
    };
    for (const auto& [number, why] : bad_numbers()) {
        cdprep_pose wrong = right;
        wrong.rows[10] = number;
        expect(wrong, why, "poses[1].rows[10]");
    }
    expect({}, CDPREP_WHY_NOT_RIGID, "poses[1]");
    cdprep_error error;
    EXPECT_EQ(cdprep_scene_set_poses(scene_, ids.data(), nullptr, 2, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "poses");
    EXPECT_EQ(cdprep_scene_set_poses(scene_, nullptr, &right, 2, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "ids");
    EXPECT_EQ(cdprep_scene_set_poses(scene_, ids.data(), &right, SIZE_MAX, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "count");
    EXPECT_EQ(cdprep_scene_remove(scene_, ids.data(), SIZE_MAX / 2, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(cdprep_scene_set_poses(scene_, nullptr, nullptr, 0, &error), CDPREP_OK);
    EXPECT_EQ(cdprep_scene_remove(scene_, nullptr, 0, &error), CDPREP_OK);
}

TEST_F(CSceneHostile, ALayerNeedsAModelThatServesIt) {
    cdprep_object_options rays = object();
    rays.model = rays_only_.get();
    rays.layer = 2;
    cdprep_object id{};
    cdprep_error error;
    ASSERT_EQ(cdprep_scene_add(scene_, &rays, 1, &id, nullptr), CDPREP_OK);
    EXPECT_EQ(cdprep_scene_set_layer(scene_, id, 1, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_NOT_BAKED);
    EXPECT_STREQ(error.argument, "id");
    for (const std::uint32_t layer : {32U, 77U, UINT32_MAX}) {
        EXPECT_EQ(cdprep_scene_set_layer(scene_, id, layer, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
        EXPECT_STREQ(error.argument, "layer");
    }
    EXPECT_EQ(cdprep_scene_set_layer(scene_, id, 31, &error), CDPREP_OK);
}

// Scenes ------------------------------------------------------------------------------------------

TEST_F(CSceneHostile, NullIsRefusedByName) {
    cdprep_error error;
    cdprep_step step = {7, 7, 7, 7, {}};
    std::size_t size = 9, count = 9;
    std::uint64_t hash = 9;
    cdprep_counts counts{};
    const cdprep_scene_hit* hits = nullptr;
    const cdprep_scene_overlap* overlaps = nullptr;
    const cdprep_scene_distance* distances = nullptr;
    const cdprep_scene_contact* contacts = nullptr;
    const cdprep_event* events = nullptr;
    const cdprep_world_box* boxes = nullptr;
    const cdprep_box_pair candidate = {0, 1};
    const auto expect = [&](int code, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT) << argument;
        EXPECT_EQ(error.why, CDPREP_WHY_NULL) << argument;
        EXPECT_STREQ(error.argument, argument);
    };
    const cdprep_object_options right = object();
    cdprep_object id{};
    cdprep_scene* made = scene_;
    expect(cdprep_scene_size(nullptr, &size, &error), "plan");
    EXPECT_EQ(size, 0u);
    expect(cdprep_scene_size(plan_, nullptr, &error), "size");
    expect(cdprep_scene_make(nullptr, nullptr, 0, &made, &error), "plan");
    EXPECT_EQ(made, nullptr);
    expect(cdprep_scene_make(plan_, nullptr, 0, nullptr, &error), "scene");
    expect(cdprep_scene_add(nullptr, &right, 1, &id, &error), "scene");
    expect(cdprep_scene_add(scene_, nullptr, 1, &id, &error), "objects");
    expect(cdprep_scene_add(scene_, &right, 1, nullptr, &error), "ids");
    expect(cdprep_scene_remove(nullptr, &id, 1, &error), "scene");
    expect(cdprep_scene_remove(scene_, nullptr, 1, &error), "ids");
    expect(cdprep_scene_set_layer(nullptr, id, 1, &error), "scene");
    expect(cdprep_scene_set_poses(nullptr, &id, &right.world_from_model, 1, &error), "scene");
    expect(cdprep_scene_put(nullptr, &id, &right.world_from_model, 1, &error), "scene");
    expect(cdprep_scene_put(scene_, nullptr, &right.world_from_model, 1, &error), "ids");
    const cdprep_scene_self_overlap* own = nullptr;
    const cdprep_scene_impact* impacts = nullptr;
    const cdprep_scene_bounded* bounded = nullptr;
    expect(cdprep_scene_self_overlaps(nullptr, &own, &count, &error), "scene");
    expect(cdprep_scene_self_overlaps(scene_, nullptr, &count, &error), "overlaps");
    expect(cdprep_scene_impacts(nullptr, &impacts, &count, &error), "scene");
    expect(cdprep_scene_impacts(scene_, nullptr, &count, &error), "impacts");
    expect(cdprep_scene_bounded_distances(nullptr, &bounded, &count, &error), "scene");
    expect(cdprep_scene_bounded_distances(scene_, nullptr, &count, &error), "distances");
    expect(cdprep_scene_step(nullptr, workspace_.get(), &step, &error), "scene");
    EXPECT_EQ(step.complete, std::uint32_t{CDPREP_NO});
    EXPECT_EQ(step.needed_pairs, 0u);
    expect(cdprep_scene_step(scene_, nullptr, &step, &error), "workspace");
    expect(cdprep_scene_step(scene_, workspace_.get(), nullptr, &error), "step");
    cdprep_workspace* const workspace = workspace_.get();
    expect(cdprep_scene_step_with(nullptr, nullptr, 0, workspace, &step, &error), "scene");
    expect(cdprep_scene_step_with(scene_, nullptr, 1, workspace, &step, &error), "candidates");
    expect(cdprep_scene_step_with(scene_, &candidate, 1, nullptr, &step, &error), "workspace");
    expect(cdprep_scene_step_with(scene_, &candidate, 1, workspace, nullptr, &error), "step");
    expect(cdprep_scene_boxes(nullptr, &boxes, &count, &error), "scene");
    expect(cdprep_scene_boxes(scene_, nullptr, &count, &error), "boxes");
    expect(cdprep_scene_boxes(scene_, &boxes, nullptr, &error), "count");
    expect(cdprep_scene_overlaps(nullptr, &overlaps, &count, &error), "scene");
    expect(cdprep_scene_overlaps(scene_, nullptr, &count, &error), "overlaps");
    expect(cdprep_scene_contacts(nullptr, &contacts, &count, &error), "scene");
    expect(cdprep_scene_contacts(scene_, nullptr, &count, &error), "contacts");
    expect(cdprep_scene_contacts(scene_, &contacts, nullptr, &error), "count");
    expect(cdprep_scene_hits(nullptr, &hits, &count, &error), "scene");
    EXPECT_EQ(count, 0u);
    expect(cdprep_scene_hits(scene_, nullptr, &count, &error), "hits");
    expect(cdprep_scene_hits(scene_, &hits, nullptr, &error), "count");
    expect(cdprep_scene_distances(scene_, nullptr, &count, &error), "distances");
    expect(cdprep_scene_distances(nullptr, &distances, &count, &error), "scene");
    expect(cdprep_scene_events(scene_, nullptr, &count, &error), "events");
    expect(cdprep_scene_events(nullptr, &events, &count, &error), "scene");
    expect(cdprep_scene_hash(nullptr, &hash, &error), "scene");
    EXPECT_EQ(hash, 0u);
    expect(cdprep_scene_hash(scene_, nullptr, &error), "hash");
    expect(cdprep_scene_counts(nullptr, &counts, &error), "scene");
    expect(cdprep_scene_counts(scene_, nullptr, &error), "counts");
    cdprep_object_info info = {cube_.get(), 7, 7, {}};
    expect(cdprep_scene_describe(nullptr, id, &info, &error), "scene");
    EXPECT_EQ(info.model, nullptr);
    expect(cdprep_scene_describe(scene_, id, nullptr, &error), "info");
    id = {7, 7};
    expect(cdprep_scene_object_at(nullptr, 0, &id, &error), "scene");
    EXPECT_EQ(id.generation, 0u);
    expect(cdprep_scene_object_at(scene_, 0, nullptr, &error), "id");
    expect(cdprep_scene_set_clock(nullptr, nullptr, &error), "scene");
    EXPECT_EQ(cdprep_scene_step(nullptr, nullptr, nullptr, nullptr), CDPREP_BAD_ARGUMENT);
    cdprep_scene_end(nullptr);
    cdprep_object_options_init(nullptr, sizeof right);
}

/// What a step says about candidates that are wrong.
struct WrongCandidates {
    std::vector<cdprep_box_pair> pairs;
    int why;
    const char* message;
};

// Slots 0, 1 and 3 have objects. What is refused changes nothing: the next step sees all objects.
TEST_F(CSceneHostile, CandidatesAreChecked) {
    const std::array<cdprep_object, 4> ids = {added(), added(0.5), added(1), added(1.5)};
    ASSERT_EQ(cdprep_scene_remove(scene_, &ids[2], 1, nullptr), CDPREP_OK);
    const std::vector<WrongCandidates> all = {
        {{{0, 4}},
         CDPREP_WHY_OUT_OF_RANGE,
         "candidates[0] has slots 0 and 4; the first must be less than the second, and both less "
         "than 4."},
        {{{0, 1}, {1, UINT32_MAX}}, CDPREP_WHY_OUT_OF_RANGE, nullptr},
        {{{1, 1}}, CDPREP_WHY_OUT_OF_RANGE, nullptr},
        {{{0, 1}, {3, 1}}, CDPREP_WHY_OUT_OF_RANGE, nullptr},
        {{{0, 1}, {0, 1}},
         CDPREP_WHY_OUT_OF_RANGE,
         "candidates[1] has slots 0 and 1 after 0 and 1; candidates must be sorted and "
         "unique."},
        {{{0, 3}, {0, 1}}, CDPREP_WHY_OUT_OF_RANGE, nullptr},
        {{{1, 3}, {0, 3}}, CDPREP_WHY_OUT_OF_RANGE, nullptr},
        {{{0, 1}, {1, 2}}, CDPREP_WHY_STALE, "candidates[1] names slot 2, which has no object."},
        {{{2, 3}}, CDPREP_WHY_STALE, "candidates[0] names slot 2, which has no object."}};
    cdprep_step step;
    cdprep_error error;
    for (const WrongCandidates& wrong : all) {
        step.complete = CDPREP_YES;
        EXPECT_EQ(cdprep_scene_step_with(scene_, wrong.pairs.data(), wrong.pairs.size(),
                                         workspace_.get(), &step, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, wrong.why) << error.message;
        const char* const message = wrong.message != nullptr ? wrong.message : error.message;
        EXPECT_STREQ(error.message, message);
        EXPECT_EQ(step.complete, std::uint32_t{CDPREP_NO});
        std::size_t events = 9;
        const cdprep_event* first = nullptr;
        ASSERT_EQ(cdprep_scene_events(scene_, &first, &events, nullptr), CDPREP_OK);
        EXPECT_EQ(events, 0u);
    }
    const cdprep_box_pair one = {0, 1};
    EXPECT_EQ(cdprep_scene_step_with(scene_, &one, SIZE_MAX / 4, workspace_.get(), &step, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "count");
    // A pair that is missing is not asked, and one that is too far apart is ignored.
    const std::vector<cdprep_box_pair> some = {{0, 1}, {0, 3}};
    ASSERT_EQ(cdprep_scene_step_with(scene_, some.data(), 2, workspace_.get(), &step, &error),
              CDPREP_OK);
    EXPECT_EQ(step.complete, std::uint32_t{CDPREP_YES});
    std::size_t hits = 0;
    const cdprep_scene_hit* first = nullptr;
    ASSERT_EQ(cdprep_scene_hits(scene_, &first, &hits, nullptr), CDPREP_OK);
    EXPECT_EQ(hits, 1u);
    ASSERT_EQ(cdprep_scene_step_with(scene_, nullptr, 0, workspace_.get(), &step, &error),
              CDPREP_OK);
    ASSERT_EQ(cdprep_scene_hits(scene_, &first, &hits, nullptr), CDPREP_OK);
    EXPECT_EQ(hits, 0u);
    EXPECT_EQ(this->step(), 0u);
    ASSERT_EQ(cdprep_scene_hits(scene_, &first, &hits, nullptr), CDPREP_OK);
    EXPECT_EQ(hits, 2u) << "the scene's own broad phase finds what was missing";
}

TEST_F(CSceneHostile, MemoryMustBeLargeEnoughAndAligned) {
    std::size_t size = 0;
    ASSERT_EQ(cdprep_scene_size(plan_, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size + 64);
    std::byte* const start = memory.span().data();
    const auto made = [&](void* at, std::size_t room) {
        auto* scene = reinterpret_cast<cdprep_scene*>(start);
        cdprep_error error;
        const int code = cdprep_scene_make(plan_, at, room, &scene, &error);
        EXPECT_EQ(code == CDPREP_OK, scene != nullptr);
        cdprep_scene_end(scene);
        return std::pair(std::string(error.argument), error.why);
    };
    EXPECT_EQ(made(start, size - 1), std::pair(std::string("size"), int{CDPREP_WHY_TOO_SMALL}));
    EXPECT_EQ(made(start, 0), std::pair(std::string("size"), int{CDPREP_WHY_TOO_SMALL}));
    EXPECT_EQ(made(start + 8, size),
              std::pair(std::string("memory"), int{CDPREP_WHY_OUT_OF_RANGE}));
    EXPECT_EQ(made(nullptr, size), std::pair(std::string("memory"), int{CDPREP_WHY_NULL}));
    EXPECT_EQ(made(start, size), std::pair(std::string(), 0));
}

// The block of a plan is needed until its last scene ends.
TEST_F(CSceneHostile, ScenesKeepTheirPlan) {
    Blocks blocks;
    cdprep_plan_options changed = options();
    changed.allocator = &blocks.allocator;
    cdprep_plan* plan = compiled(changed);
    EXPECT_EQ(blocks.given, 1u);
    std::size_t size = 0;
    ASSERT_EQ(cdprep_scene_size(plan, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size);
    std::array<cdprep_scene*, 2> scenes{};
    ASSERT_EQ(cdprep_scene_make(plan, nullptr, 0, &scenes[0], nullptr), CDPREP_OK);
    EXPECT_EQ(blocks.given, 2u);
    ASSERT_EQ(cdprep_scene_make(plan, memory.span().data(), size, &scenes[1], nullptr), CDPREP_OK);
    EXPECT_EQ(blocks.given, 2u) << "the memory is the caller's";
    blocks.is_empty = true;
    cdprep_scene* none = scenes[0];
    EXPECT_EQ(cdprep_scene_make(plan, nullptr, 0, &none, nullptr), CDPREP_OVER_BUDGET);
    EXPECT_EQ(none, nullptr);
    cdprep_plan_end(plan);
    EXPECT_EQ(blocks.taken, 0u);
    for (cdprep_scene* const scene : scenes) {
        const cdprep_object_options right = object();
        cdprep_object id;
        cdprep_step step;
        EXPECT_EQ(cdprep_scene_add(scene, &right, 1, &id, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_scene_step(scene, workspace_.get(), &step, nullptr), CDPREP_OK);
        cdprep_scene_end(scene);
    }
    EXPECT_EQ(blocks.taken, 2u);
    EXPECT_EQ(outcome_of(&changed).code, CDPREP_OVER_BUDGET);
}

/// What a step's callback may not do: it runs within the step.
struct Within {
    cdprep_scene* scene;
    cdprep_workspace* workspace;
    std::vector<int> why;

    static void run(void* within, std::size_t count, cdprep_task task, const void* work) {
        static_cast<Within*>(within)->ask();
        for (std::size_t i = 0; i < count; ++i) task(work, i);
    }
    void ask() {
        cdprep_error error;
        const auto note = [&](int /*code*/) { why.push_back(error.why); };
        cdprep_step step;
        std::size_t count = 0;
        std::uint64_t hash = 0;
        cdprep_counts counts;
        const cdprep_scene_hit* hits = nullptr;
        const cdprep_scene_overlap* overlaps = nullptr;
        const cdprep_scene_distance* distances = nullptr;
        const cdprep_scene_contact* contacts = nullptr;
        const cdprep_event* events = nullptr;
        const cdprep_world_box* boxes = nullptr;
        note(cdprep_scene_step_with(scene, nullptr, 0, workspace, &step, &error));
        note(cdprep_scene_boxes(scene, &boxes, &count, &error));
        note(cdprep_scene_overlaps(scene, &overlaps, &count, &error));
        note(cdprep_scene_contacts(scene, &contacts, &count, &error));
        note(cdprep_scene_step(scene, workspace, &step, &error));
        note(cdprep_scene_add(scene, nullptr, 0, nullptr, &error));
        note(cdprep_scene_remove(scene, nullptr, 0, &error));
        note(cdprep_scene_set_layer(scene, {}, 0, &error));
        note(cdprep_scene_set_poses(scene, nullptr, nullptr, 0, &error));
        note(cdprep_scene_put(scene, nullptr, nullptr, 0, &error));
        const cdprep_scene_self_overlap* own = nullptr;
        const cdprep_scene_impact* impacts = nullptr;
        const cdprep_scene_bounded* bounded = nullptr;
        note(cdprep_scene_self_overlaps(scene, &own, &count, &error));
        note(cdprep_scene_impacts(scene, &impacts, &count, &error));
        note(cdprep_scene_bounded_distances(scene, &bounded, &count, &error));
        note(cdprep_scene_hits(scene, &hits, &count, &error));
        note(cdprep_scene_distances(scene, &distances, &count, &error));
        note(cdprep_scene_events(scene, &events, &count, &error));
        note(cdprep_scene_hash(scene, &hash, &error));
        note(cdprep_scene_counts(scene, &counts, &error));
        cdprep_object id{};
        cdprep_object_info info{};
        cdprep_draw draw;
        cdprep_draw_init(&draw, sizeof draw);
        note(cdprep_scene_object_at(scene, 0, &id, &error));
        note(cdprep_scene_describe(scene, id, &info, &error));
        note(cdprep_scene_set_clock(scene, nullptr, &error));
        note(cdprep_scene_draw(scene, &draw, &error));
        cdprep_scene_end(scene);  // in use: does nothing
    }
};

TEST_F(CSceneHostile, ASceneInUseIsRefused) {
    cdprep_plan_options changed = options();
    changed.lanes = 2;
    cdprep_plan* plan = compiled(changed);
    cdprep_scene* scene = nullptr;
    ASSERT_EQ(cdprep_scene_make(plan, nullptr, 0, &scene, nullptr), CDPREP_OK);
    cdprep_plan_end(plan);
    Within within = {scene, workspace_.get(), {}};
    cdprep_workspace_options lanes;
    cdprep_workspace_options_init(&lanes, sizeof lanes);
    lanes.lanes = 2;
    lanes.run = Within::run;
    lanes.context = &within;
    cdprep_workspace* workspace = nullptr;
    ASSERT_EQ(cdprep_workspace_make(&lanes, nullptr, 0, &workspace, nullptr), CDPREP_OK);
    const std::array<cdprep_object_options, 4> objects = {object(), object(0.5), object(1),
                                                          object(1.5)};
    std::array<cdprep_object, 4> ids{};
    ASSERT_EQ(cdprep_scene_add(scene, objects.data(), 4, ids.data(), nullptr), CDPREP_OK);
    cdprep_step step;
    ASSERT_EQ(cdprep_scene_step(scene, workspace, &step, nullptr), CDPREP_OK);
    ASSERT_GE(within.why.size(), 14u);
    for (const int why : within.why) EXPECT_EQ(why, CDPREP_WHY_BUSY);
    std::size_t count = 0;
    const cdprep_scene_hit* hits = nullptr;
    EXPECT_EQ(cdprep_scene_hits(scene, &hits, &count, nullptr), CDPREP_OK);
    EXPECT_EQ(count, 5u);  // neighbours, and next neighbours, which touch
    cdprep_scene_end(scene);
    cdprep_workspace_end(workspace);
}

/// A visitor that steps a scene with the workspace of its own query.
struct Stepping {
    cdprep_scene* scene;
    cdprep_workspace* workspace;
    std::string argument;

    static int step(void* stepping, const cdprep_overlap* /*overlap*/) {
        auto* const self = static_cast<Stepping*>(stepping);
        cdprep_error error;
        cdprep_step step = {7, 7, 7, CDPREP_YES, {}};
        EXPECT_EQ(cdprep_scene_step(self->scene, self->workspace, &step, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_BUSY);
        EXPECT_EQ(step.complete, std::uint32_t{CDPREP_NO});
        self->argument = error.argument;
        return 0;
    }
};

TEST_F(CSceneHostile, AWorkspaceInUseIsRefused) {
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = pair.b = cube_.get();
    Stepping stepping = {scene_, workspace_.get(), {}};
    ASSERT_EQ(cdprep_overlaps_visit(&pair, workspace_.get(), Stepping::step, &stepping, nullptr),
              CDPREP_OK);
    EXPECT_EQ(stepping.argument, "workspace");
    EXPECT_EQ(step(), 0u) << "the scene is free again";
}

// The law of floating-point environments, with tolerances that are flushed to 0 in some.
TEST_F(CSceneHostile, NoFloatModeChangesAResult) {
    cdprep_layer_pair pair = pair_of(1, 1, kAll);
    pair.tolerance = 0.1;
    pair.max_distance = 0x1p-1060;
    cdprep_plan_options changed = options();
    changed.layer_pairs = &pair;
    std::uint64_t expected = 0;
    for (const FloatMode& mode : float_modes()) {
        std::uint64_t hash = 0;
        const auto run = [&] {
            cdprep_plan* plan = nullptr;
            cdprep_scene* scene = nullptr;
            cdprep_step step;
            std::array<cdprep_object, 3> ids{};
            const std::array<cdprep_object_options, 3> objects = {object(), object(1.1),
                                                                  object(2.1)};
            if (cdprep_plan_compile(&changed, nullptr, nullptr, &plan, nullptr) != CDPREP_OK ||
                cdprep_scene_make(plan, nullptr, 0, &scene, nullptr) != CDPREP_OK ||
                cdprep_scene_add(scene, objects.data(), 3, ids.data(), nullptr) != CDPREP_OK ||
                cdprep_scene_step(scene, workspace_.get(), &step, nullptr) != CDPREP_OK) {
                return;
            }
            std::array<char, 200> text{};
            std::size_t length = 0;
            (void)cdprep_plan_text(plan, text.data(), text.size(), &length, nullptr);
            (void)cdprep_scene_hash(scene, &hash, nullptr);
            cdprep_scene_end(scene);
            cdprep_plan_end(plan);
        };
        EXPECT_EQ(run_in(mode, run), control_bits(mode.control)) << mode.name;
        EXPECT_NE(hash, 0u) << mode.name;
        if (expected == 0) expected = hash;
        EXPECT_EQ(hash, expected) << mode.name;
    }
}

// Boxes of models ---------------------------------------------------------------------------------

TEST_F(CSceneHostile, BoxesOfModelsAreChecked) {
    const cdprep_pose right = object().world_from_model;
    const std::array<double, 3> origin = {0, kNan, 0};
    cdprep_error error;
    cdprep_world_box box{};
    const auto expect = [&](int code, int why, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why) << argument;
        EXPECT_STREQ(error.argument, argument);
        EXPECT_GT(box.lower[0], box.upper[0]) << "absent";
        box = {};
    };
    const cdprep_model* const cube = cube_.get();
    expect(cdprep_model_box(nullptr, &right, 0, nullptr, &box, &error), CDPREP_WHY_NULL, "model");
    expect(cdprep_model_box(cube, nullptr, 0, nullptr, &box, &error), CDPREP_WHY_NULL,
           "world_from_model");
    EXPECT_EQ(cdprep_model_box(cube, &right, 0, nullptr, nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "around");
    expect(cdprep_model_box(cube, &right, 0, origin.data(), &box, &error), CDPREP_WHY_NOT_FINITE,
           "origin[1]");
    expect(cdprep_model_box(cube, &right, -1, nullptr, &box, &error), CDPREP_WHY_OUT_OF_RANGE,
           "reach");
    expect(cdprep_model_box(cube, &right, kInfinity, nullptr, &box, &error), CDPREP_WHY_NOT_FINITE,
           "reach");
    cdprep_pose wrong = right;
    wrong.rows[4] = -1;
    expect(cdprep_model_box(cube, &wrong, 0, nullptr, &box, &error), CDPREP_WHY_NOT_RIGID,
           "world_from_model");
    wrong.rows[4] = kNan;
    expect(cdprep_model_box(cube, &wrong, 0, nullptr, &box, &error), CDPREP_WHY_NOT_FINITE,
           "world_from_model.rows[4]");
    const CModel corners(file_, CDPREP_ASK_CORNERS);
    expect(cdprep_model_box(corners.get(), &right, 0, nullptr, &box, &error), CDPREP_WHY_NOT_OPENED,
           "model");
    EXPECT_EQ(cdprep_model_box(cube, &right, 0, nullptr, &box, &error), CDPREP_OK);
    EXPECT_LE(box.lower[0], 0);
    EXPECT_GE(box.upper[2], 1);
    EXPECT_LT(box.upper[2], 1.001);
}

// The same boxes as those of C++, in every floating-point environment.
TEST_F(CSceneHostile, BoxesOfModelsAreThoseOfCpp) {
    const Model cube = Model::open(file_.span()).value();
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        const Pose pose = random_pose(random, 1000);
        const cdprep_pose rows = rows_in_c(pose);
        const double reach = (i % 4) * 0.3;
        const std::array<double, 3> origin = {500.0 * (i % 3), -7, 0.1 * i};
        const WorldBox expected =
            world_box(root_box(cube, pose, reach), {origin[0], origin[1], origin[2]});
        for (const FloatMode& mode : float_modes()) {
            cdprep_world_box box{};
            (void)run_in(mode, [&] {
                (void)cdprep_model_box(cube_.get(), &rows, reach, origin.data(), &box, nullptr);
            });
            EXPECT_EQ(std::memcmp(&box, &expected, sizeof box), 0) << mode.name;
        }
    }
}

// The broad phase ---------------------------------------------------------------------------------

class CBroadPhaseHostile : public testing::Test {
protected:
    CBroadPhaseHostile() {
        cdprep_broad_phase_options_init(&options_, sizeof options_);
        options_.max_boxes = 4;
        options_.max_pairs = 4;
        EXPECT_EQ(cdprep_broad_phase_make(&options_, nullptr, 0, &broad_phase_, nullptr),
                  CDPREP_OK);
        cdprep_box_update_init(&update_, sizeof update_);
        update_.boxes = boxes_.data();
        update_.count = 3;
    }
    ~CBroadPhaseHostile() override {
        cdprep_broad_phase_end(broad_phase_);
    }
    Outcome update(const cdprep_box_update* given) {
        cdprep_error error;
        const int code =
            cdprep_broad_phase_update(broad_phase_, given, workspace_.get(), &pairs_, &error);
        return outcome(code, error, pairs_.count == 0 && pairs_.complete == CDPREP_NO);
    }

    CWorkspace workspace_;
    std::array<cdprep_world_box, 5> boxes_ = {{{{0, 0, 0}, {1, 1, 1}},
                                               {{1, 0, 0}, {2, 1, 1}},
                                               {{3, 0, 0}, {4, 1, 1}},
                                               {{0, 0, 0}, {1, 1, 1}},
                                               {{0, 0, 0}, {1, 1, 1}}}};
    cdprep_broad_phase_options options_{};
    cdprep_broad_phase* broad_phase_ = nullptr;
    cdprep_box_update update_{};
    cdprep_box_pairs pairs_{};
};

TEST_F(CBroadPhaseHostile, OptionsAreCheckedFieldByField) {
    using O = cdprep_broad_phase_options;
    std::vector<Mistake<O>> all = struct_mistakes<O>("options");
    static const cdprep_allocator none = {nullptr, nullptr, nullptr};
    const auto word = [&](const char* name, std::uint32_t O::*field, std::uint32_t value) {
        all.push_back({name, [=](O& o) { o.*field = value; }, CDPREP_WHY_OUT_OF_RANGE, name});
    };
    word("options.max_boxes", &O::max_boxes, (1U << 29) + 1);
    word("options.lanes", &O::lanes, 0);
    word("options.lanes", &O::lanes, 257);
    all.push_back(
        {"reserved", [](O& o) { o.reserved = 1; }, CDPREP_WHY_NEWER_FIELD, "options.reserved"});
    all.push_back(
        {"no functions", [](O& o) { o.allocator = &none; }, CDPREP_WHY_NULL, "options.allocator"});
    expect_refused(options_, all, [](const O* given) {
        cdprep_error error;
        std::size_t size = 77;
        const int sized = cdprep_broad_phase_size(given, &size, &error);
        Outcome result = outcome(sized, error, size == 0);
        auto* made = reinterpret_cast<cdprep_broad_phase*>(1);
        EXPECT_EQ(cdprep_broad_phase_make(given, nullptr, 0, &made, &error), sized);
        EXPECT_EQ(made == nullptr, sized != CDPREP_OK);
        cdprep_broad_phase_end(made);
        if (given == nullptr) result.why = CDPREP_WHY_NULL;  // null means the defaults
        return result;
    });
}

TEST_F(CBroadPhaseHostile, UpdatesAreCheckedFieldByField) {
    using U = cdprep_box_update;
    static std::array<std::uint32_t, 2> moved = {2, 3};
    std::vector<Mistake<U>> all = struct_mistakes<U>("update");
    all.push_back({"no boxes", [](U& u) { u.boxes = nullptr; }, CDPREP_WHY_NULL, "update.boxes"});
    all.push_back({"many", [](U& u) { u.count = 5; }, CDPREP_WHY_OUT_OF_RANGE, "update.count"});
    all.push_back(
        {"many", [](U& u) { u.count = UINT32_MAX; }, CDPREP_WHY_OUT_OF_RANGE, "update.count"});
    all.push_back({"no numbers", [](U& u) { u.moved_count = 1; }, CDPREP_WHY_NULL, "update.moved"});
    all.push_back({"another count",
                   [](U& u) {
                       u.moved = moved.data();
                       u.count = 4;
                   },
                   CDPREP_WHY_OUT_OF_RANGE, "update.count"});
    all.push_back({"no such box",
                   [](U& u) {
                       u.moved = moved.data();
                       u.moved_count = 2;
                   },
                   CDPREP_WHY_OUT_OF_RANGE, "update.moved[1]"});
    expect_refused(update_, all, [&](const U* given) { return update(given); });
}

// NaN is refused in any place, by name, and changes nothing; infinity is the largest number.
TEST_F(CBroadPhaseHostile, BoxesWithNanAreRefused) {
    constexpr float kNanFloat = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    ASSERT_EQ(update(&update_).code, CDPREP_OK);
    ASSERT_EQ(pairs_.count, 1u);
    const std::uint32_t one = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool is_lower : {true, false}) {
            for (const bool is_moved : {true, false}) {
                const cdprep_world_box before = boxes_[1];
                (is_lower ? boxes_[1].lower : boxes_[1].upper)[axis] = kNanFloat;
                update_.moved = is_moved ? &one : nullptr;
                update_.moved_count = is_moved ? 1 : 0;
                const Outcome refused = update(&update_);
                EXPECT_EQ(refused.why, CDPREP_WHY_NOT_FINITE);
                EXPECT_EQ(refused.argument, std::string("update.boxes[1].") +
                                                (is_lower ? "lower[" : "upper[") +
                                                std::to_string(axis) + "]");
                EXPECT_TRUE(refused.is_unknown);
                boxes_[1] = before;
            }
        }
    }
    update_.moved = nullptr;
    update_.moved_count = 0;
    boxes_[2] = {{-kInfinite, 0, 0}, {kInfinite, 0, 0}};
    ASSERT_EQ(update(&update_).code, CDPREP_OK);
    EXPECT_EQ(pairs_.count, 3u);
    boxes_[2] = {{1, 0, 0}, {0, 0, 0}};  // absent
    ASSERT_EQ(update(&update_).code, CDPREP_OK);
    EXPECT_EQ(pairs_.count, 1u);
}

TEST_F(CBroadPhaseHostile, NullAndMemoryAreChecked) {
    cdprep_error error;
    std::size_t size = 0;
    ASSERT_EQ(cdprep_broad_phase_size(&options_, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size + 64);
    std::byte* const start = memory.span().data();
    cdprep_broad_phase* made = broad_phase_;
    const auto why = [&](void* at, std::size_t room) {
        made = broad_phase_;
        (void)cdprep_broad_phase_make(&options_, at, room, &made, &error);
        EXPECT_EQ(made == nullptr, error.code != CDPREP_OK);
        return error.why;
    };
    EXPECT_EQ(why(start, size - 1), CDPREP_WHY_TOO_SMALL);
    EXPECT_EQ(why(start + 32, size), CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(why(nullptr, size), CDPREP_WHY_NULL);
    Blocks blocks;
    options_.allocator = &blocks.allocator;
    EXPECT_EQ(why(start, size), CDPREP_WHY_NO_MEANING);
    EXPECT_EQ(why(nullptr, 0), 0);
    cdprep_broad_phase_end(made);
    EXPECT_EQ(blocks.given, 1u);
    EXPECT_EQ(blocks.taken, 1u);
    options_.allocator = nullptr;
    EXPECT_EQ(why(start, size), 0);
    cdprep_broad_phase_end(made);
    const auto expect_null = [&](int code, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_NULL);
        EXPECT_STREQ(error.argument, argument);
    };
    cdprep_workspace* const workspace = workspace_.get();
    expect_null(cdprep_broad_phase_size(&options_, nullptr, &error), "size");
    expect_null(cdprep_broad_phase_make(&options_, nullptr, 0, nullptr, &error), "broad_phase");
    expect_null(cdprep_broad_phase_update(nullptr, &update_, workspace, &pairs_, &error),
                "broad_phase");
    expect_null(cdprep_broad_phase_update(broad_phase_, nullptr, workspace, &pairs_, &error),
                "update");
    expect_null(cdprep_broad_phase_update(broad_phase_, &update_, nullptr, &pairs_, &error),
                "workspace");
    expect_null(cdprep_broad_phase_update(broad_phase_, &update_, workspace, nullptr, &error),
                "pairs");
    cdprep_broad_phase_end(nullptr);
    cdprep_broad_phase_options_init(nullptr, sizeof options_);
    cdprep_box_update_init(nullptr, sizeof update_);
}

// The law: the pairs are those of all boxes against all, on any lanes.
TEST(CBroadPhase, FindsThePairsOfBruteForce) {
    CLanes lanes(3);
    cdprep_broad_phase_options options;
    cdprep_broad_phase_options_init(&options, sizeof options);
    options.max_boxes = 500;
    options.max_pairs = 100'000;
    options.lanes = 3;
    cdprep_broad_phase* broad_phase = nullptr;
    ASSERT_EQ(cdprep_broad_phase_make(&options, nullptr, 0, &broad_phase, nullptr), CDPREP_OK);
    std::vector<cdprep_world_box> boxes(500);
    std::uint32_t seed = 20261126;
    const auto any = [&] {
        return static_cast<float>((seed = seed * 1664525U + 1013904223U) >> 24);
    };
    for (int round = 0; round < 20; ++round) {
        for (cdprep_world_box& box : boxes) {
            for (int axis = 0; axis < 3; ++axis) {
                box.lower[axis] = any();
                box.upper[axis] = box.lower[axis] + 30;
            }
        }
        cdprep_box_update update;
        cdprep_box_update_init(&update, sizeof update);
        update.boxes = boxes.data();
        update.count = 500;
        cdprep_box_pairs pairs;
        ASSERT_EQ(cdprep_broad_phase_update(broad_phase, &update, lanes.get(), &pairs, nullptr),
                  CDPREP_OK);
        std::size_t expected = 0;
        for (std::uint32_t a = 0; a < 500; ++a) {
            for (std::uint32_t b = a + 1; b < 500; ++b) {
                bool meets = true;
                for (int axis = 0; axis < 3; ++axis) {
                    meets = meets && boxes[a].lower[axis] <= boxes[b].upper[axis] &&
                            boxes[b].lower[axis] <= boxes[a].upper[axis];
                }
                if (!meets) continue;
                ASSERT_LT(expected, pairs.count);
                EXPECT_EQ(pairs.items[expected].a, a);
                EXPECT_EQ(pairs.items[expected].b, b);
                ++expected;
            }
        }
        EXPECT_EQ(pairs.count, expected);
        EXPECT_GT(expected, 500u);
    }
    EXPECT_GT(lanes.threads.calls, 10u);
    EXPECT_LE(lanes.threads.most, 3u);
    cdprep_broad_phase_end(broad_phase);
}

}  // namespace
}  // namespace cdprep::test
