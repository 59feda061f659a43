// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "bake/bake_options.h"
#include "bake/bake_report.h"
#include "cdprep/format/file_header.h"
#include "cdprep/result.h"
#include "cli/program_threads.h"

namespace cdprep::cli {

/// Bakes one file: import, repair, weld, examine, arrange, build structures, write. Calls `begins`
/// with the name of each stage as it begins. Fails with the error code of the failed stage, or with
/// `interrupted` if the user stopped the program between two stages.
[[nodiscard]] Result<report::BakeReport> bake(const std::filesystem::path& input,
                                              const std::filesystem::path& output,
                                              const BakeOptions& options, const Threads& threads,
                                              const std::function<void(const char*)>& begins);

/// The bytes of a baked model in memory, as Model::open() takes them.
class BakedImage {
public:
    /// Makes room for this number of bytes.
    explicit BakedImage(std::size_t size)
        : blocks_((size + format::kSectionAlignment - 1) / format::kSectionAlignment),
          size_(size) {}

    [[nodiscard]] std::span<std::byte> bytes() noexcept {
        return std::as_writable_bytes(std::span(blocks_)).first(size_);
    }

private:
    struct alignas(format::kSectionAlignment) Block {
        std::array<std::byte, format::kSectionAlignment> bytes;
    };
    std::vector<Block> blocks_;
    std::size_t size_;
};

/// Does the same as bake(), but writes no file. The sections are those that the file would have.
[[nodiscard]] Result<BakedImage> bake_image(const std::filesystem::path& input,
                                            const BakeOptions& options, const Threads& threads,
                                            const std::function<void(const char*)>& begins);

}  // namespace cdprep::cli
