// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"

namespace cdprep {

/// A closed, axis-aligned box. All boxes of a broad phase are in the same coordinates; those of a
/// scene are relative to Plan::origin(). A box may be flat or a point. If lower > upper along an
/// axis, the box is absent: it forms no pair. In all other boxes, infinite numbers count as the
/// largest finite ones.
struct WorldBox {
    float lower[3];
    float upper[3];
};

/// The boxes with which a box may form pairs. Two boxes form a pair only if each accepts a layer of
/// the other. Layers are bits.
struct BoxFilter {
    std::uint32_t layers = 1;
    std::uint32_t accepts = ~std::uint32_t{0};

    [[nodiscard]] bool allows(const BoxFilter& other) const noexcept {
        return (layers & other.accepts) != 0 && (other.layers & accepts) != 0;
    }
    bool operator==(const BoxFilter&) const = default;
};

/// Two boxes that meet: a < b.
struct BoxPair {
    std::uint32_t a;
    std::uint32_t b;
    auto operator<=>(const BoxPair&) const = default;
};

/// The maximum number of boxes of a broad phase, and of objects of a scene.
inline constexpr std::uint32_t kMostWorldBoxes = std::uint32_t{1} << 29;

struct BroadPhaseLimits {
    std::uint32_t boxes;  ///< at most kMostWorldBoxes
    /// The maximum number of pairs of boxes that meet. If boxes move little, updates are faster
    /// with a limit of twice the number of pairs that meet.
    std::uint32_t pairs;
    std::uint32_t threads = 1;  ///< the maximum number of tasks at once; at least one
};

/// The result of BroadPhase::update().
struct BroadPhaseUpdate {
    /// All pairs of boxes that meet, sorted. They stay valid until the next update that is not
    /// refused.
    std::span<const BoxPair> pairs = {};
    bool complete = true;      ///< false: `pairs` is empty; see `needed` and `refused`
    std::uint64_t needed = 0;  ///< a sufficient limits.pairs, if there are too many pairs
    /// The first box with a NaN, in the order of `moved` if given. An update with such a box
    /// changes nothing.
    std::optional<std::uint32_t> refused = std::nullopt;
    /// Boxes that left the larger box around them, or whose filter has changed.
    std::uint32_t escaped = 0;
    bool kept = false;  ///< pairs of larger boxes are kept for the next update
};

/// Finds the pairs of boxes that meet, as boxes move. Touching counts.
///
/// Each box gets a larger box around it. Pairs of larger boxes that meet are kept from update to
/// update. Only a box that leaves its larger box needs a search for new pairs. The search uses a
/// tree with eight boxes per node, in the order of the Z-order curve (Morton 1966). If many boxes
/// leave, all pairs are searched for anew. The next updates use no larger boxes if many boxes leave
/// in two updates in a row. The same holds if limits.pairs is too small for the pairs of larger
/// boxes. The answer does not depend on the kind of search, or on the threads.
///
/// An update takes O(n + pairs) time if few boxes leave. Otherwise, it takes O(n log n + pairs) for
/// boxes of similar size that are spread out. If all boxes meet, every pair is tested.
/// tests/bench/broad_phase_bench measures both beside other libraries.
///
///     cdprep::BroadPhase broad_phase({.boxes = 1000, .pairs = 16000});
///     const auto update = broad_phase.update(boxes);
///     for (const cdprep::BoxPair& pair : update.pairs) ...
class BroadPhase {
public:
    /// Allocates memory once; updates never allocate. Stops the program if the limits are invalid.
    CDPREP_API explicit BroadPhase(const BroadPhaseLimits& limits);

    /// Makes a broad phase in the caller's memory, which must outlive it. Allocates nothing.
    /// Returns nothing if the memory is smaller than size() or not aligned to alignment(), or the
    /// limits are invalid.
    [[nodiscard]] CDPREP_API static std::optional<BroadPhase> in_memory(
        std::span<std::byte> memory, const BroadPhaseLimits& limits) noexcept;
    /// Returns the size in bytes: about 165 for each box, 24 for each pair and 4 KiB for each
    /// thread. Each thread but the first adds 4 for each box. If std::size_t has 32 bits and the
    /// size does not fit, returns a number of bytes that no memory has.
    [[nodiscard]] CDPREP_API static std::size_t size(const BroadPhaseLimits& limits) noexcept;
    [[nodiscard]] CDPREP_API static std::size_t alignment() noexcept;  ///< bytes, a power of two

    CDPREP_API BroadPhase(BroadPhase&&) noexcept;
    CDPREP_API BroadPhase& operator=(BroadPhase&&) noexcept;
    CDPREP_API ~BroadPhase();

    /// Returns the pairs of boxes that meet. Any box may have moved since the last update. There
    /// must be at most limits.boxes boxes, and one filter for each box or no filters. Otherwise the
    /// program stops. Without filters, all boxes may form pairs. Calls `parallel_for` at most
    /// twice, each time for at most limits.threads tasks.
    [[nodiscard]] CDPREP_API BroadPhaseUpdate
    update(std::span<const WorldBox> boxes, std::span<const BoxFilter> filters = {},
           ParallelFor parallel_for = serial_for) noexcept;

    /// Does the same as update(), if only the boxes numbered in `moved`, or their filters, have
    /// changed. There must be as many boxes as in the last update, and `moved` must hold numbers of
    /// boxes. Otherwise the program stops. `moved` may be in any order, and may repeat numbers.
    /// This takes less time if few boxes move.
    [[nodiscard]] CDPREP_API BroadPhaseUpdate update_moved(
        std::span<const WorldBox> boxes, std::span<const BoxFilter> filters,
        std::span<const std::uint32_t> moved, ParallelFor parallel_for = serial_for) noexcept;

private:
    struct State;
    /// Frees memory that was allocated, and does not touch the caller's.
    struct Release {
        bool owns;
        void operator()(State* state) const noexcept;
    };
    explicit BroadPhase(std::unique_ptr<State, Release> state) noexcept;
    static State* make(std::byte* memory, const BroadPhaseLimits& limits) noexcept;

    std::unique_ptr<State, Release> state_;
};

}  // namespace cdprep
