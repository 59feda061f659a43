// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"
#include "import/source_file.h"

namespace cdprep::scenes {

/// Two samples of a stream, and the share of the second one.
struct SamplePair {
    std::size_t first = 0;
    std::size_t second = 0;
    double share = 0;  ///< at least 0, below 1

    bool operator==(const SamplePair&) const = default;
};

/// Returns the samples of a time, at least 0. Sample i is that of the time i * step_s. With
/// `repeats`, sample 0 follows the last one. Otherwise the last one stays.
[[nodiscard]] SamplePair samples_at(double time_s, double step_s, bool repeats,
                                    std::size_t samples) noexcept;

/// A Point Cache 2 file (PC2), mapped: the positions of points in some samples.
///
/// The file has 32 bytes, then x, y and z as floats for each point of each sample. The 32 bytes
/// begin with "POINTCACHE2" and a zero. Then come the version 1 and the number of points. The start
/// frame and the frames per sample follow; both are floats and not used. The last is the number of
/// samples. The other numbers are int32. All is little-endian.
class PointCache {
public:
    /// Opens a file and checks every byte that is used. Fails with `unreadable` for a file of
    /// another form. The sentence names the file, the place, the number found and those allowed.
    [[nodiscard]] static Result<PointCache> open(const std::filesystem::path& path);
    [[nodiscard]] static Result<PointCache> parse(import::SourceFile file);

    [[nodiscard]] const std::string& name() const noexcept {
        return file_.name();
    }
    [[nodiscard]] std::size_t points() const noexcept {
        return points_;
    }
    [[nodiscard]] std::size_t samples() const noexcept {
        return samples_;
    }
    /// Returns the place of a point between two samples.
    [[nodiscard]] format::Double3 at(const SamplePair& pair, std::size_t point) const noexcept;

private:
    explicit PointCache(import::SourceFile file) : file_(std::move(file)) {}
    [[nodiscard]] Result<Done> read_header();
    [[nodiscard]] Result<Done> check_numbers() const;
    [[nodiscard]] std::uint32_t word(std::size_t byte) const noexcept;
    [[nodiscard]] float coordinate(std::size_t sample, std::size_t point,
                                   std::size_t axis) const noexcept;

    import::SourceFile file_;
    std::size_t points_ = 0;
    std::size_t samples_ = 0;
};

}  // namespace cdprep::scenes
