// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "simulate/run/simulation.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/run_threads.h"

namespace cdprep::test {

/// A torus that moves through another one, and is asked everything. A third one is not asked, and a
/// fourth object has a model that was not opened.
class PageScene {
public:
    PageScene() {
        file_.name = "folder/page.json";
        file_.step_s = 0.25;
        file_.layers = {"still", "moving", "alone"};
        file_.pairs = {{.asked = {.a = 0,
                                  .b = 1,
                                  .effects = Ask::collide | Ask::overlap | Ask::within |
                                             Ask::distance | Ask::contacts,
                                  .tolerance = 0.25,
                                  .max_distance = 0.5,
                                  .contacts = {.tolerance = 0.1, .most = 8}}}};
        file_.models = {"folder/torus.obj", "folder/unused.obj"};
        file_.motions = {
            scenes::Motion::fixed({}),
            scenes::Motion::steady(*Pose::from_quaternion(1, 0.5, 0, 0, {1001, 0.1, 0.05}),
                                   {1, 0, 0}, {0, 0.5, 1}),
            scenes::Motion::fixed(*Pose::from_quaternion(1, 0, 0, 0, {1004, 3, 0})),
            scenes::Motion::fixed(*Pose::from_quaternion(1, 0, 0, 0, {1004, 0, 0}))};
        file_.objects = {{.name = "alone", .model = 0, .layer = 2, .motion = 2},
                         {.name = "still", .model = 0, .layer = 0, .motion = 3},
                         {.name = "unused", .model = 1, .layer = 2, .motion = 0},
                         {.name = "moving", .model = 0, .layer = 1, .motion = 1}};
        models_.resize(2);
        models_[0].model.emplace(std::move(torus_.model));
        models_[0].needs.asks = file_.pairs[0].asked.effects;
    }

    [[nodiscard]] scenes::SceneFile& file() {
        return file_;
    }
    [[nodiscard]] std::span<const scenes::SceneModel> models() const {
        return models_;
    }
    [[nodiscard]] const Model& torus() const {
        return *models_[0].model;
    }

    /// Calls `add` after each frame of a run. Returns the simulation as it then is.
    scenes::Simulation run(
        std::uint64_t frames,
        const std::function<void(std::uint64_t, const scenes::Simulation&)>& add) const {
        auto simulation = scenes::Simulation::make(file_, models_, 1, run_threads);
        EXPECT_TRUE(simulation);
        for (std::uint64_t frame = 0; frame < frames; ++frame) {
            EXPECT_TRUE(simulation->step(frame));
            add(frame, *simulation);
        }
        return std::move(simulation).value();
    }

private:
    scenes::SceneFile file_;
    std::vector<scenes::SceneModel> models_;
    OpenModel torus_ = [] {
        const TestMesh mesh = test::torus(0.7, 0.2, 12, 8);
        return open_tiny(with_contacts(with_pieces(bake_tiny(mesh.positions, mesh.triangles))));
    }();
};

/// Returns the numbers that base64 text holds.
template <class T>
std::vector<T> unpacked(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    for (std::size_t at = 0; at + 4 <= text.size(); at += 4) {
        std::uint32_t bits = 0;
        std::size_t count = 3;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t digit = digits.find(text[at + k]);
            bits = bits << 6 | (digit == std::string::npos ? 0 : static_cast<std::uint32_t>(digit));
            if (digit == std::string::npos) --count;
        }
        for (std::size_t k = 0; k < count; ++k) {
            bytes += static_cast<char>(bits >> (16 - 8 * k) & 255);
        }
    }
    EXPECT_EQ(bytes.size() % sizeof(T), 0u);
    std::vector<T> numbers(bytes.size() / sizeof(T));
    if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

/// Returns the data of an element of a page.
inline nlohmann::json element_of(const std::string& page, const std::string& id) {
    const std::string begin = "<script type=\"application/json\" id=\"" + id + "\">";
    const std::size_t at = page.find(begin);
    if (at == std::string::npos) return nullptr;
    const std::size_t from = at + begin.size();
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

}  // namespace cdprep::test
