// SPDX-License-Identifier: MIT
#include <wasm_simd128.h>

#include "kernels.h"

#include <cassert>

#include "set_bits.h"

// WebAssembly's instructions for 128 bits, which all browsers have since 2023. Each operation
// rounds as scalar.cpp's: nothing is fused.
namespace cdprep::kernels {
namespace {

/// Eight lanes, each all ones or all zeros.
struct Mask8 {
    v128_t x, y;
};
inline Mask8 operator|(Mask8 a, Mask8 b) noexcept {
    return {wasm_v128_or(a.x, b.x), wasm_v128_or(a.y, b.y)};
}
inline Mask8 operator&(Mask8 a, Mask8 b) noexcept {
    return {wasm_v128_and(a.x, b.x), wasm_v128_and(a.y, b.y)};
}
inline Mask8 operator^(Mask8 a, Mask8 b) noexcept {
    return {wasm_v128_xor(a.x, b.x), wasm_v128_xor(a.y, b.y)};
}
inline Mask8 operator~(Mask8 a) noexcept {
    return {wasm_v128_not(a.x), wasm_v128_not(a.y)};
}
inline unsigned bits(Mask8 a) noexcept {
    return wasm_i32x4_bitmask(a.x) | wasm_i32x4_bitmask(a.y) << 4;
}

/// Eight indices.
struct Index8 {
    v128_t x, y;
};
inline Index8 operator+(Index8 a, Index8 b) noexcept {
    return {wasm_i32x4_add(a.x, b.x), wasm_i32x4_add(a.y, b.y)};
}
inline Index8 shifted_right(Index8 a, unsigned by) noexcept {
    return {wasm_i32x4_shr(a.x, by), wasm_i32x4_shr(a.y, by)};
}
/// Returns the lowest three bits.
inline Index8 low_bits(Index8 a) noexcept {
    const v128_t mask = wasm_i32x4_splat(7);
    return {wasm_v128_and(a.x, mask), wasm_v128_and(a.y, mask)};
}
inline Mask8 equal(Index8 a, Index8 b) noexcept {
    return {wasm_i32x4_eq(a.x, b.x), wasm_i32x4_eq(a.y, b.y)};
}

/// Returns four numbers of 32 bits each.
template <class Number>
v128_t four_of(const Number* base, v128_t at) noexcept {
    v128_t four = wasm_v128_load32_splat(base + wasm_i32x4_extract_lane(at, 0));
    four = wasm_v128_load32_lane(base + wasm_i32x4_extract_lane(at, 1), four, 1);
    four = wasm_v128_load32_lane(base + wasm_i32x4_extract_lane(at, 2), four, 2);
    return wasm_v128_load32_lane(base + wasm_i32x4_extract_lane(at, 3), four, 3);
}

/// Eight floats, in two halves.
struct F8 {
    using Mask = Mask8;
    using Index = Index8;
    static constexpr unsigned kCount = 8;
    static constexpr unsigned kRows = 1;
    v128_t x, y;

    F8() noexcept = default;
    F8(v128_t lower, v128_t upper) noexcept : x(lower), y(upper) {}
    explicit F8(float value) noexcept : x(wasm_f32x4_splat(value)), y(x) {}
    static F8 load(const float* p) noexcept {
        return {wasm_v128_load(p), wasm_v128_load(p + 4)};
    }
    /// Loads six floats as a padded box: 0, 1, 2, none, 3, 4, 5, none. None is 0.
    static F8 load_box(const float* p) noexcept {
        const v128_t none = wasm_f32x4_splat(0);
        return {wasm_f32x4_replace_lane(wasm_v128_load(p), 3, 0),
                wasm_i32x4_shuffle(wasm_v128_load(p + 2), none, 1, 2, 3, 4)};
    }
    static Index load_index(const std::uint16_t* p) noexcept {
        return {wasm_u32x4_load16x4(p), wasm_u32x4_load16x4(p + 4)};
    }
    static Index gather_index(const std::int32_t* base, Index at) noexcept {
        return {four_of(base, at.x), four_of(base, at.y)};
    }
    /// Picks from eight floats.
    static F8 pick(const float* p, Index at) noexcept {
        return gather(p, at);
    }
    /// Loads numbers that are compared bit by bit.
    static Index load_numbers(const std::uint32_t* p) noexcept {
        return {wasm_v128_load(p), wasm_v128_load(p + 4)};
    }
    template <class Rows>
    static Index spread_number(const std::uint32_t* p, const Rows& at) noexcept {
        const v128_t number = wasm_v128_load32_splat(p + at.first);
        return {number, number};
    }
    static F8 gather(const float* base, Index at) noexcept {
        return {four_of(base, at.x), four_of(base, at.y)};
    }
    /// Returns one of eight floats, the same for all lanes.
    template <class Rows>
    static F8 spread(const float* p, const Rows& at) noexcept {
        return F8(p[at.first]);
    }
    /// Stores first + i for each bit i that is set, one after the other. May write eight.
    static void store_lanes(unsigned bits, unsigned first, unsigned /*second*/,
                            std::uint16_t* to) noexcept {
        assert(bits < 256);
        const v128_t lanes = wasm_u16x8_load8x8(kSetBits.number[bits]);
        wasm_v128_store(to,
                        wasm_i16x8_add(lanes, wasm_i16x8_splat(static_cast<std::int16_t>(first))));
    }
    void store_all(float* p) const noexcept {
        store(p);
    }
    static F8 load_rows(const float* first, const float* /*second*/) noexcept {
        return load(first);
    }
    void store_rows(float* first, float* /*second*/) const noexcept {
        store(first);
    }
    /// Finds the largest of many lanes. Compares as integers, which order as non-negative floats
    /// do. The number of the lane replaces the lowest six bits.
    class Deepest {
    public:
        /// Adds the lanes of a row whose bits are set, among the lowest eight: numbers 8 row + i.
        template <class Rows>
        void add(F8 depth, unsigned bits, const Rows& at) noexcept {
            const auto row = static_cast<std::int32_t>(kLanes * at.first);
            add_half(depth.x, bits, row);
            add_half(depth.y, bits >> 4, row + 4);
        }
        [[nodiscard]] unsigned bit() const noexcept {
            const v128_t two = wasm_i32x4_max(most_, wasm_i32x4_shuffle(most_, most_, 2, 3, 0, 1));
            const v128_t one = wasm_i32x4_max(two, wasm_i32x4_shuffle(two, two, 1, 0, 3, 2));
            return static_cast<unsigned>(wasm_i32x4_extract_lane(one, 0)) & 63;
        }

    private:
        void add_half(v128_t depth, unsigned bits, std::int32_t number) noexcept {
            const v128_t lane = wasm_i32x4_const(1, 2, 4, 8);
            const v128_t set = wasm_i32x4_eq(
                wasm_v128_and(wasm_i32x4_splat(static_cast<std::int32_t>(bits)), lane), lane);
            const v128_t key = wasm_v128_or(
                wasm_v128_andnot(depth, wasm_i32x4_splat(63)),
                wasm_i32x4_add(wasm_i32x4_splat(number), wasm_i32x4_const(0, 1, 2, 3)));
            most_ = wasm_i32x4_max(most_, wasm_v128_bitselect(key, most_, set));
        }
        v128_t most_ = wasm_i32x4_splat(INT32_MIN);
    };
    static Mask none() noexcept {
        return {wasm_i32x4_splat(0), wasm_i32x4_splat(0)};
    }
    void store_row(float* p) const noexcept {
        store(p);
    }
    void store(float* p) const noexcept {
        wasm_v128_store(p, x);
        wasm_v128_store(p + 4, y);
    }
};
inline F8 operator+(F8 a, F8 b) noexcept {
    return {wasm_f32x4_add(a.x, b.x), wasm_f32x4_add(a.y, b.y)};
}
inline F8 operator-(F8 a, F8 b) noexcept {
    return {wasm_f32x4_sub(a.x, b.x), wasm_f32x4_sub(a.y, b.y)};
}
inline F8 operator*(F8 a, F8 b) noexcept {
    return {wasm_f32x4_mul(a.x, b.x), wasm_f32x4_mul(a.y, b.y)};
}
inline F8 operator-(F8 a) noexcept {
    return {wasm_f32x4_neg(a.x), wasm_f32x4_neg(a.y)};
}
inline F8 operator/(F8 a, F8 b) noexcept {
    return {wasm_f32x4_div(a.x, b.x), wasm_f32x4_div(a.y, b.y)};
}
inline F8 root(F8 a) noexcept {
    return {wasm_f32x4_sqrt(a.x), wasm_f32x4_sqrt(a.y)};
}
inline F8 fma(F8 a, F8 b, F8 c) noexcept {
    return a * b + c;
}
/// Returns a b - c.
inline F8 fms(F8 a, F8 b, F8 c) noexcept {
    return a * b - c;
}
/// Returns a < b ? a : b in each lane.
inline F8 min(F8 a, F8 b) noexcept {
    return {wasm_f32x4_pmin(b.x, a.x), wasm_f32x4_pmin(b.y, a.y)};
}
/// Returns a > b ? a : b in each lane.
inline F8 max(F8 a, F8 b) noexcept {
    return {wasm_f32x4_pmax(b.x, a.x), wasm_f32x4_pmax(b.y, a.y)};
}
inline F8 abs(F8 a) noexcept {
    return {wasm_f32x4_abs(a.x), wasm_f32x4_abs(a.y)};
}
inline Mask8 greater(F8 a, F8 b) noexcept {
    return {wasm_f32x4_gt(a.x, b.x), wasm_f32x4_gt(a.y, b.y)};
}
inline F8 select(Mask8 where, F8 a, F8 b) noexcept {
    return {wasm_v128_bitselect(a.x, b.x, where.x), wasm_v128_bitselect(a.y, b.y, where.y)};
}

/// Returns the last four lanes, then the first four.
inline F8 halves_exchanged(F8 a) noexcept {
    return {a.y, a.x};
}

/// Eight doubles, in four quarters.
struct D8 {
    struct Mask {
        v128_t x[4];
    };
    v128_t x[4];

    D8() noexcept = default;
    explicit D8(double value) noexcept {
        for (v128_t& two : x) two = wasm_f64x2_splat(value);
    }
    static D8 load(const double* p) noexcept {
        D8 result;
        for (unsigned i = 0; i < 4; ++i) result.x[i] = wasm_v128_load(p + std::size_t{2} * i);
        return result;
    }
    void store(double* p) const noexcept {
        for (unsigned i = 0; i < 4; ++i) wasm_v128_store(p + std::size_t{2} * i, x[i]);
    }
};

/// Returns operation(quarter) for each quarter.
template <class Operation>
D8 each_double(Operation operation) noexcept {
    D8 result;
    for (unsigned i = 0; i < 4; ++i) result.x[i] = operation(i);
    return result;
}

inline D8 operator+(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return wasm_f64x2_add(a.x[i], b.x[i]); });
}
inline D8 operator-(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return wasm_f64x2_sub(a.x[i], b.x[i]); });
}
inline D8 operator*(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return wasm_f64x2_mul(a.x[i], b.x[i]); });
}
inline D8 max(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return wasm_f64x2_pmax(b.x[i], a.x[i]); });
}
inline D8 abs(const D8& a) noexcept {
    return each_double([&](unsigned i) { return wasm_f64x2_abs(a.x[i]); });
}
inline D8::Mask greater(const D8& a, const D8& b) noexcept {
    D8::Mask result;
    for (unsigned i = 0; i < 4; ++i) result.x[i] = wasm_f64x2_gt(a.x[i], b.x[i]);
    return result;
}
inline unsigned bits(const D8::Mask& a) noexcept {
    unsigned all = 0;
    for (unsigned i = 0; i < 4; ++i) all |= wasm_i64x2_bitmask(a.x[i]) << (2 * i);
    return all;
}
inline D8 select(const D8::Mask& where, const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return wasm_v128_bitselect(a.x[i], b.x[i], where.x[i]); });
}

inline D8 doubles_of(F8 a) noexcept {
    const auto upper_two = [](v128_t four) { return wasm_i32x4_shuffle(four, four, 2, 3, 2, 3); };
    D8 result;
    result.x[0] = wasm_f64x2_promote_low_f32x4(a.x);
    result.x[1] = wasm_f64x2_promote_low_f32x4(upper_two(a.x));
    result.x[2] = wasm_f64x2_promote_low_f32x4(a.y);
    result.x[3] = wasm_f64x2_promote_low_f32x4(upper_two(a.y));
    return result;
}
inline F8 floats_of(const D8& a) noexcept {
    const auto four = [](v128_t lower, v128_t upper) {
        return wasm_i32x4_shuffle(wasm_f32x4_demote_f64x2_zero(lower),
                                  wasm_f32x4_demote_f64x2_zero(upper), 0, 1, 4, 5);
    };
    return {four(a.x[0], a.x[1]), four(a.x[2], a.x[3])};
}

}  // namespace
}  // namespace cdprep::kernels

#include "table_of.h"

namespace cdprep::kernels {

const Table kSimd128 = table_of<F8, F8, D8>("simd128");

}  // namespace cdprep::kernels
