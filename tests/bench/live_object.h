// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "bench_input.h"
#include "cdprep/live_model.h"

namespace cdprep {

/// A live model in memory of its own.
struct LiveObject {
    struct alignas(format::kSectionAlignment) Block {
        std::array<std::byte, format::kSectionAlignment> bytes;
    };
    std::vector<Block> memory;
    LiveModel model;
};

inline LiveObject make_live(std::span<const format::Float3> positions,
                            std::span<const format::Triangle> triangles,
                            const LiveLimits& limits = {}) {
    const auto arrays =
        build::build_model(positions, triangles, {.bounds = build::BvhBounds::aligned});
    if (!arrays) stop(arrays.error().message);
    const auto bytes = LiveModel::bytes(arrays.value(), limits);
    if (!bytes) stop(bytes.error().message);
    std::vector<LiveObject::Block> memory(bytes.value() / sizeof(LiveObject::Block) + 1);
    auto made = LiveModel::in(std::as_writable_bytes(std::span(memory)), arrays.value(), limits);
    if (!made) stop(made.error().message);
    return {std::move(memory), std::move(made).value()};
}

}  // namespace cdprep
