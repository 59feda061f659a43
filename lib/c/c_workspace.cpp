// SPDX-License-Identifier: MIT
#include "c/c_workspace.h"

#include <array>
#include <cassert>
#include <cstdint>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/share_out.h"

namespace cdprep::c {
namespace {

constexpr char kInUse[] = "is in use by another call.";

constexpr std::array kFields = {
    Field{"lanes", offsetof(cdprep_workspace_options, lanes), Holds::choice, kMostLanes},
    Field{"counting", offsetof(cdprep_workspace_options, counting), Holds::choice, CDPREP_YES},
};

/// Checked options of a workspace.
struct Asked {
    cdprep_workspace_options options{};
    cdprep_allocator allocator{};
    std::size_t size = 0;  ///< of the block
};

static_assert(alignof(cdprep_workspace) <= CDPREP_ALIGNMENT && alignof(QueryCounts) <= 8);
static_assert(sizeof(QueryCounts) <= sizeof(cdprep_counts));
static_assert(std::is_trivially_destructible_v<QueryCounts>);

const CellSearches* cells_of(const cdprep_workspace_options& options) noexcept {
    return reinterpret_cast<const CellSearches*>(options.cells);
}

/// The offset of each part of the block.
struct Layout {
    Layout(std::uint32_t lanes, const CellSearches* cells) noexcept
        : objects(aligned(sizeof(cdprep_workspace))),
          counts(objects + aligned(lanes * sizeof(Workspace))),
          scratch(counts + aligned(lanes * sizeof(QueryCounts))),
          scratch_size(aligned(Workspace::size(cells))),
          size(scratch + lanes * scratch_size) {
        assert(lanes > 0 && lanes <= kMostLanes);
    }

    std::size_t objects;
    std::size_t counts;
    std::size_t scratch;
    std::size_t scratch_size;  ///< of one lane
    std::size_t size;
};

int read(Call& call, const cdprep_workspace_options* given, Asked& asked) noexcept {
    const Name name = {"options"};
    if (const int code = read_options(call, name, given, asked.options)) return code;
    const cdprep_workspace_options& options = asked.options;
    if (options.lanes == 0) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("lanes"), "is 0; it must be 1 to %u.",
                           kMostLanes);
    }
    if (options.lanes > 1 && options.run == nullptr) {
        return call.refuse(CDPREP_WHY_NO_MEANING, name.of("lanes"),
                           "is %u, but options.run is null, so nothing runs them.", options.lanes);
    }
    asked.size = Layout(options.lanes, cells_of(options)).size;
    return read_allocator(call, name.of("allocator"), options.allocator, asked.allocator);
}

/// Makes all objects in the block.
cdprep_workspace* make_in(const Asked& asked, std::byte* block, const Memory& memory) noexcept {
    const std::uint32_t lanes = asked.options.lanes;
    const CellSearches* const cells = cells_of(asked.options);
    const Layout layout(lanes, cells);
    assert(layout.size == asked.size);
    assert(reinterpret_cast<std::uintptr_t>(block) % CDPREP_ALIGNMENT == 0);
    auto* const objects = reinterpret_cast<Workspace*>(block + layout.objects);
    auto* const counts = reinterpret_cast<QueryCounts*>(block + layout.counts);
    for (std::uint32_t i = 0; i < lanes; ++i) {
        const std::span<std::byte> scratch(block + layout.scratch + i * layout.scratch_size,
                                           layout.scratch_size);
        std::optional<Workspace> lane = Workspace::in_memory(scratch, cells);
        if (!lane) return nullptr;
        new (objects + i) Workspace{std::move(*lane)};
        new (counts + i) QueryCounts{};
        if (asked.options.counting == CDPREP_YES) objects[i].count_into(counts + i);
    }
    const std::size_t counted = asked.options.counting == CDPREP_YES ? lanes : 0;
    return new (block) cdprep_workspace{{objects, lanes},
                                        {counts, counted},
                                        asked.options.run,
                                        asked.options.context,
                                        memory,
                                        cells != nullptr,
                                        false};
}

/// The data that the tasks of one run share.
struct Handed {
    Task task;
    std::size_t count;
    std::array<std::atomic<bool>, kMostLanes>* begun;

    void run(std::size_t number) const {
        if (number < count && !(*begun)[number].exchange(true)) task(number);
    }
};

void run_handed(const void* work, std::size_t number) {
    static_cast<const Handed*>(work)->run(number);
}

}  // namespace

const InputType Input<cdprep_workspace_options>::type = {"cdprep_workspace_options", 0xcd500001U,
                                                         sizeof(cdprep_workspace_options),
                                                         sizeof(cdprep_workspace_options), kFields};

cdprep_workspace_options Input<cdprep_workspace_options>::defaults() noexcept {
    cdprep_workspace_options options{};
    options.lanes = 1;
    return options;
}

int check_free(Call& call, const Name& name, const std::atomic<bool>& in_use) noexcept {
    if (!in_use.load(std::memory_order_acquire)) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_BUSY, name, kInUse);
}

int InUse::begin(Call& call, const Name& name, std::atomic<bool>& in_use) noexcept {
    assert(in_use_ == nullptr);
    if (in_use.exchange(true, std::memory_order_acquire)) {
        return call.refuse(CDPREP_WHY_BUSY, name, kInUse);
    }
    in_use_ = &in_use;
    return CDPREP_OK;
}

int InUse::begin(Call& call, cdprep_workspace& workspace) noexcept {
    return begin(call, {"workspace"}, workspace.in_use);
}

int check_cells(Call& call, const cdprep_workspace& workspace, Ask needs) noexcept {
    constexpr Ask kCells =
        Ask::octree | Ask::adaptive_octree | Ask::hashed_octree | Ask::tetra_tree;
    if (workspace.has_cells || (needs & kCells) == Ask::nothing) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_NO_MEANING, {"workspace"},
                       "cannot search octrees and tetra-trees: set cells in its options to "
                       "cdprep_cells().");
}

void LanesThreads::operator()(std::size_t count, Task task) const {
    const CallersThreads threads(workspace_);
    share_jobs(count, workspace_.lanes.size(), threads,
               [&](std::size_t number, std::size_t /*lane*/) { task(number); });
}

void CallersThreads::operator()(std::size_t count, Task task) const {
    if (count > kMostLanes) return LanesThreads(workspace_)(count, task);
    std::array<std::atomic<bool>, kMostLanes> begun{};
    const Handed handed = {task, count, &begun};
    if (workspace_.run != nullptr && count > 1) {
        workspace_.run(workspace_.context, count, run_handed, &handed);
    }
    for (std::size_t i = 0; i < count; ++i) handed.run(i);
}

}  // namespace cdprep::c

using cdprep::c::Call;

void cdprep_workspace_options_init(cdprep_workspace_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_workspace_size(const cdprep_workspace_options* options, size_t* size,
                          cdprep_error* error) {
    Call call(error);
    if (size != nullptr) *size = 0;
    if (const int code = call.need(size, {"size"})) return code;
    cdprep::c::Asked asked;
    if (const int code = cdprep::c::read(call, options, asked)) return code;
    *size = asked.size;
    return CDPREP_OK;
}

int cdprep_workspace_make(const cdprep_workspace_options* options, void* memory, size_t size,
                          cdprep_workspace** workspace, cdprep_error* error) {
    if (workspace != nullptr) *workspace = nullptr;
    return cdprep::c::guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(workspace, {"workspace"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        if (const int code = cdprep::c::check_memory(call, {memory, size}, asked.size,
                                                     asked.options.allocator)) {
            return code;
        }
        cdprep::c::Memory own;
        if (memory == nullptr) {
            if (const int code = allocate(call, asked.allocator, asked.size, own)) return code;
            memory = own.start;
        }
        *workspace = cdprep::c::make_in(asked, static_cast<std::byte*>(memory), own);
        if (*workspace != nullptr) return CDPREP_OK;
        release(own);
        return call.fail(CDPREP_INTERNAL, "The workspace does not fit into its own memory.");
    });
}

void cdprep_workspace_end(cdprep_workspace* workspace) {
    if (workspace == nullptr || workspace->in_use.exchange(true)) return;
    const cdprep::c::Memory memory = workspace->memory;
    std::destroy(workspace->lanes.begin(), workspace->lanes.end());
    std::destroy_at(workspace);
    release(memory);
}

int cdprep_workspace_counts(cdprep_workspace* workspace, cdprep_counts* counts,
                            cdprep_error* error) {
    Call call(error);
    if (counts != nullptr) *counts = {};
    if (const int code = call.need(workspace, {"workspace"})) return code;
    if (const int code = call.need(counts, {"counts"})) return code;
    if (workspace->counts.empty()) {
        return call.refuse(CDPREP_WHY_NO_MEANING, {"workspace"},
                           "was made without counting: set counting in its options.");
    }
    cdprep::c::InUse use;
    if (const int code = use.begin(call, *workspace)) return code;
    for (const cdprep::QueryCounts& lane : workspace->counts) {
        std::array<std::uint64_t, sizeof lane / sizeof(std::uint64_t)> numbers{};
        std::memcpy(numbers.data(), &lane, sizeof lane);
        for (std::size_t i = 0; i < numbers.size(); ++i) counts->n[i] += numbers[i];
    }
    return CDPREP_OK;
}
