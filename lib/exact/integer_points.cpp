// SPDX-License-Identifier: MIT
#include "exact/integer_points.h"

#include "cdprep/format/portable.h"

namespace cdprep {
namespace {

using format::Int128;
using format::upper_word;

Integer3 operator-(const Integer3& a, const Integer3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Returns a d - b c, which is below 2^126 in magnitude.
Int128 minor_of(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
    return static_cast<Int128>(a) * d - static_cast<Int128>(b) * c;
}

struct Normal {
    Int128 x, y, z;
};

Normal cross(const Integer3& a, const Integer3& b) {
    return {minor_of(a.y, a.z, b.y, b.z), minor_of(a.z, a.x, b.z, b.x),
            minor_of(a.x, a.y, b.x, b.y)};
}

/// The sum of three products of a minor and a difference, as high * 2^64 + low. Each product is
/// below 2^189.
class WideSum {
public:
    void add_product(Int128 minor, std::int64_t factor) noexcept {
        const Int128 low = static_cast<Int128>(static_cast<std::uint64_t>(minor)) * factor;
        high_ += upper_word(minor) * factor + upper_word(low);
        low_ += static_cast<std::uint64_t>(low);
    }
    [[nodiscard]] int sign() const noexcept {
        const Int128 high = high_ + upper_word(low_);
        if (high != 0) return high > 0 ? 1 : -1;
        return static_cast<std::uint64_t>(low_) != 0 ? 1 : 0;
    }

private:
    Int128 high_ = 0;
    Int128 low_ = 0;  ///< a sum of three words
};

int dot_sign(const Normal& n, const Integer3& a) {
    WideSum sum;
    sum.add_product(n.x, a.x);
    sum.add_product(n.y, a.y);
    sum.add_product(n.z, a.z);
    return sum.sign();
}

}  // namespace

int orient2d(const Integer2& a, const Integer2& b, const Integer2& c) noexcept {
    const Int128 determinant = minor_of(a.x - c.x, a.y - c.y, b.x - c.x, b.y - c.y);
    return (determinant > 0) - (determinant < 0);
}

int orient3d(const Integer3& a, const Integer3& b, const Integer3& c, const Integer3& d) noexcept {
    return dot_sign(cross(b - d, c - d), a - d);
}

std::array<int, 3> plane_signs(const std::array<Integer3, 3>& plane,
                               const std::array<Integer3, 3>& points) noexcept {
    // The opposite normal: orient3d is positive behind the plane.
    const Normal behind = cross(plane[2] - plane[0], plane[1] - plane[0]);
    return {dot_sign(behind, points[0] - plane[0]), dot_sign(behind, points[1] - plane[0]),
            dot_sign(behind, points[2] - plane[0])};
}

}  // namespace cdprep
