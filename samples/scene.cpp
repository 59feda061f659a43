// SPDX-License-Identifier: MIT
// Ten bolts fly at ten brackets: when do they come near one, when do they hit one?
// Bolts never meet each other here: no pair of layers asks for that, so nothing looks at it.
//
//     sample_scene bracket.cdp.h5 bolt.cdp.h5
#include <iostream>
#include <vector>

#include "cdprep/scene.h"

namespace {

constexpr std::uint32_t kBrackets = 0, kBolts = 1;  // layers
constexpr int kRow = 10, kFrames = 40;

cdprep::Pose at(double x, double y, double z) {
    return cdprep::Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}).value();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: sample_scene BRACKET BOLT\n";
        return 2;
    }
    const auto bracket = cdprep::Model::open(argv[1]), bolt = cdprep::Model::open(argv[2]);
    if (!bracket || !bolt) {
        std::cerr << (bracket ? bolt : bracket).error().message << '\n';
        return 3;
    }

    // What is asked for, once.
    const std::vector<cdprep::LayerPair> pairs = {
        {.a = kBrackets,
         .b = kBolts,
         .effects = cdprep::Ask::collide | cdprep::Ask::within,
         .tolerance = 10}};
    const std::vector<cdprep::ModelUse> models = {{argv[1], bracket.value().asks(), 1 << kBrackets},
                                                  {argv[2], bolt.value().asks(), 1 << kBolts}};
    const auto compiled = cdprep::Plan::compile(
        {.pairs = pairs, .models = models, .limits = {.objects = 200, .pairs = 2000}});
    for (const auto& refusal : compiled.refusals) std::cerr << refusal << '\n';
    if (!compiled.plan) return 2;
    std::cout << compiled.plan->describe();

    cdprep::Scene scene(*compiled.plan);
    std::vector<cdprep::Workspace> workspaces(1);  // one for each thread
    for (int i = 0; i < kRow; ++i) {
        if (!scene.add({&bracket.value(), kBrackets, at(200.0 * i, 0, 0)})) return 1;
    }
    std::vector<cdprep::ObjectId> bolts;
    bolts.reserve(kRow);
    for (int i = 0; i < kRow; ++i) {
        bolts.push_back(*scene.add({&bolt.value(), kBolts, at(200.0 * i - 60, 15, -19.5)}));
    }
    for (int frame = 0; frame < kFrames; ++frame) {
        for (std::size_t i = 0; i < bolts.size(); ++i) {
            const double x = 200.0 * static_cast<double>(i) - 60 + 4 * frame;
            if (!scene.set_pose(bolts[i], at(x, 15, -19.5))) return 1;
        }
        const auto step = scene.step(workspaces);
        if (!step.complete) {
            std::cerr << "Room for " << step.needed_pairs << " pairs is needed.\n";
            return 5;
        }
        for (const auto& event : scene.events()) {
            const bool is_hit = event.effect == cdprep::Ask::collide;
            std::cout << "frame " << frame << ": bolt " << event.b.slot - kRow
                      << (event.kind == cdprep::EventKind::begins ? " begins to " : " ceases to ")
                      << (is_hit ? "hit" : "be near") << " bracket " << event.a.slot << '\n';
        }
    }
    const auto& counts = scene.counts();
    std::cout << scene.object_count() << " objects: " << counts.calls_of(cdprep::Ask::collide)
              << " of " << counts.candidates << " candidates in the last frame were tested\n";
}
