// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "cdprep/scene.h"

namespace cdprep::test {

/// Calls `visit` with a plan for each set of effects, of surfaces and of solids.
template <class Visit>
void for_each_plan(const Visit& visit) {
    for (std::uint32_t set = 1; set < 1U << kSceneEffects.size(); ++set) {
        LayerPair pair;
        for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
            if ((set >> i & 1) != 0) pair.effects = pair.effects | kSceneEffects[i];
        }
        if (contains(pair.effects, Ask::within)) pair.tolerance = 0.1;
        if ((pair.effects & (Ask::distance | Ask::haptic)) != Ask::nothing) pair.max_distance = 0.5;
        if (contains(pair.effects, Ask::haptic)) pair.work = 300;
        if (contains(pair.effects, Ask::continuous)) pair.impact.tolerance = 0.05;
        for (const Body body : {Body::surface, Body::solid}) {
            pair.body = body;
            const std::vector<LayerPair> pairs = {pair};
            const auto compiled = Plan::compile(
                {.pairs = pairs,
                 .limits = {.objects = 8, .pairs = 40, .triangle_pairs = 30000, .contacts = 600}});
            if (compiled.plan) visit(*compiled.plan);
        }
    }
}

}  // namespace cdprep::test
