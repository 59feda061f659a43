// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>

namespace cdprep::write {

/// The bytes of a file that is mostly unwritten. Only written pages take memory; all others read
/// as zeros.
class SparseMemory {
public:
    [[nodiscard]] std::uint64_t size() const noexcept {
        return size_;
    }
    /// Changes the size. Bytes beyond it are discarded.
    void resize(std::uint64_t size);

    /// Writes bytes. The size grows as needed.
    void write(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Reads bytes. Those beyond the end are zeros.
    void read(std::uint64_t offset, std::span<std::byte> bytes) const;

private:
    static constexpr std::uint64_t kPageSize = 4096;
    using Page = std::array<std::byte, kPageSize>;

    std::map<std::uint64_t, Page> pages_;  ///< the written pages, by number
    std::uint64_t size_ = 0;
};

}  // namespace cdprep::write
