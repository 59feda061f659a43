// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <array>
#include <iterator>

namespace cdprep {

static_assert(sizeof(cdprep_triangle_pair) == sizeof(TrianglePair) &&
              offsetof(cdprep_triangle_pair, b) == offsetof(TrianglePair, b));
static_assert(CDPREP_BAD_ARGUMENT == static_cast<int>(ErrorCode::bad_argument) &&
              CDPREP_UNREADABLE == static_cast<int>(ErrorCode::unreadable) &&
              CDPREP_OVER_BUDGET == static_cast<int>(ErrorCode::over_budget) &&
              CDPREP_INTERNAL == static_cast<int>(ErrorCode::internal));

int fail(cdprep_error* error, int code, std::string_view message) noexcept {
    if (error == nullptr) return code;
    error->code = code;
    const std::size_t length = std::min(message.size(), sizeof error->message - 1);
    std::memcpy(error->message, message.data(), length);
    error->message[length] = 0;
    return code;
}

int fail(cdprep_error* error, const Error& why) noexcept {
    return fail(error, static_cast<int>(why.code), why.message);
}

int null_argument(cdprep_error* error) noexcept {
    return fail(error, CDPREP_BAD_ARGUMENT, "An argument is null that must not be.");
}

int bad_size(cdprep_error* error) noexcept {
    return fail(error, CDPREP_BAD_ARGUMENT, "The size of a struct is not set; it must be sizeof.");
}

Double3 point_of(const double* numbers) noexcept {
    return {numbers[0], numbers[1], numbers[2]};
}

void store(const Double3& p, double* numbers) noexcept {
    numbers[0] = p.x;
    numbers[1] = p.y;
    numbers[2] = p.z;
}

int word(Answer answer) noexcept {
    switch (answer) {
        case Answer::no:
            return CDPREP_NO;
        case Answer::yes:
            return CDPREP_YES;
        default:
            return CDPREP_UNKNOWN;
    }
}

Result<Pose> pose_of(const cdprep_pose& pose) {
    std::array<double, 12> rows{};
    std::copy(std::begin(pose.rows), std::end(pose.rows), rows.begin());
    return Pose::from_rows(rows);
}

int read_placement(const cdprep_placement& given, std::optional<Placement>& placement,
                   cdprep_error* error) {
    if (given.size < sizeof given) return bad_size(error);
    const bool reads_a = given.kind != CDPREP_B_MOVES;
    const bool reads_b = given.kind != CDPREP_A_MOVES;
    const Result<Pose> a = reads_a ? pose_of(given.a) : Result<Pose>(Pose());
    if (!a) return fail(error, a.error());
    const Result<Pose> b = reads_b ? pose_of(given.b) : Result<Pose>(Pose());
    if (!b) return fail(error, b.error());
    switch (given.kind) {
        case CDPREP_B_MOVES:
            placement = Placement::b_moves(b.value());
            return CDPREP_OK;
        case CDPREP_A_MOVES:
            placement = Placement::a_moves(a.value());
            return CDPREP_OK;
        case CDPREP_RELATIVE:
            placement = Placement::relative(a.value(), b.value());
            return CDPREP_OK;
        case CDPREP_WORLD:
            placement = Placement::world(a.value(), b.value());
            return CDPREP_OK;
        default:
            return fail(error, CDPREP_BAD_ARGUMENT, "The kind of a placement is not 0 to 3.");
    }
}

CollideOptions contact_options(const cdprep_contact_options& given) noexcept {
    CollideOptions options;
    if (given.as == CDPREP_SOLID) options.as = As::solid;
    if (given.contact == CDPREP_PROPER) options.contact = Contact::proper;
    if (given.degenerate == CDPREP_SKIP_DEGENERATE) options.degenerate = Degenerate::skip;
    return options;
}

OverlapOptions overlap_options(const cdprep_contact_options& given) noexcept {
    const CollideOptions options = contact_options(given);
    return {options.contact, options.degenerate};
}

DistanceOptions distance_options(const cdprep_distance_options& given) noexcept {
    return {.relative_error = given.relative_error,
            .absolute_error = given.absolute_error,
            .max_distance = given.max_distance,
            .as = given.as == CDPREP_SOLID ? As::solid : As::surface};
}

cdprep_distance_options default_distance_options() noexcept {
    const DistanceOptions defaults;
    return {sizeof(cdprep_distance_options), CDPREP_SURFACE, defaults.relative_error,
            defaults.absolute_error, defaults.max_distance};
}

void store(const Collision& found, cdprep_collision& to) noexcept {
    to = {found.hit ? 1 : 0, word(found.containment.answer), found.containment.a_inside_b ? 1 : 0,
          found.containment.winding};
}

void store(const std::optional<Distance>& result, int& found, cdprep_distance& to) noexcept {
    found = result ? 1 : 0;
    to = {};
    if (!result) return;
    to.lower = result->lower;
    to.upper = result->upper;
    store(result->witness_a, to.witness_a);
    store(result->witness_b, to.witness_b);
    to.triangle_a = result->triangle_a;
    to.triangle_b = result->triangle_b;
}

std::span<TrianglePair> room_of(cdprep_triangle_pair* pairs, std::size_t room) noexcept {
    return {reinterpret_cast<TrianglePair*>(pairs), room};
}

}  // namespace cdprep
