// SPDX-License-Identifier: MIT
#include "cdprep/sweep.h"

#include <atomic>
#include <memory>
#include <new>

#include "c/c_pairs.h"
#include "c/memory.h"
#include "c/motion_input.h"
#include "cdprep/c/motion.h"

/// A sweep. The object and the memory of the C++ one lie one after the other in one block.
struct cdprep_sweep {
    cdprep::Sweep sweep;
    cdprep::c::Memory memory;  ///< none if it is the caller's
    std::atomic<bool> in_use = false;

    cdprep_sweep(const cdprep::Sweep& made, const cdprep::c::Memory& block)
        : sweep(made), memory(block) {}
};

namespace cdprep::c {
namespace {

constexpr std::size_t kStart = aligned(sizeof(cdprep_sweep));

int check_model(Call& call, const cdprep_model* model) noexcept {
    if (const int code = call.need(model, {"model"})) return code;
    return check_serves(call, {"model"}, *model, Ask::within | Ask::corners);
}

int find_size(Call& call, const cdprep_model& model, std::size_t& size) noexcept {
    return check_size(call, "The sweep", std::uint64_t{kStart} + Sweep::bytes(model.model), size);
}

int make(Call& call, const cdprep_model& model, const cdprep_allocator* allocator,
         const Given& given, cdprep_sweep** to) {
    std::size_t size = 0;
    if (const int code = find_size(call, model, size)) return code;
    cdprep_allocator functions;
    if (const int code = read_allocator(call, {"allocator"}, allocator, functions)) return code;
    if (const int code = check_memory(call, given, size, allocator)) return code;
    OwnedMemory own;
    std::byte* block = nullptr;
    if (const int code = take_memory(call, given, size, functions, own, block)) return code;
    const auto made = Sweep::in({block + kStart, size - kStart}, model.model);
    if (!made) return call.fail(CDPREP_INTERNAL, "The sweep does not fit into its memory.");
    *to = new (block) cdprep_sweep(*made, own.take());
    return CDPREP_OK;
}

/// Checks a query about a sweep, then calls `ask(motion, workspace)`.
template <class Asker>
int ask_sweep(const cdprep_sweep* sweep, const cdprep_model* other, const cdprep_motion* motion,
              cdprep_workspace* workspace, const void* answer, const char* answer_name,
              cdprep_error* error, Asker&& ask) noexcept {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(sweep, {"sweep"})) return code;
        if (const int code = call.need(other, {"other"})) return code;
        if (const int code = call.need(motion, {"motion"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (const int code = call.need(answer, {answer_name})) return code;
        Motion read;
        if (const int code = read_motion(call, kMotionAlone, *motion, read)) return code;
        if (const int code = check_serves(call, {"other"}, *other, Ask::within)) return code;
        if (!sweep->sweep.is_current()) {
            return call.refuse(
                CDPREP_WHY_STALE, {"sweep"},
                "is of a model that has changed since cdprep_sweep_finish_step(), or "
                "its step is not finished.");
        }
        return ask(call, read);
    });
}

}  // namespace
}  // namespace cdprep::c

using cdprep::Motion;
using cdprep::c::ask_sweep;
using cdprep::c::Call;
using cdprep::c::guarded;
using cdprep::c::InUse;

int cdprep_sweep_size(const cdprep_model* model, size_t* size, cdprep_error* error) {
    if (size != nullptr) *size = 0;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::check_model(call, model)) return code;
        if (const int code = call.need(size, {"size"})) return code;
        return cdprep::c::find_size(call, *model, *size);
    });
}

int cdprep_sweep_make(const cdprep_model* model, const cdprep_allocator* allocator, void* memory,
                      size_t size, cdprep_sweep** sweep, cdprep_error* error) {
    if (sweep != nullptr) *sweep = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::check_model(call, model)) return code;
        if (const int code = call.need(sweep, {"sweep"})) return code;
        return cdprep::c::make(call, *model, allocator, {memory, size, {"allocator"}}, sweep);
    });
}

void cdprep_sweep_end(cdprep_sweep* sweep) {
    if (sweep == nullptr || sweep->in_use.exchange(true)) return;
    const cdprep::c::Memory memory = sweep->memory;
    std::destroy_at(sweep);
    release(memory);
}

int cdprep_sweep_start_step(cdprep_sweep* sweep, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(sweep, {"sweep"})) return code;
        InUse use;
        if (const int code = use.begin(call, {"sweep"}, sweep->in_use)) return code;
        sweep->sweep.begin();
        return CDPREP_OK;
    });
}

int cdprep_sweep_finish_step(cdprep_sweep* sweep, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(sweep, {"sweep"})) return code;
        InUse use;
        if (const int code = use.begin(call, {"sweep"}, sweep->in_use)) return code;
        sweep->sweep.end();
        return CDPREP_OK;
    });
}

int cdprep_sweep_may_touch(const cdprep_sweep* sweep, const cdprep_model* other,
                           const cdprep_motion* motion, cdprep_workspace* workspace,
                           uint32_t* may_touch, cdprep_error* error) {
    if (may_touch != nullptr) *may_touch = CDPREP_UNKNOWN;
    return ask_sweep(sweep, other, motion, workspace, may_touch, "may_touch", error,
                     [&](Call& call, const Motion& read) -> int {
                         InUse use;
                         if (const int code = use.begin(call, *workspace)) return code;
                         *may_touch = cdprep::c::word(cdprep::may_touch(sweep->sweep, other->model,
                                                                        read, workspace->lanes[0]));
                         return CDPREP_OK;
                     });
}

int cdprep_sweep_pairs(const cdprep_sweep* sweep, const cdprep_model* other,
                       const cdprep_motion* motion, cdprep_workspace* workspace,
                       cdprep_overlap_list* list, cdprep_error* error) {
    if (list != nullptr) list->count = 0;
    return ask_sweep(sweep, other, motion, workspace, list, "list", error,
                     [&](Call& call, const Motion& read) -> int {
                         if (const int code = cdprep::c::check_list(call, {"list"}, *list))
                             return code;
                         InUse use;
                         if (const int code = use.begin(call, *workspace)) return code;
                         list->count =
                             pairs_that_may_touch(sweep->sweep, other->model, read,
                                                  workspace->lanes[0], cdprep::c::room_of(*list));
                         return CDPREP_OK;
                     });
}
