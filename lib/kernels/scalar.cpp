// SPDX-License-Identifier: MIT
#include "kernels.h"

#include <cassert>
#include <cmath>

namespace cdprep::kernels {
namespace {

/// One bit per lane.
struct Mask8 {
    unsigned x;
};
inline Mask8 operator|(Mask8 a, Mask8 b) noexcept {
    return {a.x | b.x};
}
inline Mask8 operator&(Mask8 a, Mask8 b) noexcept {
    return {a.x & b.x};
}
inline Mask8 operator^(Mask8 a, Mask8 b) noexcept {
    return {a.x ^ b.x};
}
inline Mask8 operator~(Mask8 a) noexcept {
    return {~a.x & 0xff};
}
inline unsigned bits(Mask8 a) noexcept {
    return a.x;
}

/// Eight floats.
struct F8 {
    using Mask = Mask8;
    static constexpr unsigned kCount = 8;
    static constexpr unsigned kRows = 1;
    struct Index {
        std::int32_t x[8];
        Index operator+(const Index& other) const noexcept {
            Index sum;
            for (unsigned i = 0; i < kCount; ++i) sum.x[i] = x[i] + other.x[i];
            return sum;
        }
    };
    float x[8];

    /// Loads numbers that are compared bit by bit.
    static Index load_numbers(const std::uint32_t* p) noexcept {
        Index result;
        for (unsigned i = 0; i < kCount; ++i) result.x[i] = static_cast<std::int32_t>(p[i]);
        return result;
    }
    template <class Rows>
    static Index spread_number(const std::uint32_t* p, const Rows& at) noexcept {
        Index result;
        for (std::int32_t& lane : result.x) lane = static_cast<std::int32_t>(p[at.first]);
        return result;
    }

    F8() noexcept = default;
    explicit F8(float value) noexcept {
        for (float& lane : x) lane = value;
    }
    static F8 load(const float* p) noexcept {
        F8 result;
        for (unsigned i = 0; i < kCount; ++i) result.x[i] = p[i];
        return result;
    }
    /// Loads six floats as a padded box: 0, 1, 2, none, 3, 4, 5, none. None is 0.
    static F8 load_box(const float* p) noexcept {
        F8 result(0);
        for (unsigned i = 0; i < 3; ++i) {
            result.x[i] = p[i];
            result.x[i + 4] = p[i + 3];
        }
        return result;
    }
    static Index load_index(const std::uint16_t* p) noexcept {
        Index result;
        for (unsigned i = 0; i < kCount; ++i) result.x[i] = p[i];
        return result;
    }
    static Index gather_index(const std::int32_t* base, const Index& at) noexcept {
        Index result;
        for (unsigned i = 0; i < kCount; ++i) result.x[i] = base[at.x[i]];
        return result;
    }
    /// Picks from eight floats.
    static F8 pick(const float* p, const Index& at) noexcept {
        return gather(p, at);
    }
    static F8 gather(const float* base, const Index& at) noexcept {
        F8 result;
        for (unsigned i = 0; i < kCount; ++i) result.x[i] = base[at.x[i]];
        return result;
    }
    /// Returns one of eight floats, the same for all lanes.
    template <class Rows>
    static F8 spread(const float* p, const Rows& at) noexcept {
        return F8(p[at.first]);
    }
    /// Stores first + i for each bit i that is set, one after the other. May write eight.
    static void store_lanes(unsigned bits, unsigned first, unsigned /*second*/,
                            std::uint16_t* to) noexcept {
        assert(bits >> kCount == 0);
        for (unsigned i = 0; i < kCount; ++i) {
            *to = static_cast<std::uint16_t>(first + i);
            to += (bits >> i) & 1;
        }
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
    /// Finds the largest of many lanes.
    class Deepest {
    public:
        /// Adds the lanes of a row whose bits are set, among the lowest eight: numbers 8 row + i.
        /// NaN counts as the largest.
        template <class Rows>
        void add(const F8& depth, unsigned bits, const Rows& at) noexcept {
            for (bits &= 0xff; bits != 0; bits &= bits - 1) {
                const auto i = format::lowest_set_bit(bits);
                if (depth.x[i] <= most_) continue;
                most_ = depth.x[i];
                bit_ = static_cast<unsigned>(kLanes * at.first) + i;
            }
        }
        [[nodiscard]] unsigned bit() const noexcept {
            return bit_;
        }

    private:
        float most_ = -1;
        unsigned bit_ = 0;
    };
    static Mask none() noexcept {
        return {0};
    }
    void store_row(float* p) const noexcept {
        store(p);
    }
    void store(float* p) const noexcept {
        for (unsigned i = 0; i < kCount; ++i) p[i] = x[i];
    }
};

inline F8::Index shifted_right(const F8::Index& a, int by) noexcept {
    F8::Index result;
    for (unsigned i = 0; i < F8::kCount; ++i) result.x[i] = a.x[i] >> by;
    return result;
}
/// Returns the lowest three bits.
inline F8::Index low_bits(const F8::Index& a) noexcept {
    F8::Index result;
    for (unsigned i = 0; i < F8::kCount; ++i) result.x[i] = a.x[i] & 7;
    return result;
}

inline Mask8 equal(const F8::Index& a, const F8::Index& b) noexcept {
    unsigned mask = 0;
    for (unsigned i = 0; i < F8::kCount; ++i) {
        mask |= static_cast<unsigned>(a.x[i] == b.x[i]) << i;
    }
    return {mask};
}

/// Returns operation(lane) for each lane.
template <class Operation>
F8 each(Operation operation) noexcept {
    F8 result;
    for (unsigned i = 0; i < F8::kCount; ++i) result.x[i] = operation(i);
    return result;
}

inline F8 operator+(const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return a.x[i] + b.x[i]; });
}
inline F8 operator-(const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return a.x[i] - b.x[i]; });
}
inline F8 operator*(const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return a.x[i] * b.x[i]; });
}
inline F8 operator-(const F8& a) noexcept {
    return each([&](unsigned i) { return -a.x[i]; });
}
inline F8 operator/(const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return a.x[i] / b.x[i]; });
}
inline F8 root(const F8& a) noexcept {
    return each([&](unsigned i) { return std::sqrt(a.x[i]); });
}
inline F8 fma(const F8& a, const F8& b, const F8& c) noexcept {
    return each([&](unsigned i) { return a.x[i] * b.x[i] + c.x[i]; });
}
/// Returns a b - c.
inline F8 fms(const F8& a, const F8& b, const F8& c) noexcept {
    return each([&](unsigned i) { return a.x[i] * b.x[i] - c.x[i]; });
}
inline F8 min(const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return a.x[i] < b.x[i] ? a.x[i] : b.x[i]; });
}
inline F8 max(const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return a.x[i] > b.x[i] ? a.x[i] : b.x[i]; });
}
inline F8 abs(const F8& a) noexcept {
    return each([&](unsigned i) { return a.x[i] < 0 ? -a.x[i] : a.x[i]; });
}
inline Mask8 greater(const F8& a, const F8& b) noexcept {
    unsigned mask = 0;
    for (unsigned i = 0; i < F8::kCount; ++i) {
        mask |= static_cast<unsigned>(a.x[i] > b.x[i]) << i;
    }
    return {mask};
}
inline F8 select(Mask8 where, const F8& a, const F8& b) noexcept {
    return each([&](unsigned i) { return ((where.x >> i) & 1) != 0 ? a.x[i] : b.x[i]; });
}

/// Returns the last four lanes, then the first four.
inline F8 halves_exchanged(const F8& a) noexcept {
    return each([&](unsigned i) { return a.x[i ^ 4]; });
}

/// Eight doubles.
struct D8 {
    double x[8];

    D8() noexcept = default;
    explicit D8(double value) noexcept {
        for (double& lane : x) lane = value;
    }
    static D8 load(const double* p) noexcept {
        D8 result;
        for (unsigned i = 0; i < 8; ++i) result.x[i] = p[i];
        return result;
    }
    void store(double* p) const noexcept {
        for (unsigned i = 0; i < 8; ++i) p[i] = x[i];
    }
};

template <class Operation>
D8 each_double(Operation operation) noexcept {
    D8 result;
    for (unsigned i = 0; i < 8; ++i) result.x[i] = operation(i);
    return result;
}

inline D8 operator+(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return a.x[i] + b.x[i]; });
}
inline D8 operator-(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return a.x[i] - b.x[i]; });
}
inline D8 operator*(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return a.x[i] * b.x[i]; });
}
inline D8 max(const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return a.x[i] > b.x[i] ? a.x[i] : b.x[i]; });
}
inline D8 abs(const D8& a) noexcept {
    return each_double([&](unsigned i) { return a.x[i] < 0 ? -a.x[i] : a.x[i]; });
}
inline Mask8 greater(const D8& a, const D8& b) noexcept {
    unsigned mask = 0;
    for (unsigned i = 0; i < 8; ++i) mask |= static_cast<unsigned>(a.x[i] > b.x[i]) << i;
    return {mask};
}
inline D8 select(Mask8 where, const D8& a, const D8& b) noexcept {
    return each_double([&](unsigned i) { return ((where.x >> i) & 1) != 0 ? a.x[i] : b.x[i]; });
}

inline D8 doubles_of(const F8& a) noexcept {
    return each_double([&](unsigned i) { return double{a.x[i]}; });
}
inline F8 floats_of(const D8& a) noexcept {
    return each([&](unsigned i) { return static_cast<float>(a.x[i]); });
}

}  // namespace
}  // namespace cdprep::kernels

#include "table_of.h"

namespace cdprep::kernels {

const Table kScalar = table_of<F8, F8, D8>("scalar");

}  // namespace cdprep::kernels
