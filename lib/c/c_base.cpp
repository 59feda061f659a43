// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>

#include "c/input.h"
#include "c/pose_input.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/float_environment.h"
#include "kernels/kernels.h"

namespace cdprep::c {
namespace {

static_assert(CDPREP_BAD_ARGUMENT == static_cast<int>(ErrorCode::bad_argument) &&
              CDPREP_UNREADABLE == static_cast<int>(ErrorCode::unreadable) &&
              CDPREP_OVER_BUDGET == static_cast<int>(ErrorCode::over_budget) &&
              CDPREP_INTERNAL == static_cast<int>(ErrorCode::internal));

constexpr std::uint32_t kAbi = 1;

/// Stores a pose, or zeros if it could not be made.
int store(Call& call, const Name& name, std::int32_t why, const Result<Pose>& made,
          cdprep_pose& to) {
    if (!made) return call.refuse_with(why, name, made.error().message);
    to = stored(made.value());
    return CDPREP_OK;
}

/// Makes the pose nearest to a matrix that was read.
int nearest(Call& call, const std::array<double, 16>& matrix, std::uint32_t layout,
            double tolerance, cdprep_pose& pose) {
    if (layout > CDPREP_COLUMNS) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"layout"}, "is %u; it must be 0 or 1.",
                           layout);
    }
    if (const int code = check_numbers(call, {"matrix"}, Holds::number, matrix.data(), 16)) {
        return code;
    }
    if (const int code = check_number(call, "tolerance", Holds::length, tolerance)) return code;
    const format::FloatEnvironment environment;
    if (tolerance > kGreatestPoseTolerance) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"tolerance"},
                           "is %.17g; at most %g is allowed.", tolerance, kGreatestPoseTolerance);
    }
    const auto order = layout == CDPREP_ROWS ? MatrixLayout::rows : MatrixLayout::columns;
    return store(call, {"matrix"}, CDPREP_WHY_NOT_RIGID, nearest_pose(matrix, tolerance, order),
                 pose);
}

/// Reads two poses, and clears the result, which may be one of them.
int read_two(Call& call, const Name& first_name, const cdprep_pose& first, const Name& second_name,
             const cdprep_pose* second, cdprep_pose& result, Pose& a, Pose& b) {
    const cdprep_pose outer = first;
    const cdprep_pose inner = second != nullptr ? *second : cdprep_pose{};
    result = {};
    if (const int code = call.need(second, second_name)) return code;
    if (const int code = read_pose(call, first_name, &outer, a)) return code;
    return read_pose(call, second_name, &inner, b);
}

/// Clears the result, and returns whether all arguments are present.
int begin(Call& call, const void* first, const char* first_name, cdprep_pose* pose,
          const char* pose_name) noexcept {
    if (const int code = call.need(first, {first_name})) {
        if (pose != nullptr) *pose = {};
        return code;
    }
    return call.need(pose, {pose_name});
}

}  // namespace
}  // namespace cdprep::c

using cdprep::Pose;
using cdprep::c::Call;
using cdprep::c::guarded;
using cdprep::c::Holds;

void cdprep_version_get(cdprep_version* version) {
    if (version == nullptr) return;
    *version = {CDPREP_VERSION_MAJOR,
                CDPREP_VERSION_MINOR,
                CDPREP_VERSION_PATCH,
                cdprep::c::kAbi,
                cdprep::format::kVersion,
                cdprep::format::kVersion,
                {}};
    std::snprintf(version->kernels, sizeof version->kernels, "%s", cdprep::kernels::active().name);
}

const char* cdprep_code_name(int code) {
    switch (code) {
        case CDPREP_OK:
            return "CDPREP_OK";
        case CDPREP_BAD_ARGUMENT:
            return "CDPREP_BAD_ARGUMENT";
        case CDPREP_UNREADABLE:
            return "CDPREP_UNREADABLE";
        case CDPREP_OVER_BUDGET:
            return "CDPREP_OVER_BUDGET";
        case CDPREP_INTERNAL:
            return "CDPREP_INTERNAL";
        default:
            return "CDPREP_UNKNOWN_CODE";
    }
}

int cdprep_pose_from_quaternion(const double wxyz[4], const double translation[3],
                                cdprep_pose* pose, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin(call, wxyz, "wxyz", pose, "pose")) return code;
        const std::array<double, 4> q = {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
        *pose = {};
        if (const int code = call.need(translation, {"translation"})) return code;
        const std::array<double, 3> t = {translation[0], translation[1], translation[2]};
        if (const int code = check_numbers(call, {"wxyz"}, Holds::number, q.data(), 4)) return code;
        if (const int code = check_numbers(call, {"translation"}, Holds::number, t.data(), 3)) {
            return code;
        }
        const cdprep::format::FloatEnvironment environment;
        return cdprep::c::store(call, {"wxyz"}, CDPREP_WHY_OUT_OF_RANGE,
                                Pose::from_quaternion(q[0], q[1], q[2], q[3], {t[0], t[1], t[2]}),
                                *pose);
    });
}

int cdprep_pose_nearest(const double matrix[16], uint32_t layout, double tolerance,
                        cdprep_pose* pose, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin(call, matrix, "matrix", pose, "pose")) return code;
        std::array<double, 16> numbers{};
        std::copy(matrix, matrix + 16, numbers.begin());
        *pose = {};
        return cdprep::c::nearest(call, numbers, layout, tolerance, *pose);
    });
}

int cdprep_pose_nearest_f32(const float matrix[16], uint32_t layout, double tolerance,
                            cdprep_pose* pose, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin(call, matrix, "matrix", pose, "pose")) return code;
        const cdprep::format::FloatEnvironment environment;
        std::array<double, 16> numbers{};
        std::copy(matrix, matrix + 16, numbers.begin());
        *pose = {};
        return cdprep::c::nearest(call, numbers, layout, tolerance, *pose);
    });
}

int cdprep_pose_compose(const cdprep_pose* a_from_b, const cdprep_pose* b_from_c,
                        cdprep_pose* a_from_c, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin(call, a_from_b, "a_from_b", a_from_c, "a_from_c")) {
            return code;
        }
        Pose first, second;
        if (const int code = cdprep::c::read_two(call, {"a_from_b"}, *a_from_b, {"b_from_c"},
                                                 b_from_c, *a_from_c, first, second)) {
            return code;
        }
        return cdprep::c::store(call, {"b_from_c"}, CDPREP_WHY_OUT_OF_RANGE,
                                cdprep::composed_pose(first, second), *a_from_c);
    });
}

int cdprep_pose_inverse(const cdprep_pose* a_from_b, cdprep_pose* b_from_a, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin(call, a_from_b, "a_from_b", b_from_a, "b_from_a")) {
            return code;
        }
        const cdprep_pose given = *a_from_b;
        *b_from_a = {};
        Pose pose;
        if (const int code = read_pose(call, {"a_from_b"}, &given, pose)) return code;
        return cdprep::c::store(call, {"a_from_b"}, CDPREP_WHY_OUT_OF_RANGE,
                                cdprep::inverse_pose(pose), *b_from_a);
    });
}

int cdprep_pose_relative(const cdprep_pose* world_from_a, const cdprep_pose* world_from_b,
                         cdprep_pose* a_from_b, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code =
                cdprep::c::begin(call, world_from_a, "world_from_a", a_from_b, "a_from_b")) {
            return code;
        }
        Pose a, b;
        if (const int code = cdprep::c::read_two(call, {"world_from_a"}, *world_from_a,
                                                 {"world_from_b"}, world_from_b, *a_from_b, a, b)) {
            return code;
        }
        const cdprep_pose relative = cdprep::c::stored(cdprep::relative_pose(a, b));
        Pose checked;
        if (const int code = cdprep::c::read_relative(call, {"world_from_b"}, relative, checked)) {
            return code;
        }
        *a_from_b = relative;
        return CDPREP_OK;
    });
}

int cdprep_pose_move(const cdprep_pose* pose, const double* points, size_t count, double* to,
                     cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(pose, {"pose"})) return code;
        Pose read;
        if (const int code = read_pose(call, {"pose"}, pose, read)) return code;
        if (count == 0) return CDPREP_OK;
        if (const int code = call.need(points, {"points"})) return code;
        if (const int code = call.need(to, {"moved"})) return code;
        if (count > PTRDIFF_MAX / (3 * sizeof(double))) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"count"}, "is more than memory holds.");
        }
        if (const int code = check_numbers(call, {"points"}, Holds::number, points, 3 * count)) {
            return code;
        }
        const cdprep::format::FloatEnvironment environment;
        for (size_t i = 0; i < 3 * count; i += 3) {
            const cdprep::Double3 p =
                cdprep::transform_point(read, {points[i], points[i + 1], points[i + 2]});
            to[i] = p.x;
            to[i + 1] = p.y;
            to[i + 2] = p.z;
        }
        return CDPREP_OK;
    });
}
