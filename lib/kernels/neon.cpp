// SPDX-License-Identifier: MIT
#include <arm_neon.h>

#include "kernels.h"

#include <cassert>

#include "set_bits.h"

// Each operation gives the bits that avx2.cpp's gives, NaN and signs of zeros included. Minima and
// maxima are chosen by comparison, because NEON's own propagate NaN.
namespace cdprep::kernels {
namespace {

/// Eight lanes, each all ones or all zeros.
struct Mask8 {
    uint32x4_t x, y;
};
inline Mask8 operator|(Mask8 a, Mask8 b) noexcept {
    return {vorrq_u32(a.x, b.x), vorrq_u32(a.y, b.y)};
}
inline Mask8 operator&(Mask8 a, Mask8 b) noexcept {
    return {vandq_u32(a.x, b.x), vandq_u32(a.y, b.y)};
}
inline Mask8 operator^(Mask8 a, Mask8 b) noexcept {
    return {veorq_u32(a.x, b.x), veorq_u32(a.y, b.y)};
}
inline Mask8 operator~(Mask8 a) noexcept {
    return {vmvnq_u32(a.x), vmvnq_u32(a.y)};
}
constexpr std::uint32_t kBits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
constexpr std::uint32_t kNumbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
inline unsigned bits(Mask8 a) noexcept {
    const uint32x4_t low = vld1q_u32(kBits), high = vld1q_u32(kBits + 4);
    return vaddvq_u32(vorrq_u32(vandq_u32(a.x, low), vandq_u32(a.y, high)));
}

/// Eight indices.
struct Index8 {
    int32x4_t x, y;
};
inline Index8 operator+(Index8 a, Index8 b) noexcept {
    return {vaddq_s32(a.x, b.x), vaddq_s32(a.y, b.y)};
}
inline Index8 shifted_right(Index8 a, int by) noexcept {
    const int32x4_t left = vdupq_n_s32(-by);
    return {vshlq_s32(a.x, left), vshlq_s32(a.y, left)};
}
/// Returns the lowest three bits.
inline Index8 low_bits(Index8 a) noexcept {
    const int32x4_t mask = vdupq_n_s32(7);
    return {vandq_s32(a.x, mask), vandq_s32(a.y, mask)};
}
inline Mask8 equal(Index8 a, Index8 b) noexcept {
    return {vceqq_s32(a.x, b.x), vceqq_s32(a.y, b.y)};
}

inline int32x4_t four_of(const std::int32_t* base, int32x4_t at) noexcept {
    int32x4_t four = vld1q_dup_s32(base + vgetq_lane_s32(at, 0));
    four = vld1q_lane_s32(base + vgetq_lane_s32(at, 1), four, 1);
    four = vld1q_lane_s32(base + vgetq_lane_s32(at, 2), four, 2);
    return vld1q_lane_s32(base + vgetq_lane_s32(at, 3), four, 3);
}
inline float32x4_t four_of(const float* base, int32x4_t at) noexcept {
    float32x4_t four = vld1q_dup_f32(base + vgetq_lane_s32(at, 0));
    four = vld1q_lane_f32(base + vgetq_lane_s32(at, 1), four, 1);
    four = vld1q_lane_f32(base + vgetq_lane_s32(at, 2), four, 2);
    return vld1q_lane_f32(base + vgetq_lane_s32(at, 3), four, 3);
}

/// Eight floats, in two halves.
struct F8 {
    using Mask = Mask8;
    using Index = Index8;
    static constexpr unsigned kCount = 8;
    static constexpr unsigned kRows = 1;
    float32x4_t x, y;

    F8() noexcept = default;
    F8(float32x4_t lower, float32x4_t upper) noexcept : x(lower), y(upper) {}
    explicit F8(float value) noexcept : x(vdupq_n_f32(value)), y(x) {}
    static F8 load(const float* p) noexcept {
        return {vld1q_f32(p), vld1q_f32(p + 4)};
    }
    /// Loads six floats as a padded box: 0, 1, 2, none, 3, 4, 5, none. None is 0.
    static F8 load_box(const float* p) noexcept {
        return {vsetq_lane_f32(0, vld1q_f32(p), 3), vextq_f32(vld1q_f32(p + 2), vdupq_n_f32(0), 1)};
    }
    static Index load_index(const std::uint16_t* p) noexcept {
        const uint16x8_t numbers = vld1q_u16(p);
        return {vreinterpretq_s32_u32(vmovl_u16(vget_low_u16(numbers))),
                vreinterpretq_s32_u32(vmovl_high_u16(numbers))};
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
        return {vreinterpretq_s32_u32(vld1q_u32(p)), vreinterpretq_s32_u32(vld1q_u32(p + 4))};
    }
    template <class Rows>
    static Index spread_number(const std::uint32_t* p, const Rows& at) noexcept {
        const int32x4_t number = vdupq_n_s32(static_cast<std::int32_t>(p[at.first]));
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
        const uint16x8_t lanes = vmovl_u8(vld1_u8(kSetBits.number[bits]));
        vst1q_u16(to, vaddq_u16(lanes, vdupq_n_u16(static_cast<std::uint16_t>(first))));
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
            const auto row = static_cast<std::uint32_t>(kLanes * at.first);
            add_half(depth.x, bits, row, 0);
            add_half(depth.y, bits, row, 4);
        }
        [[nodiscard]] unsigned bit() const noexcept {
            return static_cast<unsigned>(vmaxvq_s32(most_)) & 63;
        }

    private:
        void add_half(float32x4_t depth, unsigned bits, std::uint32_t row, unsigned lane) noexcept {
            const uint32x4_t set = vtstq_u32(vdupq_n_u32(bits), vld1q_u32(kBits + lane));
            const uint32x4_t number = vorrq_u32(vld1q_u32(kNumbers + lane), vdupq_n_u32(row));
            const uint32x4_t key =
                vorrq_u32(vbicq_u32(vreinterpretq_u32_f32(depth), vdupq_n_u32(63)), number);
            most_ = vmaxq_s32(most_, vbslq_s32(set, vreinterpretq_s32_u32(key), most_));
        }
        int32x4_t most_ = vdupq_n_s32(INT32_MIN);
    };
    static Mask none() noexcept {
        return {vdupq_n_u32(0), vdupq_n_u32(0)};
    }
    void store_row(float* p) const noexcept {
        store(p);
    }
    void store(float* p) const noexcept {
        vst1q_f32(p, x);
        vst1q_f32(p + 4, y);
    }
};
inline F8 operator+(F8 a, F8 b) noexcept {
    return {vaddq_f32(a.x, b.x), vaddq_f32(a.y, b.y)};
}
inline F8 operator-(F8 a, F8 b) noexcept {
    return {vsubq_f32(a.x, b.x), vsubq_f32(a.y, b.y)};
}
inline F8 operator*(F8 a, F8 b) noexcept {
    return {vmulq_f32(a.x, b.x), vmulq_f32(a.y, b.y)};
}
inline F8 operator-(F8 a) noexcept {
    return {vnegq_f32(a.x), vnegq_f32(a.y)};
}
inline F8 operator/(F8 a, F8 b) noexcept {
    return {vdivq_f32(a.x, b.x), vdivq_f32(a.y, b.y)};
}
inline F8 root(F8 a) noexcept {
    return {vsqrtq_f32(a.x), vsqrtq_f32(a.y)};
}
inline F8 fma(F8 a, F8 b, F8 c) noexcept {
    return {vfmaq_f32(c.x, a.x, b.x), vfmaq_f32(c.y, a.y, b.y)};
}
/// Returns a b - c.
inline F8 fms(F8 a, F8 b, F8 c) noexcept {
    return fma(a, b, -c);
}
inline F8 min(F8 a, F8 b) noexcept {
    return {vbslq_f32(vcltq_f32(a.x, b.x), a.x, b.x), vbslq_f32(vcltq_f32(a.y, b.y), a.y, b.y)};
}
inline F8 max(F8 a, F8 b) noexcept {
    return {vbslq_f32(vcgtq_f32(a.x, b.x), a.x, b.x), vbslq_f32(vcgtq_f32(a.y, b.y), a.y, b.y)};
}
inline F8 abs(F8 a) noexcept {
    return {vabsq_f32(a.x), vabsq_f32(a.y)};
}
inline Mask8 greater(F8 a, F8 b) noexcept {
    return {vcgtq_f32(a.x, b.x), vcgtq_f32(a.y, b.y)};
}
inline F8 select(Mask8 where, F8 a, F8 b) noexcept {
    return {vbslq_f32(where.x, a.x, b.x), vbslq_f32(where.y, a.y, b.y)};
}

/// Returns the last four lanes, then the first four.
inline F8 halves_exchanged(F8 a) noexcept {
    return {a.y, a.x};
}

/// Eight doubles, in four quarters.
struct D8 {
    struct Mask {
        uint64x2_t x[4];
    };
    float64x2_t x[4];

    D8() noexcept = default;
    explicit D8(double value) noexcept {
        for (float64x2_t& two : x) two = vdupq_n_f64(value);
    }
    static D8 load(const double* p) noexcept {
        D8 result;
        for (unsigned i = 0; i < 4; ++i) result.x[i] = vld1q_f64(p + std::size_t{2} * i);
        return result;
    }
    void store(double* p) const noexcept {
        for (unsigned i = 0; i < 4; ++i) vst1q_f64(p + std::size_t{2} * i, x[i]);
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
    return each_double([&](unsigned i) { return vaddq_f64(a.x[i], b.x[i]); });
}
inline D8 operator-(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return vsubq_f64(a.x[i], b.x[i]); });
}
inline D8 operator*(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return vmulq_f64(a.x[i], b.x[i]); });
}
inline D8 max(const D8& a, const D8& b) noexcept {
    return each_double(
        [&](unsigned i) { return vbslq_f64(vcgtq_f64(a.x[i], b.x[i]), a.x[i], b.x[i]); });
}
inline D8 abs(const D8& a) noexcept {
    return each_double([&](unsigned i) { return vabsq_f64(a.x[i]); });
}
inline D8::Mask greater(const D8& a, const D8& b) noexcept {
    D8::Mask result;
    for (unsigned i = 0; i < 4; ++i) result.x[i] = vcgtq_f64(a.x[i], b.x[i]);
    return result;
}
inline unsigned bits(const D8::Mask& a) noexcept {
    return bits(Mask8{vcombine_u32(vmovn_u64(a.x[0]), vmovn_u64(a.x[1])),
                      vcombine_u32(vmovn_u64(a.x[2]), vmovn_u64(a.x[3]))});
}
inline D8 select(const D8::Mask& where, const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return vbslq_f64(where.x[i], a.x[i], b.x[i]); });
}

inline D8 doubles_of(F8 a) noexcept {
    D8 result;
    result.x[0] = vcvt_f64_f32(vget_low_f32(a.x));
    result.x[1] = vcvt_high_f64_f32(a.x);
    result.x[2] = vcvt_f64_f32(vget_low_f32(a.y));
    result.x[3] = vcvt_high_f64_f32(a.y);
    return result;
}
inline F8 floats_of(const D8& a) noexcept {
    return {vcvt_high_f32_f64(vcvt_f32_f64(a.x[0]), a.x[1]),
            vcvt_high_f32_f64(vcvt_f32_f64(a.x[2]), a.x[3])};
}

}  // namespace
}  // namespace cdprep::kernels

#include "table_of.h"

namespace cdprep::kernels {

const Table kNeon = table_of<F8, F8, D8>("neon");

}  // namespace cdprep::kernels
