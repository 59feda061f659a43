// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "support/aligned_bytes.h"
#include "support/every_structure.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/tiny_baker.h"

#include "cdprep/cdprep.h"

// Hostile arguments of the C API, made from the input of a fuzzer.

#define MUST(condition)                                                 \
    do {                                                                \
        if (!(condition)) {                                             \
            std::fprintf(stderr, "%d: not %s\n", __LINE__, #condition); \
            std::abort();                                               \
        }                                                               \
    } while (0)

namespace cdprep::test {

/// The input, taken byte by byte; zeros when it is at its end.
class Draw {
public:
    explicit Draw(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint8_t byte() {
        if (at_ == bytes_.size()) return 0;
        return bytes_[at_++];
    }
    std::uint32_t below(std::uint32_t count) {
        return (byte() | std::uint32_t{byte()} << 8) % count;
    }
    bool one_in(std::uint32_t count) {
        return below(count) == count - 1;
    }
    [[nodiscard]] bool is_at_end() const {
        return at_ == bytes_.size();
    }
    std::uint32_t word() {
        constexpr std::array<std::uint32_t, 8> kWords = {0, 1,  2,           3,
                                                         5, 77, 0x80000000U, 0xffffffffU};
        return kWords[below(kWords.size())];
    }
    double number() {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        constexpr std::array kNumbers = {0.0,
                                         -0.0,
                                         0.5,
                                         1.0,
                                         -1.0,
                                         1.25,
                                         1e-3,
                                         3.0,
                                         1e300,
                                         -1e300,
                                         0x1p1000,
                                         0x1p1001,
                                         0x1p-1060,
                                         std::numeric_limits<double>::denorm_min(),
                                         std::numeric_limits<double>::max(),
                                         kInfinity,
                                         -kInfinity,
                                         std::numeric_limits<double>::quiet_NaN()};
        if (one_in(3)) return static_cast<std::int8_t>(byte()) / 16.0;
        return kNumbers[below(kNumbers.size())];
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

/// Baked models of every kind, open for as long as the program runs.
class Models {
public:
    /// Exact arithmetic decides most questions about a huge model, and takes long.
    explicit Models(bool has_huge_one = true) {
        const TestMesh cube = unit_cube(), ball = icosphere(1);
        TestMesh open = icosphere(1);
        open.triangles.resize(open.triangles.size() / 2);
        TestMesh flat = unit_cube();
        for (auto& p : flat.positions) p.z = 0;
        TestMesh huge = unit_cube();
        for (auto& p : huge.positions) p = {p.x * 0x1p999, p.y * 0x1p999, p.z * 0x1p999};
        add(with_hulls(with_every_structure(with_contacts(with_one_piece(baked(cube))))));
        add(with_every_structure(with_contacts(with_one_piece(baked(ball)))));
        add(with_hulls(baked(open, true)));
        add(baked(flat, true));
        if (has_huge_one) add(baked(huge, true));
        add(baked({}));
        add(baked(cube), CDPREP_ASK_RAY);
        add(baked(cube), CDPREP_ASK_CLOSEST | CDPREP_ASK_INSIDE);
    }
    Models(const Models&) = delete;
    Models& operator=(const Models&) = delete;
    ~Models() {
        for (cdprep_model* model : open_) cdprep_model_close(model);
    }
    const cdprep_model* any(Draw& draw) const {
        if (draw.one_in(20)) return nullptr;
        return open_[draw.below(static_cast<std::uint32_t>(open_.size()))];
    }

private:
    static AlignedBytes baked(const TestMesh& mesh, bool doubles = false) {
        return bake_tiny(mesh.positions, mesh.triangles, {.double_precision = doubles});
    }
    void add(AlignedBytes bytes, std::uint32_t ask = 0) {
        files_.push_back(std::make_unique<AlignedBytes>(std::move(bytes)));
        cdprep_open_options options;
        cdprep_open_options_init(&options, sizeof options);
        options.ask = ask;
        cdprep_model* model = nullptr;
        cdprep_error error;
        const auto file = std::as_const(*files_.back()).span();
        if (cdprep_model_open_memory(file.data(), file.size(), &options, &model, &error) !=
            CDPREP_OK) {
            std::fprintf(stderr, "%s\n", error.message);
            std::abort();
        }
        open_.push_back(model);
    }
    std::vector<std::unique_ptr<AlignedBytes>> files_;
    std::vector<cdprep_model*> open_;
};

/// An input struct with eight bytes behind it, as a longer one of a newer version has them.
template <class T>
struct Longer {
    T value;
    std::uint64_t behind = 0;

    /// Changes what a caller could get wrong about the struct itself.
    void spoil(Draw& draw) {
        if (!draw.one_in(12)) return;
        constexpr auto kSize = static_cast<std::uint32_t>(sizeof(T));
        const std::array<std::uint32_t, 6> sizes = {0, 1, 8, kSize - 8, kSize, kSize + 8};
        value.head.size = sizes[draw.below(sizes.size())];
        if (draw.one_in(4)) value.head.tag = draw.word();
        behind = draw.one_in(2) ? 0 : draw.byte();
        if (draw.one_in(4))
            std::memset(static_cast<void*>(&value), draw.one_in(2) ? 0 : 0xcd, kSize);
    }
};

inline void draw_pose(Draw& draw, cdprep_pose& pose) {
    switch (draw.below(8)) {
        case 0: {
            const std::array<double, 4> q = {draw.number(), draw.number(), draw.number(), 1};
            const std::array<double, 3> t = {draw.number(), draw.number(), draw.number()};
            cdprep_pose made;
            if (cdprep_pose_from_quaternion(q.data(), t.data(), &made, nullptr) == CDPREP_OK) {
                pose = made;
            }
            break;
        }
        case 1:
            pose.rows[draw.below(12)] = draw.number();
            break;
        case 2:
            for (double& number : pose.rows) number = draw.number();
            break;
        case 3:
        case 4:
            for (std::size_t i = 9; i < 12; ++i)
                pose.rows[i] = static_cast<std::int8_t>(draw.byte()) / 32.0;
            break;
        default:
            break;
    }
}

inline bool is_finite(std::span<const double> numbers) {
    for (const double number : numbers) {
        if (!std::isfinite(number)) return false;
    }
    return true;
}

inline bool is_finite(const cdprep_nearest& n) {
    const std::array numbers = {n.lower,   n.upper,   n.on_a[0], n.on_a[1],
                                n.on_a[2], n.on_b[0], n.on_b[1], n.on_b[2]};
    return is_finite(numbers) && n.lower <= n.upper;
}

/// Whether the call was answered; checks what every call promises.
inline bool is_answered(int code, const cdprep_error& error) {
    MUST(code == CDPREP_OK || code == CDPREP_BAD_ARGUMENT);
    MUST(error.code == code && (error.why != 0) == (code == CDPREP_BAD_ARGUMENT));
    MUST((error.message[0] != 0) == (code != CDPREP_OK));
    return code == CDPREP_OK;
}

/// A workspace of some lanes. Their tasks run backwards, and some only by the library.
class Lanes {
public:
    explicit Lanes(std::uint32_t lanes) {
        cdprep_workspace_options options;
        cdprep_workspace_options_init(&options, sizeof options);
        options.lanes = lanes;
        options.run = [](void* /*context*/, std::size_t count, cdprep_task task, const void* work) {
            for (std::size_t i = count; i > 1; --i) task(work, i - 1);
        };
        MUST(cdprep_workspace_make(&options, nullptr, 0, &workspace_, nullptr) == CDPREP_OK);
    }
    Lanes(const Lanes&) = delete;
    Lanes& operator=(const Lanes&) = delete;
    ~Lanes() {
        cdprep_workspace_end(workspace_);
    }
    [[nodiscard]] cdprep_workspace* get() const {
        return workspace_;
    }

private:
    cdprep_workspace* workspace_ = nullptr;
};

}  // namespace cdprep::test
