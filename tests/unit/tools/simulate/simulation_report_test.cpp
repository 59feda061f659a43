// SPDX-License-Identifier: MIT
#include "simulate/simulation_report.h"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene_file/compile_scene.h"
#include "scene_file/read_scene.h"
#include "simulate/cost_table.h"
#include "simulate/page/scene_timeline.h"
#include "simulate/run/section_use.h"
#include "simulate/run/unpaired_layers.h"
#include "support/guarded_pages.h"
#include "support/more_sections.h"
#include "support/run_threads.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::json;
using scenes::SceneFile;
using scenes::SceneModel;
using scenes::Simulation;

constexpr SceneLimits kPlanLimits = {.objects = 2000, .pairs = 1};

SceneFile sample_scene(const std::string& name) {
    auto reading =
        scenes::read_scene(std::string(CDPREP_SOURCE_DIR) + "/samples/scenes/" + name + ".json");
    EXPECT_TRUE(reading.scene) << name;
    return reading.scene ? std::move(*reading.scene) : SceneFile();
}

/// The sample scenes without bodies. Their limits do not matter for plans.
std::vector<SceneFile> sample_scenes() {
    std::vector<SceneFile> scenes;
    for (const char* name : {"crates", "assembly", "cloth", "cut", "thousand", "probe", "bolt"}) {
        scenes.push_back(sample_scene(name));
    }
    return scenes;
}

Plan plan_of(const SceneFile& scene) {
    return *scenes::compile_scene(scene, kPlanLimits).plan;
}

std::vector<scenes::ModelNeeds> needs_of(const SceneFile& scene) {
    return scenes::needs_of_models(scene, scenes::asks_of_layers(plan_of(scene)));
}

/// Opens the models of a scene, with what its plan reads.
std::vector<SceneModel> models_of(const SceneFile& scene) {
    const cli::Threads threads(1);
    auto loaded = scenes::load_models(scene, needs_of(scene), {}, threads);
    EXPECT_TRUE(loaded.errors.empty()) << scene.name;
    return std::move(loaded.models);
}

Json summary_of(const SceneFile& scene, const std::vector<SceneModel>& models,
                std::uint32_t threads, std::uint64_t frames) {
    auto simulation = Simulation::make(scene, models, threads, test::run_threads);
    EXPECT_TRUE(simulation);
    const Plan plan = plan_of(scene);
    SimulationReport report(scene, plan, EventFormat::ndjson, frames);
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
        EXPECT_TRUE(simulation->step(frame));
        static_cast<void>(report.add_frame(frame, *simulation));
    }
    return Json::parse(report.finish(*simulation))["summary"];
}

// The rows and the frame are read from one clock. The stages of a step follow each other without
// a gap, so only the clock's own time is missing. Another process may interrupt a run between two
// stages, so the rows of one of twenty runs must make up the frame.
TEST(SimulationReport, RowsMakeUpTheFrame) {
    for (const SceneFile& scene : sample_scenes()) {
        const std::vector<SceneModel> models = models_of(scene);
        for (const std::uint32_t threads : {1U, 2U}) {
            double explained = 0;
            for (int run = 0; run < 20 && !(explained > 0.95); ++run) {
                explained = summary_of(scene, models, threads, 16)["explained"];
                EXPECT_LT(explained, 1.05) << scene.name << " on " << threads;
            }
            EXPECT_GT(explained, 0.95) << scene.name << " on " << threads;
        }
    }
}

// As above, for what the page and the chart draw. Live models change in three of the scenes.
TEST(SimulationReport, StagesMakeUpTheFrame) {
    for (const SceneFile& scene : sample_scenes()) {
        const std::vector<SceneModel> models = models_of(scene);
        double explained = 0;
        for (int run = 0; run < 20 && !(explained > 0.95); ++run) {
            auto simulation = Simulation::make(scene, models, 1, test::run_threads);
            ASSERT_TRUE(simulation);
            double frames = 0, stages = 0;
            for (std::uint64_t frame = 0; frame < 16; ++frame) {
                ASSERT_TRUE(simulation->step(frame));
                frames += simulation->frame_seconds();
                for (const StageTime& stage : stage_times(*simulation)) stages += stage.seconds;
            }
            explained = stages / frames;
            EXPECT_LT(explained, 1.05) << scene.name;
        }
        EXPECT_GT(explained, 0.95) << scene.name;
    }
}

// By hand: nobody asks for the 60 objects of debris. The 2 crates are paired with the gate, the
// ground and each other.
TEST(SimulationReport, TellsWhichLayersAreNeverPaired) {
    const SceneFile crates = sample_scenes()[0];
    std::uint64_t looked_at = 64 * 63 / 2, debris = 0;
    for (const UnpairedLayers& one : unpaired_layers(crates)) {
        looked_at -= one.pairs;
        const bool is_debris = crates.layers[one.a] == "debris" && one.a == one.b;
        if (is_debris) debris = one.pairs;
    }
    EXPECT_EQ(debris, 60u * 59 / 2);
    EXPECT_EQ(looked_at, 1u + 2 + 2) << "crates with crates, triggers and ground";
}

TEST(SimulationReport, CountsMemoryAndSectionsOfAnEffect) {
    const SceneFile crates = sample_scenes()[0];
    const std::vector<SceneModel> models = models_of(crates);
    const Json summary = summary_of(crates, models, 1, 3);
    std::uint64_t read = 0, untouched = 0;
    for (const SceneModel& model : models) {
        if (!model.model) continue;
        read += use_of(*model.model).read.bytes;
        untouched += use_of(*model.model).untouched.bytes;
    }
    EXPECT_EQ(summary["sections"]["unread_bytes"], untouched);
    EXPECT_EQ(summary["sections"]["bytes"], read + untouched);
    ASSERT_EQ(summary["effects"].size(), 2u);
    for (const Json& effect : summary["effects"]) {
        EXPECT_GT(effect["state_bytes"], 0);
        EXPECT_GT(effect["read_bytes"], 0);
        EXPECT_LE(effect["read_bytes"], read);
    }
}

/// A scene whose models have more sections than it asks for, each on pages of its own. Those that
/// it does not ask for are closed.
class ClosedScene {
public:
    explicit ClosedScene(const SceneFile& scene) : scene_(scene) {
        // Another scene asks for more of the same models.
        SceneFile more = scene;
        for (scenes::AskedPair& pair : more.pairs) {
            if ((pair.asked.effects & kSceneChanges) == Ask::nothing) {
                pair.asked.effects = pair.asked.effects | Ask::contacts | Ask::overlap;
            }
        }
        whole_ = models_of(more);
        const auto needs = needs_of(scene);
        models_.resize(whole_.size());
        for (std::size_t i = 0; i < whole_.size(); ++i) {
            models_[i].needs = needs[i];
            if (whole_[i].model) open(i);
        }
    }
    [[nodiscard]] int closed() const {
        int count = 0;
        for (const auto& pages : pages_) count += pages->guarded();
        return count;
    }
    void close(format::SectionId id) {
        for (const auto& pages : pages_) pages->close(id);
    }
    [[nodiscard]] std::uint64_t contacts() const {
        return contacts_;
    }
    /// Returns the hash of the results of some frames.
    [[nodiscard]] std::uint64_t hash_of_frames(bool of_whole = false,
                                               std::uint64_t frames = 8) const {
        auto simulation =
            Simulation::make(scene_, of_whole ? whole_ : models_, 1, test::run_threads);
        EXPECT_TRUE(simulation);
        std::uint64_t hash = 0;
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            EXPECT_TRUE(simulation->step(frame));
            hash = 31 * hash + simulation->scene().state_hash();
            if (const scenes::Response* response = simulation->response()) {
                hash = 31 * hash + response->bodies().state_hash();
                contacts_ += response->bodies().counts().contacts;
            }
            for (const Ask one : kSceneEffects) {
                if (contains(simulation->plan().effects(), one)) continue;
                EXPECT_EQ(simulation->scene().counts().calls_of(one), 0u);
            }
        }
        return hash;
    }

private:
    void open(std::size_t i) {
        const std::span<const std::byte> bytes = whole_[i].model->bytes();
        const test::AlignedBytes file = test::on_pages(test::AlignedBytes(bytes));
        const format::SectionSet wanted = sections_for(models_[i].needs.wanted());
        pages_.push_back(std::make_unique<test::GuardedPages>(file.span(), wanted));
        auto model = Model::open(pages_.back()->bytes(), wanted);
        ASSERT_TRUE(model) << model.error().message;
        models_[i].model.emplace(std::move(model).value());
    }

    const SceneFile& scene_;
    mutable std::uint64_t contacts_ = 0;  ///< of bodies, in all frames
    std::vector<SceneModel> whole_;
    std::vector<std::unique_ptr<test::GuardedPages>> pages_;
    std::vector<SceneModel> models_;
};

// What an effect would read that nobody asks for is closed to every access.
TEST(SimulationPages, ReadOnlyWhatTheSceneAsksFor) {
    for (const SceneFile& scene : sample_scenes()) {
        const ClosedScene closed(scene);
        EXPECT_GE(closed.closed(), 3) << scene.name;
        EXPECT_EQ(closed.hash_of_frames(), closed.hash_of_frames(true)) << scene.name;
    }
}

// Bodies fall on each other within these frames. They read contacts, solids and mass.
TEST(SimulationPages, BodiesReadOnlyWhatPushesThem) {
    if (!dynamics::has_dynamics()) GTEST_SKIP() << "built without Bullet";
    const SceneFile pile = sample_scene("pile");
    const ClosedScene closed(pile);
    EXPECT_GE(closed.closed(), 3);
    EXPECT_EQ(closed.hash_of_frames(false, 16), closed.hash_of_frames(true, 16));
    EXPECT_GT(closed.contacts(), 0u);
}

// The test above would notice: a section that is needed and closed ends the program.
TEST(SimulationPagesDeathTest, AClosedSectionIsNoticed) {
    const SceneFile crates = sample_scenes()[0];
    ClosedScene closed(crates);
    closed.close(format::SectionId::bvh_leaves);
    EXPECT_DEATH(static_cast<void>(closed.hash_of_frames()), "");
}

}  // namespace
}  // namespace cdprep::report
