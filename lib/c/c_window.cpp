// SPDX-License-Identifier: MIT
#include "cdprep/c/window.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <new>
#include <utility>

#include "c/c_model.h"
#include "c/c_pairs.h"
#include "c/c_workspace.h"
#include "c/memory.h"
#include "c/pair_answers.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/window.h"

/// A window. The object and the memory of the C++ one lie one after the other in one block.
struct cdprep_window {
    cdprep::Window window;
    cdprep_model model;
    cdprep::c::Memory memory;  ///< none if it is the caller's
    mutable std::atomic<bool> in_use = false;

    cdprep_window(cdprep::Window made, const cdprep::c::Memory& block)
        : window(std::move(made)), model(window.model(), *this), memory(block) {}
};

namespace cdprep::c {

template <>
struct Input<cdprep_window_options> {
    static const InputType type;
    static cdprep_window_options defaults() noexcept {
        return {};
    }
};

namespace {

constexpr std::array kFields = {
    Field{"reserved", offsetof(cdprep_window_options, reserved), Holds::reserved},
};

constexpr Name kOptions = {"options"};

/// Checked options of a window.
struct Asked {
    cdprep_window_options options{};
    cdprep_allocator allocator{};
    std::size_t start = 0;  ///< where the C++ memory begins
    std::size_t size = 0;   ///< of the block
};

int read(Call& call, const cdprep_window_options* given, Asked& asked) {
    if (const int code = read_input(call, kOptions, given, asked.options)) return code;
    const cdprep_window_options& options = asked.options;
    if (const int code =
            read_allocator(call, kOptions.of("allocator"), options.allocator, asked.allocator)) {
        return code;
    }
    const Result<std::size_t> size = Window::bytes({options.max_leaves});
    if (!size) {
        return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, kOptions.of("max_leaves"),
                                size.error().message);
    }
    asked.start = aligned(sizeof(cdprep_window));
    return check_size(call, "The window", std::uint64_t{asked.start} + *size, asked.size);
}

int make(Call& call, const Asked& asked, const Given& given, cdprep_window** to) {
    if (const int code = check_memory(call, given, asked.size, asked.options.allocator))
        return code;
    OwnedMemory own;
    std::byte* block = nullptr;
    if (const int code = take_memory(call, given, asked.size, asked.allocator, own, block)) {
        return code;
    }
    Result<Window> made =
        Window::in({block + asked.start, asked.size - asked.start}, {asked.options.max_leaves});
    if (!made) return call.fail(CDPREP_INTERNAL, made.error().message);
    *to = new (block) cdprep_window(std::move(made).value(), own.take());
    return CDPREP_OK;
}

/// Numbers of the C API are finite.
double finite(double number) noexcept {
    return std::clamp(number, -format::kMaxCoordinate, format::kMaxCoordinate);
}

/// Finds the window whose model is A. Refuses any other A, and a window that is being filled.
int find_window(Call& call, const cdprep_pair& pair, const cdprep_window** window) noexcept {
    *window = pair.a->window;
    if (*window != nullptr) return check_free(call, Name{"pair"}.of("a"), (*window)->in_use);
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, Name{"pair"}.of("a"),
                       "is not the model of a window.");
}

int check_other(Call& call, const cdprep_window& window, const AskedPair& asked) noexcept {
    for (const auto& [model, field] : {std::pair{asked.a, "a"}, std::pair{asked.b, "b"}}) {
        if (model != &window.model.model) continue;
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, Name{"pair"}.of(field),
                           "is the model of the window itself.");
    }
    return CDPREP_OK;
}

}  // namespace

const InputType Input<cdprep_window_options>::type = {"cdprep_window_options", 0xcd500015U,
                                                      sizeof(cdprep_window_options),
                                                      sizeof(cdprep_window_options), kFields};

}  // namespace cdprep::c

using cdprep::c::AskedPair;
using cdprep::c::Call;
using cdprep::c::guarded;

void cdprep_window_options_init(cdprep_window_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_window_size(const cdprep_window_options* options, size_t* size, cdprep_error* error) {
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

int cdprep_window_make(const cdprep_window_options* options, void* memory, size_t size,
                       cdprep_window** window, cdprep_error* error) {
    if (window != nullptr) *window = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(options, {"options"})) return code;
        if (const int code = call.need(window, {"window"})) return code;
        cdprep::c::Asked asked;
        if (const int code = cdprep::c::read(call, options, asked)) return code;
        return cdprep::c::make(call, asked, {memory, size}, window);
    });
}

void cdprep_window_end(cdprep_window* window) {
    if (window == nullptr || window->in_use.exchange(true)) return;
    const cdprep::c::Memory memory = window->memory;
    std::destroy_at(window);
    release(memory);
}

const cdprep_model* cdprep_window_model(const cdprep_window* window) {
    return window == nullptr ? nullptr : &window->model;
}

int cdprep_window_fill(cdprep_window* window, const cdprep_pair* pair, double radius,
                       cdprep_window_info* info, cdprep_error* error) {
    if (info != nullptr) *info = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(window, {"window"})) return code;
        if (const int code = call.need(pair, {"pair"})) return code;
        if (const int code = call.need(info, {"info"})) return code;
        if (const int code = check_number(call, "radius", cdprep::c::Holds::limit, radius)) {
            return code;
        }
        AskedPair asked;
        if (const int code = read_pair(call, {"pair"}, cdprep::c::kBoundedDistance, pair, asked)) {
            return code;
        }
        if (const int code = cdprep::c::check_other(call, *window, asked)) return code;
        cdprep::c::InUse use;
        if (const int code = use.begin(call, {"window"}, window->in_use)) return code;
        const cdprep::WindowFill held = window->window.fill(asked.pair(), radius);
        const cdprep::format::FloatEnvironment environment;
        info->radius = held.radius < 0 ? 0 : cdprep::c::finite(held.radius);
        info->leaves = held.leaves;
        info->is_empty = cdprep::c::word(held.radius < 0);
        return CDPREP_OK;
    });
}

int cdprep_window_margin(const cdprep_pair* pair, double* margin, cdprep_error* error) {
    if (margin != nullptr) *margin = 0;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(pair, {"pair"})) return code;
        if (const int code = call.need(margin, {"margin"})) return code;
        AskedPair asked;
        if (const int code = read_pair(call, {"pair"}, cdprep::c::kBoundedDistance, pair, asked)) {
            return code;
        }
        const cdprep_window* window = nullptr;
        if (const int code = cdprep::c::find_window(call, *pair, &window)) return code;
        const cdprep::format::FloatEnvironment environment;
        *margin = cdprep::c::finite(window->window.margin(*asked.b, asked.placement));
        return CDPREP_OK;
    });
}

int cdprep_window_distance(const cdprep_pair* pair, const cdprep_distance_options* options,
                           uint64_t work, cdprep_workspace* workspace, cdprep_bounded* bounded,
                           cdprep_error* error) {
    cdprep_distance_options given{};
    return ask_pair(
        cdprep::c::kBoundedDistance, pair, workspace, bounded, "bounded", error,
        [&](Call& call) { return cdprep::c::read_distance_options(call, options, given); },
        [&](Call& call, const AskedPair& asked, cdprep::Workspace& scratch) -> int {
            const cdprep_window* window = nullptr;
            if (const int code = cdprep::c::find_window(call, *pair, &window)) return code;
            cdprep::c::PairCacheWords cache(asked.cache);
            *bounded = cdprep::c::in_c(window->window.distance(
                asked.with(cache), scratch, cdprep::c::in_cpp(given), {.work = work}));
            return CDPREP_OK;
        });
}
