// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace cdprep {

struct CellSearches;
struct QueryCounts;

/// Scratch memory for queries, owned by the caller: queries never allocate.
///
/// One workspace serves any number of models and questions, one at a time; each thread needs its
/// own. It allocates about SIZE KiB once, when it is made.
class Workspace {
public:
    /// Serves every question but those through octrees and tetra-trees.
    Workspace();

    /// Serves those too, and takes CELLS KiB more. `cells` is cells() of <cdprep/cells.h>.
    ///
    ///     cdprep::Workspace workspace(cdprep::cells());
    explicit Workspace(const CellSearches& cells);

    /// Makes a workspace in the caller's memory, which outlives it. Allocates nothing. Returns
    /// nothing if the memory is smaller than size() or not aligned to alignment(). Null cells:
    /// as Workspace().
    [[nodiscard]] static std::optional<Workspace> in_memory(
        std::span<std::byte> memory, const CellSearches* cells = nullptr) noexcept;
    [[nodiscard]] static std::size_t size(const CellSearches* cells = nullptr) noexcept;  ///< bytes
    [[nodiscard]] static std::size_t alignment() noexcept;  ///< bytes, a power of two

    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

    /// Adds the work of the following queries with this workspace to `*counts` (query_counts.h);
    /// null stops that. Costs 0.2 % of the instructions of a query when it is off.
    void count_into(QueryCounts* counts) noexcept;

    struct Storage;  ///< private to the library
    [[nodiscard]] Storage& storage() noexcept {
        return *storage_;
    }

private:
    /// Frees what was allocated and leaves the caller's memory alone.
    struct Release {
        bool owns;
        void operator()(Storage* storage) const noexcept;
    };
    explicit Workspace(std::unique_ptr<Storage, Release> storage) noexcept;

    std::unique_ptr<Storage, Release> storage_;
};

}  // namespace cdprep
