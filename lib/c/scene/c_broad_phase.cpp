// SPDX-License-Identifier: MIT
#include "cdprep/broad_phase.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "c/c_model.h"
#include "c/c_workspace.h"
#include "c/memory.h"
#include "c/pose_input.h"
#include "c/scene/c_scene.h"
#include "cdprep/advanced/object_box.h"
#include "cdprep/format/float_environment.h"

/// A broad phase. The object and the memory of the C++ one lie one after the other in one block.
struct cdprep_broad_phase {
    cdprep::BroadPhase broad_phase;
    cdprep::BroadPhaseLimits limits;
    cdprep::c::Memory memory;  ///< none if it is the caller's
    std::uint32_t count = 0;   ///< of boxes in the last update
    std::atomic<bool> in_use = false;
};

namespace cdprep::c {

template <>
struct Input<cdprep_broad_phase_options> {
    static const InputType type;
    static cdprep_broad_phase_options defaults() noexcept {
        cdprep_broad_phase_options options{};
        options.lanes = 1;
        return options;
    }
};

template <>
struct Input<cdprep_box_update> {
    static const InputType type;
    static cdprep_box_update defaults() noexcept {
        return {};
    }
};

namespace {

using Options = cdprep_broad_phase_options;

constexpr std::array kFields = {
    Field{"max_boxes", offsetof(Options, max_boxes), Holds::choice, kMostWorldBoxes},
    Field{"lanes", offsetof(Options, lanes), Holds::choice, kMostLanes},
    Field{"reserved", offsetof(Options, reserved), Holds::reserved},
};

constexpr cdprep_world_box kAbsent = {{1, 1, 1}, {-1, -1, -1}};

constexpr Name kUpdate = {"update"};

static_assert(alignof(cdprep_broad_phase) <= CDPREP_ALIGNMENT);
static_assert(sizeof(cdprep_box_filter) == sizeof(BoxFilter) &&
              offsetof(cdprep_box_filter, accepts) == offsetof(BoxFilter, accepts));

/// Checked options of a broad phase.
struct Asked {
    cdprep_allocator allocator{};
    const cdprep_allocator* given_allocator = nullptr;
    BroadPhaseLimits limits{};
    std::size_t size = 0;  ///< of the block
};

constexpr std::size_t kStart = aligned(sizeof(cdprep_broad_phase));  ///< of the C++ memory

int read(Call& call, const Options* given, Asked& asked) noexcept {
    const Name name = {"options"};
    Options options;
    if (const int code = read_options(call, name, given, options)) return code;
    if (options.lanes == 0) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("lanes"), "is 0; it must be 1 to %u.",
                           kMostLanes);
    }
    asked.limits = {options.max_boxes, options.max_pairs, options.lanes};
    const std::uint64_t size = std::uint64_t{kStart} + BroadPhase::size(asked.limits);
    if (const int code = check_size(call, "The broad phase", size, asked.size)) return code;
    asked.given_allocator = options.allocator;
    return read_allocator(call, name.of("allocator"), options.allocator, asked.allocator);
}

int make(Call& call, const Asked& asked, const Given& given, cdprep_broad_phase** to) noexcept {
    if (const int code = check_memory(call, given, asked.size, asked.given_allocator)) return code;
    OwnedMemory own;
    std::byte* block = nullptr;
    if (const int code = take_memory(call, given, asked.size, asked.allocator, own, block))
        return code;
    assert(BroadPhase::alignment() <= CDPREP_ALIGNMENT);
    std::optional<BroadPhase> made =
        BroadPhase::in_memory({block + kStart, asked.size - kStart}, asked.limits);
    if (!made) return call.fail(CDPREP_INTERNAL, "The broad phase does not fit into its memory.");
    *to = new (block) cdprep_broad_phase{std::move(*made), asked.limits, own.take()};
    return CDPREP_OK;
}

int check_arrays(Call& call, const cdprep_box_update& update) noexcept {
    if (update.count > 0) {
        if (const int code = call.need(update.boxes, kUpdate.of("boxes"))) return code;
    }
    if (update.moved_count == 0) return CDPREP_OK;
    return call.need(update.moved, kUpdate.of("moved"));
}

/// Checks the numbers against those of the broad phase.
int check_counts(Call& call, const cdprep_box_update& update,
                 const cdprep_broad_phase& broad_phase) noexcept {
    const Name name = kUpdate.of("count");
    if (update.count > broad_phase.limits.boxes) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name,
                           "is %u; the broad phase was made for %u boxes.", update.count,
                           broad_phase.limits.boxes);
    }
    if (update.moved == nullptr) return CDPREP_OK;
    if (update.count != broad_phase.count) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name,
                           "is %u; with update.moved it must be %u, as in the last update.",
                           update.count, broad_phase.count);
    }
    for (std::uint32_t i = 0; i < update.moved_count; ++i) {
        if (update.moved[i] < update.count) continue;
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kUpdate.of("moved", i),
                           "is %u, but there are %u boxes.", update.moved[i], update.count);
    }
    return CDPREP_OK;
}

/// Refuses a box because of the first of its numbers that is NaN.
int refuse_box(Call& call, std::uint32_t number, const cdprep_world_box& box) noexcept {
    const format::FloatEnvironment environment;
    const Name name = {"update.boxes", number};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::isnan(box.lower[axis])) {
            return call.refuse(CDPREP_WHY_NOT_FINITE, name.of("lower", axis), "is not a number.");
        }
        if (std::isnan(box.upper[axis])) {
            return call.refuse(CDPREP_WHY_NOT_FINITE, name.of("upper", axis), "is not a number.");
        }
    }
    return call.refuse(CDPREP_WHY_NOT_FINITE, name, "has a NaN coordinate.");
}

BroadPhaseUpdate update_with(cdprep_broad_phase& broad_phase, const cdprep_box_update& update,
                             const cdprep_workspace& workspace) noexcept {
    const LanesThreads threads(workspace);
    const std::span boxes(reinterpret_cast<const WorldBox*>(update.boxes), update.count);
    const std::span filters(reinterpret_cast<const BoxFilter*>(update.filters),
                            update.filters != nullptr ? update.count : 0);
    if (update.moved == nullptr) return broad_phase.broad_phase.update(boxes, filters, threads);
    return broad_phase.broad_phase.update_moved(boxes, filters, {update.moved, update.moved_count},
                                                threads);
}

cdprep_box_pairs in_c(const BroadPhaseUpdate& made) noexcept {
    return {reinterpret_cast<const cdprep_box_pair*>(made.pairs.data()),
            made.pairs.size(),
            made.needed,
            static_cast<std::uint32_t>(made.complete ? CDPREP_YES : CDPREP_NO),
            made.escaped,
            static_cast<std::uint32_t>(made.kept ? CDPREP_YES : CDPREP_NO),
            0};
}

int update(Call& call, cdprep_broad_phase& broad_phase, const cdprep_box_update& given,
           const cdprep_workspace& workspace, cdprep_box_pairs& pairs) noexcept {
    if (const int code = check_counts(call, given, broad_phase)) return code;
    const BroadPhaseUpdate made = update_with(broad_phase, given, workspace);
    if (made.refused) return refuse_box(call, *made.refused, given.boxes[*made.refused]);
    broad_phase.count = given.count;
    pairs = in_c(made);
    return CDPREP_OK;
}

}  // namespace

const InputType Input<Options>::type = {"cdprep_broad_phase_options", 0xcd50000fU, sizeof(Options),
                                        sizeof(Options), kFields};

const InputType Input<cdprep_box_update>::type = {
    "cdprep_box_update", 0xcd500010U, sizeof(cdprep_box_update), sizeof(cdprep_box_update), {}};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;

void cdprep_broad_phase_options_init(cdprep_broad_phase_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_broad_phase_size(const cdprep_broad_phase_options* options, size_t* size,
                            cdprep_error* error) {
    Call call(error);
    if (size != nullptr) *size = 0;
    if (const int code = call.need(size, {"size"})) return code;
    cdprep::c::Asked asked;
    if (const int code = cdprep::c::read(call, options, asked)) return code;
    *size = asked.size;
    return CDPREP_OK;
}

int cdprep_broad_phase_make(const cdprep_broad_phase_options* options, void* memory, size_t size,
                            cdprep_broad_phase** broad_phase, cdprep_error* error) {
    if (broad_phase != nullptr) *broad_phase = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(broad_phase, {"broad_phase"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        return cdprep::c::make(call, asked, {memory, size}, broad_phase);
    });
}

void cdprep_broad_phase_end(cdprep_broad_phase* broad_phase) {
    if (broad_phase == nullptr || broad_phase->in_use.exchange(true)) return;
    const cdprep::c::Memory memory = broad_phase->memory;
    std::destroy_at(broad_phase);
    release(memory);
}

void cdprep_box_update_init(cdprep_box_update* update, size_t size) {
    cdprep::c::initialise(update, size);
}

int cdprep_broad_phase_update(cdprep_broad_phase* broad_phase, const cdprep_box_update* update,
                              cdprep_workspace* workspace, cdprep_box_pairs* pairs,
                              cdprep_error* error) {
    if (pairs != nullptr) *pairs = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(broad_phase, {"broad_phase"})) return code;
        if (const int code = call.need(update, {"update"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (const int code = call.need(pairs, {"pairs"})) return code;
        cdprep_box_update given;
        if (const int code = read_input(call, {"update"}, update, given)) return code;
        if (const int code = cdprep::c::check_arrays(call, given)) return code;
        cdprep::c::InUse use, workspace_use;
        if (const int code = use.begin(call, {"broad_phase"}, broad_phase->in_use)) return code;
        if (const int code = workspace_use.begin(call, *workspace)) return code;
        return cdprep::c::update(call, *broad_phase, given, *workspace, *pairs);
    });
}

int cdprep_model_box(const cdprep_model* model, const cdprep_pose* world_from_model, double reach,
                     const double* origin, cdprep_world_box* around, cdprep_error* error) {
    if (around != nullptr) *around = cdprep::c::kAbsent;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = call.need(world_from_model, {"world_from_model"})) return code;
        if (const int code = call.need(around, {"around"})) return code;
        if (const int code = check_number(call, "reach", cdprep::c::Holds::length, reach)) {
            return code;
        }
        std::array<double, 3> from{};
        if (origin != nullptr) std::copy_n(origin, 3, from.begin());
        if (const int code =
                check_numbers(call, {"origin"}, cdprep::c::Holds::number, from.data(), 3)) {
            return code;
        }
        cdprep::Pose pose;
        if (const int code = read_pose(call, {"world_from_model"}, world_from_model, pose)) {
            return code;
        }
        if (const int code = cdprep::c::check_bvh(call, {"model"}, model->model)) return code;
        const cdprep::WorldBox found =
            world_box(root_box(model->model, pose, reach), {from[0], from[1], from[2]});
        std::copy_n(found.lower, 3, around->lower);
        std::copy_n(found.upper, 3, around->upper);
        return CDPREP_OK;
    });
}
