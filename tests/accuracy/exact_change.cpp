// SPDX-License-Identifier: MIT
#include "accuracy/exact_change.h"

#include <cmath>

#include "cdprep/format/limits.h"

namespace cdprep::test {
namespace {

/// The sum, when it is one of doubles that files may hold.
std::optional<double> sum(double a, double b) {
    const double s = a + b;
    if (s - a != b || s - b != a || !(std::fabs(s) <= format::kMaxCoordinate)) return std::nullopt;
    return s;
}

std::vector<ExactChange> turns() {
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    std::vector<ExactChange> all;
    for (std::size_t order = 0; order < kOrders.size(); ++order) {
        for (unsigned signs = 0; signs < 8; ++signs) {
            const bool is_odd_order = order >= 3;
            const bool is_odd_sign = ((signs ^ signs >> 1 ^ signs >> 2) & 1) != 0;
            if (is_odd_order != is_odd_sign) continue;  // a reflection
            ExactChange change;
            change.name = "turn " + std::to_string(all.size());
            change.axis = kOrders[order];
            for (std::size_t i = 0; i < 3; ++i) change.sign[i] = (signs >> i & 1) != 0 ? -1 : 1;
            all.push_back(change);
        }
    }
    all.front().name = "as it is";
    return all;
}

}  // namespace

std::optional<Double3> ExactChange::operator()(const Double3& p) const {
    const std::array<double, 3> old = {p.x, p.y, p.z};
    std::array<double, 3> made{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = sign[i] * old[axis[i]];
        const double scaled = std::ldexp(x, exponent);
        if (std::ldexp(scaled, -exponent) != x) return std::nullopt;
        const std::optional<double> shifted = sum(scaled, shift);
        if (!shifted) return std::nullopt;
        made[i] = *shifted;
    }
    return Double3{made[0], made[1], made[2]};
}

std::optional<std::vector<Double3>> ExactChange::operator()(
    const std::vector<Double3>& points) const {
    std::vector<Double3> made;
    for (const Double3& p : points) {
        const auto changed = (*this)(p);
        if (!changed) return std::nullopt;
        made.push_back(*changed);
    }
    return made;
}

std::optional<TestMesh> ExactChange::operator()(const TestMesh& mesh) const {
    auto positions = (*this)(mesh.positions);
    if (!positions) return std::nullopt;
    return TestMesh{std::move(*positions), mesh.triangles};
}

Pose ExactChange::pose() const {
    std::array<double, 12> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        rows[3 * i + axis[i]] = sign[i];
        rows[9 + i] = shift;
    }
    return Pose::from_rows(rows).value();
}

double ExactChange::length(double before) const {
    return std::ldexp(before, exponent);
}

std::vector<ExactChange> exact_changes(bool few) {
    const std::vector<ExactChange> turned = turns();
    std::vector<ExactChange> all;
    for (std::size_t i = 0; i < turned.size(); i += few ? 7 : 1) all.push_back(turned[i]);
    for (const int exponent : {-40, -20, 20, 40}) {
        ExactChange change = turned.front();
        change.name = "times 2^" + std::to_string(exponent);
        change.exponent = exponent;
        all.push_back(change);
        change = turned[static_cast<std::size_t>(exponent + 40) / 5];
        change.name += ", times 2^" + std::to_string(exponent);
        change.exponent = exponent;
        all.push_back(change);
    }
    for (const std::size_t turn : {0U, 5U, 17U}) {
        ExactChange change = turned[turn];
        change.name += ", plus 2^20";
        change.shift = 0x1p20;
        all.push_back(change);
    }
    return all;
}

}  // namespace cdprep::test
