// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/turn_up.h"

namespace cdprep::mesh {
namespace {

using format::UpAxis;

Double3 with_z_up(const Double3& p, UpAxis from) {
    if (from == UpAxis::y) return {p.x, -p.z, p.y};
    if (from == UpAxis::x) return {-p.z, p.y, p.x};
    return p;
}

/// Returns the inverse of with_z_up().
Double3 from_z_up(const Double3& p, UpAxis to) {
    if (to == UpAxis::y) return {p.x, p.z, -p.y};
    if (to == UpAxis::x) return {p.z, p.y, -p.x};
    return p;
}

}  // namespace

void turn_up(std::span<Double3> points, UpAxis from, UpAxis to) {
    if (from == to || from == UpAxis::unknown || to == UpAxis::unknown) return;
    for (Double3& p : points) p = from_z_up(with_z_up(p, from), to);
}

}  // namespace cdprep::mesh
