// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "cdprep/cdprep.h"
#include "cdprep/collide.h"
#include "cdprep/containment.h"
#include "cdprep/distance.h"
#include "cdprep/model.h"
#include "cdprep/overlapping_triangles.h"
#include "cdprep/pair_cache.h"
#include "cdprep/placement.h"
#include "cdprep/pose.h"
#include "cdprep/result.h"
#include "cdprep/workspace.h"

// What the parts of the C face share: how they check arguments, fill errors, and turn
// structs of cdprep.h into ours and back. The parts are c_model.cpp, c_workspace.cpp,
// c_pairs.cpp, c_hulls.cpp, c_contacts.cpp, c_rays.cpp, c_shapes.cpp and c_batch.cpp.

struct cdprep_model {
    cdprep::Model model;
};

struct cdprep_workspace {
    cdprep::Workspace workspace;
};

struct cdprep_workspaces {
    std::span<cdprep::Workspace> all;
};

namespace cdprep {

/// Fills `error`, which may be null, and returns the code. A long message is cut.
int fail(cdprep_error* error, int code, std::string_view message) noexcept;
int fail(cdprep_error* error, const Error& why) noexcept;

int null_argument(cdprep_error* error) noexcept;
int bad_size(cdprep_error* error) noexcept;

template <class... Pointers>
bool any_null(Pointers... pointers) noexcept {
    return ((pointers == nullptr) || ...);
}

/// Runs `ask`, which returns a code, and lets no exception out.
template <class Ask>
int guarded(cdprep_error* error, Ask ask) noexcept {
    try {
        return ask();
    } catch (const std::bad_alloc&) {
        return fail(error, CDPREP_OVER_BUDGET, "There is not enough memory.");
    } catch (const std::exception& thrown) {
        return fail(error, CDPREP_INTERNAL, thrown.what());
    } catch (...) {
        return fail(error, CDPREP_INTERNAL, "An unknown exception was thrown.");
    }
}

/// Copies as much of a sized struct as its maker knew; the rest stays at default.
/// False when the size is not set.
template <class Options>
bool read_sized(const Options* from, Options& to) noexcept {
    if (from == nullptr) return true;
    if (from->size < sizeof from->size) return false;
    const std::uint32_t size = std::min<std::uint32_t>(from->size, sizeof to);
    std::memcpy(&to, from, size);
    return true;
}

Double3 point_of(const double* numbers) noexcept;
void store(const Double3& p, double* numbers) noexcept;
int word(Answer answer) noexcept;

Result<Pose> pose_of(const cdprep_pose& pose);

/// Reads the placement, or returns a code with `error` filled.
int read_placement(const cdprep_placement& given, std::optional<Placement>& placement,
                   cdprep_error* error);

CollideOptions contact_options(const cdprep_contact_options& given) noexcept;
OverlapOptions overlap_options(const cdprep_contact_options& given) noexcept;
DistanceOptions distance_options(const cdprep_distance_options& given) noexcept;
cdprep_distance_options default_distance_options() noexcept;

void store(const Collision& found, cdprep_collision& to) noexcept;
void store(const std::optional<Distance>& result, int& found, cdprep_distance& to) noexcept;

/// The caller's room for pairs, as the C++ questions take it.
std::span<TrianglePair> room_of(cdprep_triangle_pair* pairs, std::size_t room) noexcept;

/// A question about two models: checks what every such question checks, then asks.
template <class Ask>
int ask_pair(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
             cdprep_workspace* workspace, cdprep_error* error, Ask ask) noexcept {
    if (any_null(a, b, placement, workspace)) return null_argument(error);
    return guarded(error, [&]() -> int {
        std::optional<Placement> placed;
        if (const int code = read_placement(*placement, placed, error)) return code;
        return ask(a->model, b->model, *placed, workspace->workspace);
    });
}

/// Where the C++ questions keep their cache, from and back to the C struct.
template <class Outer, class Inner>
class CacheCopy {
public:
    explicit CacheCopy(Outer* cache) noexcept : outer_(cache) {
        static_assert(sizeof(Outer) == sizeof(Inner) && std::is_trivially_copyable_v<Inner>);
        if (cache != nullptr) std::memcpy(static_cast<void*>(&inner_), cache, sizeof inner_);
    }
    CacheCopy(const CacheCopy&) = delete;
    CacheCopy& operator=(const CacheCopy&) = delete;
    ~CacheCopy() {
        if (outer_ != nullptr) std::memcpy(outer_, &inner_, sizeof inner_);
    }
    [[nodiscard]] Inner* get() noexcept {
        return outer_ == nullptr ? nullptr : &inner_;
    }

private:
    Outer* outer_;
    Inner inner_;
};

using PairCacheCopy = CacheCopy<cdprep_pair_cache, PairCache>;

}  // namespace cdprep
