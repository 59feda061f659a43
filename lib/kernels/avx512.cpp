// SPDX-License-Identifier: MIT
#include <immintrin.h>

#include "kernels.h"

#include <cassert>

namespace cdprep::kernels {
namespace {

/// One bit per lane.
template <class Bits>
struct LaneMask {
    Bits x;
};
template <class Bits>
LaneMask<Bits> operator|(LaneMask<Bits> a, LaneMask<Bits> b) noexcept {
    return {static_cast<Bits>(a.x | b.x)};
}
template <class Bits>
LaneMask<Bits> operator&(LaneMask<Bits> a, LaneMask<Bits> b) noexcept {
    return {static_cast<Bits>(a.x & b.x)};
}
template <class Bits>
LaneMask<Bits> operator^(LaneMask<Bits> a, LaneMask<Bits> b) noexcept {
    return {static_cast<Bits>(a.x ^ b.x)};
}
template <class Bits>
LaneMask<Bits> operator~(LaneMask<Bits> a) noexcept {
    return {static_cast<Bits>(~a.x)};
}
template <class Bits>
unsigned bits(LaneMask<Bits> a) noexcept {
    return a.x;
}

/// Eight floats.
struct F8 {
    using Mask = LaneMask<__mmask8>;
    __m256 x;

    F8() noexcept = default;
    F8(__m256 value) noexcept : x(value) {}  // NOLINT(google-explicit-constructor)
    explicit F8(float value) noexcept : x(_mm256_set1_ps(value)) {}
    static F8 load(const float* p) noexcept {
        return _mm256_loadu_ps(p);
    }
    /// Loads six floats as a padded box: 0, 1, 2, none, 3, 4, 5, none. None is 0.
    static F8 load_box(const float* p) noexcept {
        const __m256i places = _mm256_setr_epi32(0, 1, 2, 6, 3, 4, 5, 7);
        return _mm256_permutevar8x32_ps(_mm256_maskz_loadu_ps(0x3f, p), places);
    }
    static Mask none() noexcept {
        return {0};
    }
    void store(float* p) const noexcept {
        _mm256_storeu_ps(p, x);
    }
    void store_row(float* p) const noexcept {
        store(p);
    }
};
inline F8 operator+(F8 a, F8 b) noexcept {
    return _mm256_add_ps(a.x, b.x);
}
inline F8 operator-(F8 a, F8 b) noexcept {
    return _mm256_sub_ps(a.x, b.x);
}
inline F8 operator*(F8 a, F8 b) noexcept {
    return _mm256_mul_ps(a.x, b.x);
}
inline F8 operator-(F8 a) noexcept {
    return _mm256_xor_ps(a.x, _mm256_set1_ps(-0.0F));
}
inline F8 fma(F8 a, F8 b, F8 c) noexcept {
    return _mm256_fmadd_ps(a.x, b.x, c.x);
}
/// Returns a b - c.
inline F8 fms(F8 a, F8 b, F8 c) noexcept {
    return _mm256_fmsub_ps(a.x, b.x, c.x);
}
inline F8 min(F8 a, F8 b) noexcept {
    return _mm256_min_ps(a.x, b.x);
}
inline F8 max(F8 a, F8 b) noexcept {
    return _mm256_max_ps(a.x, b.x);
}
inline F8 abs(F8 a) noexcept {
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.x);
}
inline F8::Mask greater(F8 a, F8 b) noexcept {
    return {_mm256_cmp_ps_mask(a.x, b.x, _CMP_GT_OQ)};
}

/// Sixteen indices.
struct Index16 {
    __m512i x;
};
inline Index16 operator+(Index16 a, Index16 b) noexcept {
    return {_mm512_add_epi32(a.x, b.x)};
}
inline Index16 shifted_right(Index16 a, unsigned by) noexcept {
    return {_mm512_srli_epi32(a.x, by)};
}
/// Returns the lowest three bits.
inline Index16 low_bits(Index16 a) noexcept {
    return {_mm512_and_si512(a.x, _mm512_set1_epi32(7))};
}

inline LaneMask<__mmask16> equal(Index16 a, Index16 b) noexcept {
    return {_mm512_cmpeq_epi32_mask(a.x, b.x)};
}

/// Sixteen floats.
struct F16 {
    using Mask = LaneMask<__mmask16>;
    using Index = Index16;
    static constexpr unsigned kCount = 16;
    static constexpr unsigned kRows = 2;
    __m512 x;

    F16() noexcept = default;
    F16(__m512 value) noexcept : x(value) {}  // NOLINT(google-explicit-constructor)
    explicit F16(float value) noexcept : x(_mm512_set1_ps(value)) {}
    /// Loads eight floats, twice.
    static F16 load(const float* p) noexcept {
        return _mm512_broadcast_f32x8(_mm256_loadu_ps(p));
    }
    /// Returns one number for the lower lanes and one for the upper.
    static __m512i of_rows(std::size_t first, std::size_t second) noexcept {
        constexpr __mmask16 kUpper = 0xff00;
        return _mm512_mask_set1_epi32(_mm512_set1_epi32(static_cast<std::int32_t>(first)), kUpper,
                                      static_cast<std::int32_t>(second));
    }
    /// Returns one of eight floats for the lower lanes and one for the upper. Uses a load and a
    /// permutation; two broadcasts would be two loads and a blend.
    template <class Rows>
    static F16 spread(const float* p, const Rows& at) noexcept {
        return _mm512_permutexvar_ps(of_rows(at.first, at.second),
                                     _mm512_castps256_ps512(_mm256_loadu_ps(p)));
    }
    /// Stores, for each bit that is set, one after the other: first + i for bit i, second + i for
    /// bit 8 + i. May write sixteen.
    static void store_lanes(unsigned bits, unsigned first, unsigned second,
                            std::uint16_t* to) noexcept {
        assert(bits >> kCount == 0);
        const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
        const __m512i base = of_rows(first, second);
        const __m512i kept =
            _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), _mm512_add_epi32(lane, base));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi32_epi16(kept));
    }
    void store_all(float* p) const noexcept {
        _mm512_storeu_ps(p, x);
    }
    /// Stores the lower eight.
    void store_row(float* p) const noexcept {
        _mm256_storeu_ps(p, _mm512_castps512_ps256(x));
    }
    static F16 load_rows(const float* first, const float* second) noexcept {
        return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(first)),
                                  _mm256_loadu_ps(second), 1);
    }
    void store_rows(float* first, float* second) const noexcept {
        _mm256_storeu_ps(second, _mm512_extractf32x8_ps(x, 1));
        _mm256_storeu_ps(first, _mm512_castps512_ps256(x));
    }
    /// Finds the largest of many lanes. Compares as integers, which order as non-negative floats
    /// do. The number of the lane replaces the lowest six bits.
    class Deepest {
    public:
        /// Adds the lanes of two rows whose bits are set: numbers 8 row + i.
        template <class Rows>
        void add(F16 depth, unsigned bits, const Rows& at) noexcept {
            const __m512i number =
                _mm512_or_si512(_mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7),
                                of_rows(kLanes * at.first, kLanes * at.second));
            constexpr int kFirstWithoutThirdOrSecond = 0xdc;
            const __m512i key =
                _mm512_ternarylogic_epi32(_mm512_castps_si512(depth.x), number,
                                          _mm512_set1_epi32(63), kFirstWithoutThirdOrSecond);
            most_ = _mm512_mask_max_epi32(most_, static_cast<__mmask16>(bits), most_, key);
        }
        [[nodiscard]] unsigned bit() const noexcept {
            const __m256i eight = _mm256_max_epi32(_mm512_castsi512_si256(most_),
                                                   _mm512_extracti32x8_epi32(most_, 1));
            __m128i four =
                _mm_max_epi32(_mm256_castsi256_si128(eight), _mm256_extracti128_si256(eight, 1));
            four = _mm_max_epi32(four, _mm_shuffle_epi32(four, 0x4e));
            four = _mm_max_epi32(four, _mm_shuffle_epi32(four, 0xb1));
            return static_cast<unsigned>(_mm_cvtsi128_si32(four)) & 63;
        }

    private:
        __m512i most_ = _mm512_set1_epi32(INT32_MIN);
    };
    static Mask none() noexcept {
        return {0};
    }
    static Index load_index(const std::uint16_t* p) noexcept {
        return {_mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)))};
    }
    static Index gather_index(const std::int32_t* base, Index at) noexcept {
        return {_mm512_i32gather_epi32(at.x, base, 4)};
    }
    /// Picks from eight floats.
    static F16 pick(const float* p, Index at) noexcept {
        return _mm512_permutexvar_ps(at.x, _mm512_castps256_ps512(_mm256_loadu_ps(p)));
    }
    /// Loads eight numbers, twice; they are compared bit by bit.
    static Index load_numbers(const std::uint32_t* p) noexcept {
        return {_mm512_broadcast_i32x8(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)))};
    }
    template <class Rows>
    static Index spread_number(const std::uint32_t* p, const Rows& at) noexcept {
        constexpr __mmask16 kUpper = 0xff00;
        const __m512i lower = _mm512_set1_epi32(static_cast<std::int32_t>(p[at.first]));
        return {_mm512_mask_set1_epi32(lower, kUpper, static_cast<std::int32_t>(p[at.second]))};
    }
    static F16 gather(const float* base, Index at) noexcept {
        return _mm512_i32gather_ps(at.x, base, 4);
    }
};
inline F16 operator+(F16 a, F16 b) noexcept {
    return _mm512_add_ps(a.x, b.x);
}
inline F16 operator-(F16 a, F16 b) noexcept {
    return _mm512_sub_ps(a.x, b.x);
}
inline F16 operator*(F16 a, F16 b) noexcept {
    return _mm512_mul_ps(a.x, b.x);
}
inline F16 operator-(F16 a) noexcept {
    return _mm512_xor_ps(a.x, _mm512_set1_ps(-0.0F));
}
inline F16 operator/(F16 a, F16 b) noexcept {
    return _mm512_div_ps(a.x, b.x);
}
inline F16 root(F16 a) noexcept {
    return _mm512_sqrt_ps(a.x);
}
inline F16 fma(F16 a, F16 b, F16 c) noexcept {
    return _mm512_fmadd_ps(a.x, b.x, c.x);
}
inline F16 fms(F16 a, F16 b, F16 c) noexcept {
    return _mm512_fmsub_ps(a.x, b.x, c.x);
}
inline F16 min(F16 a, F16 b) noexcept {
    return _mm512_min_ps(a.x, b.x);
}
inline F16 max(F16 a, F16 b) noexcept {
    return _mm512_max_ps(a.x, b.x);
}
inline F16 abs(F16 a) noexcept {
    return _mm512_abs_ps(a.x);
}
inline F16::Mask greater(F16 a, F16 b) noexcept {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_GT_OQ)};
}
inline F16 select(F16::Mask where, F16 a, F16 b) noexcept {
    return _mm512_mask_blend_ps(where.x, b.x, a.x);
}

/// Returns the last four lanes, then the first four.
inline F8 halves_exchanged(F8 a) noexcept {
    return _mm256_permute2f128_ps(a.x, a.x, 1);
}

/// Eight doubles.
struct D8 {
    struct Mask {
        __mmask8 x;
    };
    __m512d x;

    D8(__m512d value) noexcept : x(value) {}  // NOLINT(google-explicit-constructor)
    explicit D8(double value) noexcept : x(_mm512_set1_pd(value)) {}
    static D8 load(const double* p) noexcept {
        return _mm512_loadu_pd(p);
    }
    void store(double* p) const noexcept {
        _mm512_storeu_pd(p, x);
    }
};
inline D8 operator+(D8 a, D8 b) noexcept {
    return _mm512_add_pd(a.x, b.x);
}
inline D8 operator-(D8 a, D8 b) noexcept {
    return _mm512_sub_pd(a.x, b.x);
}
inline D8 operator*(D8 a, D8 b) noexcept {
    return _mm512_mul_pd(a.x, b.x);
}
inline D8 max(D8 a, D8 b) noexcept {
    return _mm512_max_pd(a.x, b.x);
}
inline D8 abs(D8 a) noexcept {
    return _mm512_abs_pd(a.x);
}
inline D8::Mask greater(D8 a, D8 b) noexcept {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_GT_OQ)};
}
inline unsigned bits(D8::Mask a) noexcept {
    return a.x;
}
inline D8 select(D8::Mask where, D8 a, D8 b) noexcept {
    return _mm512_mask_blend_pd(where.x, b.x, a.x);
}

inline D8 doubles_of(F8 a) noexcept {
    return _mm512_cvtps_pd(a.x);
}
inline F8 floats_of(D8 a) noexcept {
    return _mm512_cvtpd_ps(a.x);
}

}  // namespace
}  // namespace cdprep::kernels

#include "avx_rows.h"
#include "table_of.h"

namespace cdprep::kernels {

const Table kAvx512 = table_of<F8, F16, D8>("avx512");

}  // namespace cdprep::kernels
