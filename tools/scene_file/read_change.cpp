// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/read_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>

#include "cdprep/format/limits.h"
#include "cli/output_path.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;

const std::array<std::string, 3> kAxisWords = {"x", "y", "z"};

/// Reads a member that must be there.
double read_number(const JsonElement& parent, const char* key, Range range, double otherwise) {
    const auto member = parent.require(key);
    return member ? member->number(range).value_or(otherwise) : otherwise;
}

std::optional<std::uint32_t> read_axis(const JsonElement& parent, const char* key) {
    const auto member = parent.require(key);
    const auto number = member ? member->one_of(kAxisWords, "an axis") : std::nullopt;
    if (!number) return std::nullopt;
    return static_cast<std::uint32_t>(*number);
}

Shear read_shear(const JsonElement& element) {
    Shear shear;
    if (!element.is_object_of({"of", "along", "rate_per_s", "amplitude", "period_s"})) return shear;
    const auto of = read_axis(element, "of"), along = read_axis(element, "along");
    if (of && along && of == along) {
        element.refuse("of and along are both " + kAxisWords[*of] + "; they must differ.");
    }
    shear.of = of.value_or(shear.of);
    shear.along = along.value_or(shear.along);
    const auto rate = element.find("rate_per_s");
    const bool is_periodic = element.find("amplitude") || element.find("period_s");
    if (rate.has_value() == is_periodic) {
        element.refuse("a shear has either a rate_per_s, or an amplitude and a period_s.");
        return shear;
    }
    if (rate) {
        shear.rate_per_s = rate->number(Range::any).value_or(0);
    } else {
        shear.amplitude = read_number(element, "amplitude", Range::any, 0);
        shear.period_s = read_number(element, "period_s", Range::above_zero, 1);
    }
    return shear;
}

Twist read_twist(const JsonElement& element) {
    Twist twist;
    if (!element.is_object_of({"axis", "angle_rad", "period_s"})) return twist;
    twist.axis = read_axis(element, "axis").value_or(twist.axis);
    twist.angle_rad = read_number(element, "angle_rad", Range::any, 0);
    twist.period_s = read_number(element, "period_s", Range::above_zero, 1);
    return twist;
}

Stream read_stream(const JsonElement& element, const fs::path& folder) {
    Stream stream;
    if (!element.is_object_of({"file", "step_s", "repeats"})) return stream;
    const auto file = element.require("file");
    if (const auto text = file ? file->text() : std::nullopt) {
        stream.file = cli::shortened(folder / *text);
        std::error_code unknown;
        if (!fs::is_regular_file(stream.file, unknown)) {
            file->refuse("there is no file " + stream.file.string() + ".");
        }
    }
    stream.step_s = read_number(element, "step_s", Range::above_zero, 1);
    if (const auto repeats = element.find("repeats")) {
        stream.repeats = repeats->boolean().value_or(false);
    }
    return stream;
}

std::optional<Deform> read_deform(const JsonElement& element, const fs::path& folder) {
    if (!element.is_object_of({"shear", "twist", "stream"})) return std::nullopt;
    const auto shear = element.find("shear"), twist = element.find("twist"),
               stream = element.find("stream");
    if (int{shear.has_value()} + int{twist.has_value()} + int{stream.has_value()} != 1) {
        element.refuse("a deform has exactly one of shear, twist and stream.");
        return std::nullopt;
    }
    if (shear) return read_shear(*shear);
    if (twist) return read_twist(*twist);
    return read_stream(*stream, folder);
}

std::array<double, 3> read_vector(const JsonElement& parent, const char* key) {
    std::array<double, 3> vector{};
    const auto member = parent.require(key);
    const auto numbers = member ? member->numbers(3) : std::nullopt;
    if (numbers) std::copy_n(numbers->begin(), 3, vector.begin());
    return vector;
}

void read_plane(const JsonElement& element, Tear& tear) {
    if (!element.is_object_of({"point", "normal"})) return;
    tear.point = read_vector(element, "point");
    tear.normal = read_vector(element, "normal");
    for (const double number : tear.point) {
        if (std::abs(number) <= format::kMaxCoordinate) continue;
        element.find("point")->refuse_value("coordinates of at most 2^1000");
        break;
    }
    const auto normal = element.find("normal");
    if (normal && tear.normal == std::array<double, 3>{}) {
        normal->refuse_value("a vector with a direction");
    }
}

Tear read_tear(const JsonElement& element) {
    Tear tear;
    if (!element.is_object_of({"plane", "time_s", "opening"})) return tear;
    if (const auto plane = element.require("plane")) read_plane(*plane, tear);
    tear.time_s = read_number(element, "time_s", Range::any, 0);
    if (const auto opening = element.find("opening")) {
        tear.opening = opening->number(Range::zero_or_more).value_or(0);
    }
    return tear;
}

}  // namespace

std::optional<Change> read_change(const JsonElement& motion, const fs::path& folder) {
    const auto deform = motion.find("deform"), tear = motion.find("tear");
    if (!deform && !tear) return std::nullopt;
    Change change;
    if (deform) change.deform = read_deform(*deform, folder);
    if (tear) change.tear = read_tear(*tear);
    return change;
}

}  // namespace cdprep::scenes
