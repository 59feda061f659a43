// SPDX-License-Identifier: MIT
#include <immintrin.h>

#include "kernels.h"

#include <cassert>

#include "set_bits.h"

namespace cdprep::kernels {
namespace {

/// Eight lanes, each all ones or all zeros.
struct Mask8 {
    __m256 x;
};
inline Mask8 operator|(Mask8 a, Mask8 b) noexcept {
    return {_mm256_or_ps(a.x, b.x)};
}
inline Mask8 operator&(Mask8 a, Mask8 b) noexcept {
    return {_mm256_and_ps(a.x, b.x)};
}
inline Mask8 operator^(Mask8 a, Mask8 b) noexcept {
    return {_mm256_xor_ps(a.x, b.x)};
}
inline Mask8 operator~(Mask8 a) noexcept {
    return {_mm256_xor_ps(a.x, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))};
}
inline unsigned bits(Mask8 a) noexcept {
    return static_cast<unsigned>(_mm256_movemask_ps(a.x));
}

/// Eight indices.
struct Index8 {
    __m256i x;
};
inline Index8 operator+(Index8 a, Index8 b) noexcept {
    return {_mm256_add_epi32(a.x, b.x)};
}
inline Index8 shifted_right(Index8 a, int by) noexcept {
    return {_mm256_srli_epi32(a.x, by)};
}
/// Returns the lowest three bits.
inline Index8 low_bits(Index8 a) noexcept {
    return {_mm256_and_si256(a.x, _mm256_set1_epi32(7))};
}

inline Mask8 equal(Index8 a, Index8 b) noexcept {
    return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(a.x, b.x))};
}

/// Eight floats.
struct F8 {
    using Mask = Mask8;
    using Index = Index8;
    static constexpr unsigned kCount = 8;
    static constexpr unsigned kRows = 1;
    __m256 x;

    F8() noexcept = default;
    F8(__m256 value) noexcept : x(value) {}  // NOLINT(google-explicit-constructor)
    explicit F8(float value) noexcept : x(_mm256_set1_ps(value)) {}
    static F8 load(const float* p) noexcept {
        return _mm256_loadu_ps(p);
    }
    /// Loads six floats as a padded box: 0, 1, 2, none, 3, 4, 5, none. None is 0.
    static F8 load_box(const float* p) noexcept {
        const __m256i six = _mm256_setr_epi32(-1, -1, -1, -1, -1, -1, 0, 0);
        const __m256i places = _mm256_setr_epi32(0, 1, 2, 6, 3, 4, 5, 7);
        return _mm256_permutevar8x32_ps(_mm256_maskload_ps(p, six), places);
    }
    static Index load_index(const std::uint16_t* p) noexcept {
        return {_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)))};
    }
    static Index gather_index(const std::int32_t* base, Index at) noexcept {
        return {_mm256_i32gather_epi32(base, at.x, 4)};
    }
    /// Picks from eight floats.
    static F8 pick(const float* p, Index at) noexcept {
        return _mm256_permutevar8x32_ps(load(p).x, at.x);
    }
    /// Loads numbers that are compared bit by bit.
    static Index load_numbers(const std::uint32_t* p) noexcept {
        return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
    }
    template <class Rows>
    static Index spread_number(const std::uint32_t* p, const Rows& at) noexcept {
        return {_mm256_set1_epi32(static_cast<std::int32_t>(p[at.first]))};
    }
    static F8 gather(const float* base, Index at) noexcept {
        return _mm256_i32gather_ps(base, at.x, 4);
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
        const auto* numbers = reinterpret_cast<const __m128i*>(kSetBits.number[bits]);
        const __m128i lanes = _mm_cvtepu8_epi16(_mm_loadl_epi64(numbers));
        const __m128i base = _mm_set1_epi16(static_cast<short>(first));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_add_epi16(lanes, base));
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
            const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            const __m256i set = _mm256_cmpeq_epi32(
                _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), bit), bit);
            const __m256i number =
                _mm256_or_si256(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
                                _mm256_set1_epi32(static_cast<int>(kLanes * at.first)));
            const __m256i key = _mm256_or_si256(
                _mm256_andnot_si256(_mm256_set1_epi32(63), _mm256_castps_si256(depth.x)), number);
            most_ = _mm256_max_epi32(most_, _mm256_blendv_epi8(most_, key, set));
        }
        [[nodiscard]] unsigned bit() const noexcept {
            __m128i four =
                _mm_max_epi32(_mm256_castsi256_si128(most_), _mm256_extracti128_si256(most_, 1));
            four = _mm_max_epi32(four, _mm_shuffle_epi32(four, 0x4e));
            four = _mm_max_epi32(four, _mm_shuffle_epi32(four, 0xb1));
            return static_cast<unsigned>(_mm_cvtsi128_si32(four)) & 63;
        }

    private:
        __m256i most_ = _mm256_set1_epi32(INT32_MIN);
    };
    static Mask none() noexcept {
        return {_mm256_setzero_ps()};
    }
    void store_row(float* p) const noexcept {
        store(p);
    }
    void store(float* p) const noexcept {
        _mm256_storeu_ps(p, x);
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
inline F8 operator/(F8 a, F8 b) noexcept {
    return _mm256_div_ps(a.x, b.x);
}
inline F8 root(F8 a) noexcept {
    return _mm256_sqrt_ps(a.x);
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
inline Mask8 greater(F8 a, F8 b) noexcept {
    return {_mm256_cmp_ps(a.x, b.x, _CMP_GT_OQ)};
}
inline F8 select(Mask8 where, F8 a, F8 b) noexcept {
    return _mm256_blendv_ps(b.x, a.x, where.x);
}

/// Returns the last four lanes, then the first four.
inline F8 halves_exchanged(F8 a) noexcept {
    return _mm256_permute2f128_ps(a.x, a.x, 1);
}

/// Eight doubles, in two halves.
struct D8 {
    struct Mask {
        __m256d x, y;
    };
    __m256d x, y;

    D8(__m256d lower, __m256d upper) noexcept : x(lower), y(upper) {}
    explicit D8(double value) noexcept : x(_mm256_set1_pd(value)), y(x) {}
    static D8 load(const double* p) noexcept {
        return {_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)};
    }
    void store(double* p) const noexcept {
        _mm256_storeu_pd(p, x);
        _mm256_storeu_pd(p + 4, y);
    }
};
inline D8 operator+(const D8& a, const D8& b) noexcept {
    return {_mm256_add_pd(a.x, b.x), _mm256_add_pd(a.y, b.y)};
}
inline D8 operator-(const D8& a, const D8& b) noexcept {
    return {_mm256_sub_pd(a.x, b.x), _mm256_sub_pd(a.y, b.y)};
}
inline D8 operator*(const D8& a, const D8& b) noexcept {
    return {_mm256_mul_pd(a.x, b.x), _mm256_mul_pd(a.y, b.y)};
}
inline D8 max(const D8& a, const D8& b) noexcept {
    return {_mm256_max_pd(a.x, b.x), _mm256_max_pd(a.y, b.y)};
}
inline D8 abs(const D8& a) noexcept {
    const __m256d sign = _mm256_set1_pd(-0.0);
    return {_mm256_andnot_pd(sign, a.x), _mm256_andnot_pd(sign, a.y)};
}
inline D8::Mask greater(const D8& a, const D8& b) noexcept {
    return {_mm256_cmp_pd(a.x, b.x, _CMP_GT_OQ), _mm256_cmp_pd(a.y, b.y, _CMP_GT_OQ)};
}
inline unsigned bits(const D8::Mask& a) noexcept {
    return static_cast<unsigned>(_mm256_movemask_pd(a.x)) |
           static_cast<unsigned>(_mm256_movemask_pd(a.y)) << 4;
}
inline D8 select(const D8::Mask& where, const D8& a, const D8& b) noexcept {
    return {_mm256_blendv_pd(b.x, a.x, where.x), _mm256_blendv_pd(b.y, a.y, where.y)};
}

inline D8 doubles_of(F8 a) noexcept {
    return {_mm256_cvtps_pd(_mm256_castps256_ps128(a.x)),
            _mm256_cvtps_pd(_mm256_extractf128_ps(a.x, 1))};
}
inline F8 floats_of(const D8& a) noexcept {
    return _mm256_set_m128(_mm256_cvtpd_ps(a.y), _mm256_cvtpd_ps(a.x));
}

}  // namespace
}  // namespace cdprep::kernels

#include "avx_rows.h"
#include "table_of.h"

namespace cdprep::kernels {

const Table kAvx2 = table_of<F8, F8, D8>("avx2");

}  // namespace cdprep::kernels
