// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/sparse_memory.h"

#include <algorithm>

namespace cdprep::write {

void SparseMemory::resize(std::uint64_t size) {
    if (size < size_) {
        const std::uint64_t kept = size % kPageSize;
        const auto last = pages_.find(size / kPageSize);
        if (last != pages_.end()) {
            std::fill(last->second.begin() + static_cast<std::ptrdiff_t>(kept), last->second.end(),
                      std::byte{0});
        }
        pages_.erase(pages_.upper_bound(size / kPageSize), pages_.end());
    }
    size_ = size;
}

void SparseMemory::write(std::uint64_t offset, std::span<const std::byte> bytes) {
    size_ = std::max(size_, offset + bytes.size());
    while (!bytes.empty()) {
        const std::uint64_t within = offset % kPageSize;
        const auto count =
            static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), kPageSize - within));
        Page& page = pages_[offset / kPageSize];
        std::copy_n(bytes.begin(), count, page.begin() + static_cast<std::ptrdiff_t>(within));
        bytes = bytes.subspan(count);
        offset += count;
    }
}

void SparseMemory::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const std::uint64_t within = offset % kPageSize;
        const auto count =
            static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), kPageSize - within));
        const auto page = pages_.find(offset / kPageSize);
        if (page == pages_.end()) {
            std::fill_n(bytes.begin(), count, std::byte{0});
        } else {
            std::copy_n(page->second.begin() + static_cast<std::ptrdiff_t>(within), count,
                        bytes.begin());
        }
        bytes = bytes.subspan(count);
        offset += count;
    }
}

}  // namespace cdprep::write
