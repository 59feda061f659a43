// SPDX-License-Identifier: MIT
#include "cdprep/workspace.h"

#include <cstdint>
#include <new>
#include <utility>

#include "walk/workspace_storage.h"

namespace cdprep {

void Workspace::Release::operator()(Storage* storage) const noexcept {
    if (owns) delete storage;
}

Workspace::Workspace() : storage_(new Storage, Release{true}) {}
Workspace::Workspace(std::unique_ptr<Storage, Release> storage) noexcept
    : storage_(std::move(storage)) {}
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;

void Workspace::count_into(QueryCounts* counts) noexcept {
    storage_->counts = counts;
}

std::size_t Workspace::size() noexcept {
    return sizeof(Storage);
}

std::size_t Workspace::alignment() noexcept {
    return alignof(Storage);
}

std::optional<Workspace> Workspace::in_memory(std::span<std::byte> memory) noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    if (memory.size() < size() || address % alignment() != 0) return std::nullopt;
    return Workspace(
        std::unique_ptr<Storage, Release>(new (memory.data()) Storage, Release{false}));
}

}  // namespace cdprep
