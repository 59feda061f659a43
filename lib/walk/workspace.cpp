// SPDX-License-Identifier: MIT
#include "cdprep/workspace.h"

#include <cassert>
#include <cstdint>
#include <new>
#include <utility>

#include "core/require.h"
#include "walk/cell_searches.h"
#include "walk/workspace_storage.h"

namespace cdprep {
namespace {

// The memory of the cell searches follows the storage.
constexpr std::size_t kAlignment = alignof(Workspace::Storage);

constexpr std::size_t aligned(std::size_t size) noexcept {
    return (size + kAlignment - 1) / kAlignment * kAlignment;
}

Workspace::Storage* make_in(std::byte* memory, const CellSearches* cells) noexcept {
    auto* const storage = new (memory) Workspace::Storage;
    if (cells == nullptr) return storage;
    assert(kAlignment % cells->alignment == 0);
    storage->cells = cells;
    storage->cell_storage = memory + aligned(sizeof(Workspace::Storage));
    cells->construct(storage->cell_storage);
    return storage;
}

std::byte* allocate(std::size_t size) {
    return static_cast<std::byte*>(::operator new (size, std::align_val_t{kAlignment}));
}

}  // namespace

static_assert(std::is_trivially_destructible_v<Workspace::Storage>);

void Workspace::Release::operator()(Storage* storage) const noexcept {
    if (owns) ::operator delete (storage, std::align_val_t{kAlignment});
}

Workspace::Workspace() : storage_(make_in(allocate(size()), nullptr), Release{true}) {}
Workspace::Workspace(const CellSearches& cells)
    : storage_(make_in(allocate(size(&cells)), &cells), Release{true}) {}
Workspace::Workspace(std::unique_ptr<Storage, Release> storage) noexcept
    : storage_(std::move(storage)) {}
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;

void Workspace::count_into(QueryCounts* counts) noexcept {
    storage_->counts = counts;
}

std::size_t Workspace::size(const CellSearches* cells) noexcept {
    const std::size_t own = aligned(sizeof(Storage));
    return cells == nullptr ? own : own + aligned(cells->size);
}

std::size_t Workspace::alignment() noexcept {
    return kAlignment;
}

std::optional<Workspace> Workspace::in_memory(std::span<std::byte> memory,
                                              const CellSearches* cells) noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    if (memory.size() < size(cells) || address % alignment() != 0) return std::nullopt;
    return Workspace(
        std::unique_ptr<Storage, Release>(make_in(memory.data(), cells), Release{false}));
}

const CellSearches& require_cells(Workspace& workspace) noexcept {
    const CellSearches* cells = workspace.storage().cells;
    if (cells == nullptr) [[unlikely]] {
        stop_with(
            "The workspace cannot search octrees and tetra-trees: link cdprep::cells and create it "
            "as Workspace(cells()).");
    }
    return *cells;
}

}  // namespace cdprep
