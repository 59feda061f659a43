// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "c/memory.h"
#include "cdprep/c/scene.h"
#include "cdprep/plan.h"

namespace cdprep::c {

/// The number of pairs that the layers of a scene can form, each with itself too.
inline constexpr std::uint32_t kMostLayerPairs = kLayers * (kLayers + 1) / 2;

/// Refuses an argument `layer` that is no layer.
inline int check_layer(Call& call, std::uint32_t layer) noexcept {
    if (layer < kLayers) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"layer"}, "is %u; the greatest value is %u.",
                       layer, kLayers - 1);
}

}  // namespace cdprep::c

/// A compiled plan. It lives until the caller and all of its scenes have ended it.
struct cdprep_plan {
    cdprep::Plan plan;
    /// By number of a pair in the plan: its index in the options.
    std::array<std::uint16_t, cdprep::c::kMostLayerPairs> given_as;
    cdprep_allocator allocator;
    cdprep::c::Memory memory;  ///< of this object
    std::atomic<std::uint32_t> users = 1;
};
