// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/point_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>

#include "cli/signals.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

constexpr std::string_view kMagic("POINTCACHE2\0", 12);
constexpr std::size_t kHeaderBytes = 32;
constexpr std::size_t kVersionByte = 12;
constexpr std::size_t kPointsByte = 16;
constexpr std::size_t kSamplesByte = 28;
constexpr std::size_t kPointBytes = 12;

Error found_at(const import::SourceFile& file, std::size_t byte, const std::string& found,
               const std::string& expected) {
    return file.unreadable("byte " + std::to_string(byte) + ": found " + found + "; expected " +
                           expected);
}

}  // namespace

SamplePair samples_at(double time_s, double step_s, bool repeats, std::size_t samples) noexcept {
    const auto count = static_cast<double>(samples);
    const double place = (repeats ? std::fmod(time_s, count * step_s) : time_s) / step_s;
    const std::size_t last = samples - 1;
    // A remainder just below the period may be rounded to it.
    if (place >= count) return repeats ? SamplePair{} : SamplePair{last, last, 0};
    const auto first = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(first);
    if (first < last) return {first, first + 1, share};
    return repeats ? SamplePair{last, 0, share} : SamplePair{last, last, 0};
}

Result<PointCache> PointCache::open(const std::filesystem::path& path) {
    Result<import::SourceFile> file =
        import::SourceFile::open(path, std::numeric_limits<std::uint64_t>::max());
    if (!file) return file.error();
    return parse(std::move(file).value());
}

Result<PointCache> PointCache::parse(import::SourceFile file) {
    PointCache cache(std::move(file));
    if (const auto read = cache.read_header(); !read) return read.error();
    if (const auto checked = cache.check_numbers(); !checked) return checked.error();
    return cache;
}

Result<Done> PointCache::read_header() {
    const std::string_view bytes = file_.bytes();
    if (!bytes.starts_with(kMagic)) {
        return found_at(file_, 0,
                        import::quoted_word(bytes.data(), bytes.data() + bytes.size()) +
                            " as the "
                            "first of " +
                            report::counted(bytes.size(), "byte", "bytes"),
                        "'POINTCACHE2' and a zero");
    }
    if (bytes.size() < kHeaderBytes) {
        return file_.unreadable("the file ends at byte " + std::to_string(bytes.size()) +
                                ", within its header of " + std::to_string(kHeaderBytes) +
                                " bytes");
    }
    const auto number = [&](std::size_t byte) { return static_cast<std::int32_t>(word(byte)); };
    if (const auto version = number(kVersionByte); version != 1) {
        return found_at(file_, kVersionByte, "version " + std::to_string(version), "version 1");
    }
    for (const std::size_t byte : {kPointsByte, kSamplesByte}) {
        if (number(byte) >= 1) continue;
        return found_at(
            file_, byte,
            std::to_string(number(byte)) + (byte == kPointsByte ? " points" : " samples"),
            "at least 1");
    }
    points_ = word(kPointsByte);
    samples_ = word(kSamplesByte);
    const std::size_t rest = bytes.size() - kHeaderBytes, each = points_ * kPointBytes;
    if (rest % each == 0 && rest / each == samples_) return Done{};
    return found_at(
        file_, kSamplesByte,
        report::counted(samples_, "sample", "samples") + " of " +
            report::counted(each, "byte", "bytes"),
        "as many as fit in the " + report::counted(rest, "byte", "bytes") + " after the header");
}

Result<Done> PointCache::check_numbers() const {
    for (std::size_t sample = 0; sample < samples_; ++sample) {
        if (cli::is_interrupted()) return Error{ErrorCode::interrupted, name() + ": stopped."};
        for (std::size_t i = 0; i < 3 * points_; ++i) {
            const float found = coordinate(sample, i / 3, i % 3);
            if (std::isfinite(found)) continue;
            return file_.unreadable("sample " + std::to_string(sample) + ": coordinate " +
                                    "xyz"[i % 3] + " of point " + std::to_string(i / 3) + " is " +
                                    (std::isnan(found) ? "not a number" : "infinite") +
                                    "; expected a finite number");
        }
    }
    return Done{};
}

std::uint32_t PointCache::word(std::size_t byte) const noexcept {
    std::uint32_t found = 0;
    for (std::size_t i = 4; i-- > 0;) {
        found = found << 8 | static_cast<unsigned char>(file_.bytes()[byte + i]);
    }
    return found;
}

float PointCache::coordinate(std::size_t sample, std::size_t point,
                             std::size_t axis) const noexcept {
    return std::bit_cast<float>(
        word(kHeaderBytes + (sample * points_ + point) * kPointBytes + 4 * axis));
}

format::Double3 PointCache::at(const SamplePair& pair, std::size_t point) const noexcept {
    std::array<double, 3> found{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from = coordinate(pair.first, point, axis);
        const double to = coordinate(pair.second, point, axis);
        found[axis] = from + pair.share * (to - from);
    }
    return {found[0], found[1], found[2]};
}

}  // namespace cdprep::scenes
