// SPDX-License-Identifier: MIT
#include "cdprep/c/live.h"

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "c/c_model.h"
#include "c/c_pairs.h"
#include "c/c_workspace.h"
#include "c/memory.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/live_model.h"

/// A live model. The object, the indices of its model and the memory of the C++ one lie one after
/// the other in one block.
struct cdprep_live {
    cdprep::LiveModel live;
    cdprep_model model;
    cdprep::c::Memory memory;  ///< none if it is the caller's
    std::atomic<bool> in_use = false;

    cdprep_live(cdprep::LiveModel made, const cdprep::c::Memory& block)
        : live(std::move(made)), model(live), memory(block) {}
};

namespace cdprep::c {

template <>
struct Input<cdprep_live_options> {
    static const InputType type;
    static cdprep_live_options defaults() noexcept {
        return {};
    }
};

template <>
struct Input<cdprep_live_move> {
    static const InputType type;
    static cdprep_live_move defaults() noexcept {
        return {};
    }
};

namespace {

constexpr std::array kFields = {
    Field{"model", offsetof(cdprep_live_options, model), Holds::pointer},
};

constexpr Name kOptions = {"options"};
constexpr Name kMoved = {"moved"};

/// Checked options of a live model.
struct Asked {
    cdprep_live_options options{};
    cdprep_allocator allocator{};
    LiveLimits limits;
    std::size_t index = 0;  ///< where the indices of the model begin in the block
    std::size_t start = 0;  ///< where the C++ memory begins
    std::size_t size = 0;   ///< of the block

    [[nodiscard]] const Model& base() const noexcept {
        return options.model->model;
    }
};

int read(Call& call, const cdprep_live_options* given, Asked& asked) {
    if (const int code = read_input(call, kOptions, given, asked.options)) return code;
    const cdprep_live_options& options = asked.options;
    if (const int code =
            read_allocator(call, kOptions.of("allocator"), options.allocator, asked.allocator)) {
        return code;
    }
    if (const int code =
            check_serves(call, kOptions.of("model"), *options.model, Ask::overlap | Ask::corners)) {
        return code;
    }
    if (options.max_triangles == 0 && options.max_vertices != 0) {
        return call.refuse(CDPREP_WHY_NO_MEANING, kOptions.of("max_vertices"),
                           "is %u, but options.max_triangles is 0.", options.max_vertices);
    }
    asked.limits = {options.max_triangles, options.max_vertices};
    const Result<std::size_t> size = LiveModel::bytes(asked.base(), asked.limits);
    if (!size) return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, kOptions, size.error().message);
    asked.index = aligned(sizeof(cdprep_live));
    const bool has_index = options.max_triangles == 0;
    asked.start = asked.index + (has_index ? aligned(index_size(asked.base())) : 0);
    return check_size(call, "The live model", std::uint64_t{asked.start} + *size, asked.size);
}

int make(Call& call, const Asked& asked, const Given& given, cdprep_live** to) {
    if (const int code = check_memory(call, given, asked.size, asked.options.allocator))
        return code;
    OwnedMemory own;
    std::byte* block = nullptr;
    if (const int code = take_memory(call, given, asked.size, asked.allocator, own, block)) {
        return code;
    }
    Result<LiveModel> made =
        LiveModel::in({block + asked.start, asked.size - asked.start}, asked.base(), asked.limits);
    if (!made) return call.fail(CDPREP_INTERNAL, made.error().message);
    *to = new (block) cdprep_live(std::move(made).value(), own.take());
    if (asked.options.max_triangles == 0) make_index((*to)->model, block + asked.index);
    return CDPREP_OK;
}

int check_move(Call& call, const cdprep_live_move& move) noexcept {
    if (move.count > format::kMaxVertices) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kMoved.of("count"),
                           "is %zu; it must be at most %u.", move.count, format::kMaxVertices);
    }
    const bool has_doubles = move.positions != nullptr;
    const bool has_floats = move.positions_f32 != nullptr;
    if (move.count > 0 && !has_doubles && !has_floats) {
        return call.refuse(CDPREP_WHY_NULL, kMoved.of("positions"),
                           "is null, and so is moved.positions_f32; one of them must be set.");
    }
    if (has_doubles && has_floats) {
        return call.refuse(CDPREP_WHY_NO_MEANING, kMoved.of("positions_f32"),
                           "is set, and so is moved.positions; only one of them may be set.");
    }
    return CDPREP_OK;
}

/// Refuses a position that is NaN, infinite or too large.
template <class Real>
int check_positions(Call& call, const char* field, const Real* numbers,
                    std::size_t count) noexcept {
    const format::FloatEnvironment environment;
    for (std::size_t i = 0; i < 3 * count; ++i) {
        const double number{numbers[i]};
        if (std::fabs(number) <= format::kMaxCoordinate) continue;
        return check_numbers(call, kMoved.of(field, i / 3), Holds::number, &number, 1);
    }
    return CDPREP_OK;
}

template <class Position>
int move_all(Call& call, LiveModel& live, const cdprep_live_move& move, const Position* positions,
             const LanesThreads& threads) {
    const std::span<const Position> to(positions, move.count);
    const Result<Done> done = move.vertices == nullptr
                                  ? live.refit(to, threads)
                                  : live.refit({move.vertices, move.count}, to, threads);
    if (done) return CDPREP_OK;
    return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, kMoved, done.error().message);
}

int refit(Call& call, LiveModel& live, const cdprep_live_move& move,
          const cdprep_workspace& workspace) {
    if (const int code = check_move(call, move)) return code;
    const LanesThreads threads(workspace);
    if (move.positions_f32 != nullptr) {
        if (const int code =
                check_positions(call, "positions_f32", move.positions_f32, move.count)) {
            return code;
        }
        return move_all(call, live, move, reinterpret_cast<const Float3*>(move.positions_f32),
                        threads);
    }
    if (const int code = check_positions(call, "positions", move.positions, move.count)) {
        return code;
    }
    return move_all(call, live, move, reinterpret_cast<const Double3*>(move.positions), threads);
}

int check_tears(Call& call, const cdprep_live& live) noexcept {
    if (!live.model.model.bvh().lanes.empty()) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_NO_MEANING, {"live"},
                       "was made without max_triangles, so its triangles stay.");
}

int append(Call& call, LiveModel& live, std::span<const format::Triangle> triangles,
           std::uint32_t& first) {
    const Result<std::uint32_t> added = live.append(triangles);
    if (!added)
        return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, {"triangles"}, added.error().message);
    first = *added;
    return CDPREP_OK;
}

int remove(Call& call, LiveModel& live, std::span<const std::uint32_t> numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (live.place_of(numbers[i])) continue;
        return call.refuse(CDPREP_WHY_STALE, {"numbers", i},
                           "is %u, and the live model has no such triangle.", numbers[i]);
    }
    const Result<Done> done = live.remove(numbers);
    if (done) return CDPREP_OK;
    return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, {"numbers"}, done.error().message);
}

}  // namespace

const InputType Input<cdprep_live_options>::type = {"cdprep_live_options", 0xcd500011U,
                                                    sizeof(cdprep_live_options),
                                                    sizeof(cdprep_live_options), kFields};
const InputType Input<cdprep_live_move>::type = {
    "cdprep_live_move", 0xcd500012U, sizeof(cdprep_live_move), sizeof(cdprep_live_move), {}};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;

void cdprep_live_options_init(cdprep_live_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

void cdprep_live_move_init(cdprep_live_move* moved, size_t size) {
    cdprep::c::initialise(moved, size);
}

int cdprep_live_size(const cdprep_live_options* options, size_t* size, cdprep_error* error) {
    if (size != nullptr) *size = 0;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(options, {"options"})) return code;
        if (const int code = call.need(size, {"size"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        *size = asked.size;
        return CDPREP_OK;
    });
}

int cdprep_live_make(const cdprep_live_options* options, void* memory, size_t size,
                     cdprep_live** live, cdprep_error* error) {
    if (live != nullptr) *live = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(options, {"options"})) return code;
        if (const int code = call.need(live, {"live"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        return cdprep::c::make(call, asked, {memory, size}, live);
    });
}

void cdprep_live_end(cdprep_live* live) {
    if (live == nullptr || live->in_use.exchange(true)) return;
    const cdprep::c::Memory memory = live->memory;
    std::destroy_at(live);
    release(memory);
}

const cdprep_model* cdprep_live_model(const cdprep_live* live) {
    return live == nullptr ? nullptr : &live->model;
}

int cdprep_live_refit(cdprep_live* live, const cdprep_live_move* moved, cdprep_workspace* workspace,
                      cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(live, {"live"})) return code;
        if (const int code = call.need(moved, {"moved"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        cdprep_live_move given;
        if (const int code = read_input(call, {"moved"}, moved, given)) return code;
        cdprep::c::InUse use, workspace_use;
        if (const int code = use.begin(call, {"live"}, live->in_use)) return code;
        if (const int code = workspace_use.begin(call, *workspace)) return code;
        return cdprep::c::refit(call, live->live, given, *workspace);
    });
}

int cdprep_live_append(cdprep_live* live, const uint32_t* triangles, size_t count, uint32_t* first,
                       cdprep_error* error) {
    if (first != nullptr) *first = CDPREP_NONE;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(live, {"live"})) return code;
        if (const int code = call.need(first, {"first"})) return code;
        if (count > 0) {
            if (const int code = call.need(triangles, {"triangles"})) return code;
        }
        if (const int code = cdprep::c::check_tears(call, *live)) return code;
        cdprep::c::InUse use;
        if (const int code = use.begin(call, {"live"}, live->in_use)) return code;
        return cdprep::c::append(
            call, live->live, {reinterpret_cast<const cdprep::format::Triangle*>(triangles), count},
            *first);
    });
}

int cdprep_live_remove(cdprep_live* live, const uint32_t* numbers, size_t count,
                       cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(live, {"live"})) return code;
        if (count > 0) {
            if (const int code = call.need(numbers, {"numbers"})) return code;
        }
        if (const int code = cdprep::c::check_tears(call, *live)) return code;
        cdprep::c::InUse use;
        if (const int code = use.begin(call, {"live"}, live->in_use)) return code;
        return cdprep::c::remove(call, live->live, {numbers, count});
    });
}

int cdprep_live_rebuild(cdprep_live* live, uint32_t most_triangles, uint32_t* taken,
                        cdprep_error* error) {
    Call call(error);
    if (taken != nullptr) *taken = 0;
    if (const int code = call.need(live, {"live"})) return code;
    if (const int code = call.need(taken, {"taken"})) return code;
    cdprep::c::InUse use;
    if (const int code = use.begin(call, {"live"}, live->in_use)) return code;
    *taken = live->live.rebuild(most_triangles);
    // Triangles have other places now. Components are as they were, and so are their numbers.
    if (*taken > 0 && !live->model.tree_triangle.empty()) {
        cdprep::c::make_index(live->model, live->model.tree_triangle.data());
    }
    return CDPREP_OK;
}

int cdprep_live_triangles(const cdprep_live* live, cdprep_live_triangle_list* list,
                          cdprep_error* error) {
    using Triangle = cdprep::LiveTriangle;
    static_assert(sizeof(cdprep_live_triangle) == sizeof(Triangle) &&
                  offsetof(cdprep_live_triangle, vertex) == offsetof(Triangle, vertex));
    Call call(error);
    if (list != nullptr) list->count = 0;
    if (const int code = call.need(live, {"live"})) return code;
    if (const int code = call.need(list, {"list"})) return code;
    if (const int code = cdprep::c::check_list(call, {"list"}, *list)) return code;
    if (const int code = cdprep::c::check_tears(call, *live)) return code;
    if (const int code = cdprep::c::check_free(call, {"live"}, live->in_use)) return code;
    list->count = live->live.triangles({reinterpret_cast<Triangle*>(list->items), list->room});
    return CDPREP_OK;
}

int cdprep_live_image(cdprep_live* live, cdprep_array* image, cdprep_error* error) {
    if (image != nullptr) *image = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(live, {"live"})) return code;
        if (const int code = call.need(image, {"image"})) return code;
        if (live->model.can_tear()) {
            return call.refuse(CDPREP_WHY_NO_MEANING, {"live"},
                               "was made with max_triangles; build a model of its triangles.");
        }
        cdprep::c::InUse use;
        if (const int code = use.begin(call, {"live"}, live->in_use)) return code;
        const cdprep::Result<std::span<const std::byte>> bytes = live->live.image();
        if (!bytes) return call.fail(CDPREP_INTERNAL, bytes.error().message);
        *image = {bytes->data(), bytes->size(), 1};
        return CDPREP_OK;
    });
}

int cdprep_live_describe(const cdprep_live* live, cdprep_live_info* info, cdprep_error* error) {
    Call call(error);
    if (info != nullptr) *info = {};
    if (const int code = call.need(live, {"live"})) return code;
    if (const int code = call.need(info, {"info"})) return code;
    if (const int code = cdprep::c::check_free(call, {"live"}, live->in_use)) return code;
    const cdprep::format::FloatEnvironment environment;
    info->triangles = live->live.triangle_count();
    info->number_bound = live->model.model.triangle_number_bound();
    info->vertices = static_cast<uint32_t>(live->live.position_count());
    info->is_torn = live->model.model.is_torn() ? CDPREP_YES : CDPREP_NO;
    info->surface_cost = live->live.surface_cost();
    return CDPREP_OK;
}
