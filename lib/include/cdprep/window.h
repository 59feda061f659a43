// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "cdprep/bounded_distance.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/result.h"

namespace cdprep {

/// The capacity of a window.
struct WindowLimits {
    /// The maximum number of leaves, which have up to 8 triangles each; at least 1.
    std::uint32_t leaves = 0;
};

/// The content of a window.
struct WindowFill {
    /// The radius, in model units: everything of A at most this far from B is in the window. It is
    /// less than requested if the window is too small. It is negative if not even everything at
    /// distance 0 fits: then the window is empty.
    double radius = -1;
    std::uint32_t leaves = 0;  ///< in the window
};

/// The part of a large model A near a small one, the probe, copied into the caller's memory. A slow
/// loop fills it. A fast loop, such as that of a haptic device at 1 kHz, queries it instead of A.
///
/// model() is a model like any other, with the positions, boxes and triangle numbers of A. The fast
/// loop reads nothing else of A, so A may deform meanwhile. During the fill, everything of A
/// outside the window was farther than WindowFill::radius from the probe. margin() is this radius,
/// minus the largest displacement of a point of the probe since then, relative to A. So everything
/// outside is still farther than margin() from the probe. An answer about anything within margin()
/// is also the answer about A.
///
/// The window counts as unbalanced and torn, because its surface has a rim. It serves collide,
/// overlap, distance, within, ray, closest and touch, for surfaces. A query is complete if nothing
/// farther than margin() from the probe can change its answer. So overlaps() and collide() are
/// complete if margin() >= 0. within() and pairs_within() are complete if margin() is at least the
/// tolerance. Window::distance() reports whether its answer is complete.
///
/// Each fill() copies O(leaves) bytes: 430 for a leaf, or 1,000 if a coordinate of A is not a
/// float. The caller keeps two windows: the slow loop fills one while the fast loop reads the
/// other, as in samples/haptic.cpp. A window must not be read while it is filled.
///
/// Move-only; a move leaves the window's bytes in place. A window that was moved from may only be
/// destroyed or assigned to. Const members, and queries about model(), may run on any number of
/// threads at once.
///
///     auto window = Window::in(memory, {.leaves = 1000});
///     const WindowFill held = window->fill({organ, probe, placement}, 5.0);   // slow loop
///     ...
///     const Pair near{window->model(), probe, now, {}, &cache};               // fast loop
///     const BoundedDistance found = window->distance(near, workspace);
///     if (found.is_complete) ...
class Window {
public:
    /// Returns the number of bytes that in() takes: about 1,100 for each leaf. Fails if in()
    /// rejects `limits`. Allocates as many bytes while it runs.
    [[nodiscard]] CDPREP_API static Result<std::size_t> bytes(const WindowLimits& limits);

    /// Makes an empty window. `memory` must start at a multiple of format::kSectionAlignment and
    /// stay in place while the window lives. Writes all the bytes that it takes, so that no later
    /// fill is the first to touch a page. Allocates. Fails with `bad_argument` if `memory` is too
    /// small or misaligned. Also fails if limits.leaves is 0 or exceeds kMostWindowLeaves.
    [[nodiscard]] CDPREP_API static Result<Window> in(std::span<std::byte> memory,
                                                      const WindowLimits& limits);

    CDPREP_API Window(Window&&) noexcept;
    CDPREP_API Window& operator=(Window&&) noexcept;
    CDPREP_API ~Window();

    /// Fills the window with the leaves of pair.a that may be at most `radius` from pair.b, in
    /// model units. If they do not fit, halves the radius until they do, then bisects four times
    /// between the last two radii. After 20 halvings, it tries the radius 0. An infinite radius
    /// requests all leaves. A negative radius or NaN gives an empty window. pair.a may be baked or
    /// live, or the model of another window. If pair.a or pair.b is model() itself, the program
    /// stops with a message. Of the pair, reads only the models and their placement.
    ///
    /// Needs Ask::distance of both models. Takes O(log n + leaves log m) time for n triangles of A
    /// and m of B. Never allocates.
    CDPREP_API WindowFill fill(const Pair& pair, double radius) noexcept;

    /// Returns what the last fill() returned. Before the first one, the radius is negative.
    [[nodiscard]] CDPREP_API WindowFill filled() const noexcept;

    /// Returns the model to query. It is the same object after each fill().
    [[nodiscard]] CDPREP_API const Model& model() const noexcept;

    /// Returns the distance from the probe within which the window has everything of A, in model
    /// units. It is the radius, minus the largest displacement of a point of the probe's box since
    /// the fill, minus rounding. The displacement of a point is affine in the point, and length is
    /// convex. So the largest displacement is that of a corner of the box. The placements of the
    /// fill and of this call may be of any kind.
    ///
    /// Negative if the probe has moved too far. Minus infinity for another probe, or one that has
    /// deformed since, or if filled().radius is negative. For the probe that filled the window,
    /// infinity if filled().radius is infinite or A was empty. Infinity for an empty probe. Takes
    /// O(1) time.
    [[nodiscard]] CDPREP_API double margin(const Model& probe,
                                           const Placement& placement) const noexcept;

    /// Returns the distance between A and pair.b. A is taken as it was when the window was filled.
    /// Requires that pair.a is model(): otherwise the program stops with a message.
    ///
    /// Complete if bounded_distance() of the window is complete, and the distance or max_distance
    /// is less than margin(). Also complete if triangles touch, but then the answer may name
    /// another touching pair than an answer about A. Apart from that, a complete answer is the
    /// answer about A, bit for bit if no errors are permitted. An incomplete answer has the bounds
    /// of the window, with `lower` at most margin(), or 0 if margin() is negative. Reads the same
    /// options as bounded_distance(), and needs the same Ask. Takes as long as bounded_distance()
    /// of the window. Never allocates.
    [[nodiscard]] CDPREP_API BoundedDistance
    distance(const Pair& pair, Workspace& workspace, const DistanceOptions& options = {},
             const DistanceBudget& budget = {}) const noexcept;

private:
    struct State;
    explicit Window(std::unique_ptr<State> state) noexcept;
    void clear() noexcept;
    std::unique_ptr<State> state_;
};

/// The largest WindowLimits::leaves: each corner of a window's triangles has a number in 32 bits.
inline constexpr std::uint32_t kMostWindowLeaves = format::kMaxVertices / (3 * format::kBvhWidth);

}  // namespace cdprep
