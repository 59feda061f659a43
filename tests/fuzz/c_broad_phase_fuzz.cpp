// SPDX-License-Identifier: MIT
// The broad phase of the C API, with boxes and arguments of any kind. All boxes against all are the
// oracle. An update that is refused must change nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "hostile_input.h"

#include "cdprep/cdprep.h"

namespace {

using namespace cdprep::test;  // NOLINT(google-build-using-namespace): a program of its own

constexpr std::uint32_t kMostBoxes = 20;
constexpr float kLargest = std::numeric_limits<float>::max();

/// Boxes that move, and their pairs by brute force.
class Boxes {
public:
    explicit Boxes(Draw& draw) : draw_(draw), lanes_(1 + draw.below(3)) {
        Longer<cdprep_broad_phase_options> given{};
        cdprep_broad_phase_options& o = given.value;
        cdprep_broad_phase_options_init(&o, sizeof o);
        o.max_boxes = count_ = 1 + draw.below(kMostBoxes);
        o.max_pairs = draw.below(60);
        o.lanes = 1 + draw.below(3);
        most_pairs_ = o.max_pairs;
        cdprep_broad_phase_options spoilt = o;
        (&spoilt.max_boxes)[draw.below(4)] = draw.word();
        std::size_t size = 99;
        if (!is_answered(cdprep_broad_phase_size(&spoilt, &size, &error_), error_)) MUST(size == 0);
        MUST(is_answered(cdprep_broad_phase_size(&o, &size, &error_), error_));
        memory_ = AlignedBytes(size);
        std::memset(memory_.span().data(), draw.byte(), size);
        MUST(cdprep_broad_phase_make(&o, memory_.span().data(), size, &broad_phase_, &error_) ==
             CDPREP_OK);
        for (std::uint32_t i = 0; i < count_; ++i) change(i);
    }
    Boxes(const Boxes&) = delete;
    Boxes& operator=(const Boxes&) = delete;
    ~Boxes() {
        cdprep_broad_phase_end(broad_phase_);
    }

    void update() {
        if (draw_.one_in(16)) count_ = 1 + draw_.below(count_);  // fewer boxes from now on
        for (std::uint32_t changes = draw_.below(6); changes > 0; --changes) {
            change(draw_.below(count_));
        }
        Longer<cdprep_box_update> given{};
        cdprep_box_update& u = given.value;
        cdprep_box_update_init(&u, sizeof u);
        u.boxes = boxes_.data();
        u.count = count_;
        if (draw_.one_in(8)) has_filters_ = !has_filters_;
        if (has_filters_) u.filters = filters_.data();
        const bool knows_moved = count_ == last_count_ && had_filters_ == has_filters_;
        if (knows_moved && draw_.one_in(2)) {
            if (moved_.empty()) moved_.push_back(0);
            u.moved = moved_.data();
            u.moved_count = static_cast<std::uint32_t>(moved_.size());
        }
        if (draw_.one_in(20)) return update_hostile(given);
        cdprep_box_pairs pairs;
        const int code = cdprep_broad_phase_update(broad_phase_, &u, lanes_.get(), &pairs, &error_);
        const bool has_nan = std::any_of(boxes_.begin(), boxes_.begin() + count_, is_nan);
        MUST(is_answered(code, error_) != has_nan);
        if (has_nan) {
            MUST(error_.why == CDPREP_WHY_NOT_FINITE && pairs.count == 0);
            return;
        }
        last_count_ = count_;
        had_filters_ = has_filters_;
        moved_.clear();
        compare(pairs);
    }

private:
    float coordinate() {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        constexpr std::array kHard = {kInfinity,
                                      -kInfinity,
                                      kLargest,
                                      -kLargest,
                                      0.0F,
                                      -0.0F,
                                      std::numeric_limits<float>::denorm_min(),
                                      1e-30F};
        if (draw_.one_in(8)) return kHard[draw_.below(kHard.size())];
        return static_cast<float>(draw_.byte()) / 16;
    }
    void change(std::uint32_t i) {
        for (int axis = 0; axis < 3; ++axis) {
            const float lower = coordinate();
            boxes_[i].lower[axis] = lower;
            boxes_[i].upper[axis] = draw_.one_in(8) ? coordinate() : lower + draw_.byte() / 64.0F;
        }
        if (draw_.one_in(60)) {
            boxes_[i].upper[draw_.below(3)] = std::numeric_limits<float>::quiet_NaN();
        }
        filters_[i] = {1U << draw_.below(3), draw_.byte() & 7U};
        moved_.push_back(i);
    }
    static bool is_nan(const cdprep_world_box& box) {
        for (int axis = 0; axis < 3; ++axis) {
            if (std::isnan(box.lower[axis]) || std::isnan(box.upper[axis])) return true;
        }
        return false;
    }
    /// Nothing changes: the next update tells.
    void update_hostile(Longer<cdprep_box_update>& given) {
        cdprep_box_update& u = given.value;
        std::array<std::uint32_t, 1> number = {count_ + draw_.below(2)};
        switch (draw_.below(4)) {
            case 0:
                u.boxes = nullptr;
                break;
            case 1:
                u.count = kMostBoxes + 1 + draw_.byte();
                break;
            case 2:
                u.head.tag += 1;
                break;
            default:
                u.moved = number.data();
                u.moved_count = 1;
        }
        cdprep_box_pairs pairs;
        const int code = cdprep_broad_phase_update(broad_phase_, &u, lanes_.get(), &pairs, &error_);
        MUST(!is_answered(code, error_) && pairs.count == 0 && pairs.complete == CDPREP_NO);
    }
    [[nodiscard]] bool meet(std::uint32_t a, std::uint32_t b) const {
        const auto clamped = [](float x) { return std::clamp(x, -kLargest, kLargest); };
        const cdprep_world_box &x = boxes_[a], &y = boxes_[b];
        for (int axis = 0; axis < 3; ++axis) {
            if (x.lower[axis] > x.upper[axis] || y.lower[axis] > y.upper[axis]) return false;
            if (clamped(x.lower[axis]) > clamped(y.upper[axis])) return false;
            if (clamped(y.lower[axis]) > clamped(x.upper[axis])) return false;
        }
        if (!has_filters_) return true;
        const cdprep_box_filter &f = filters_[a], &g = filters_[b];
        return (f.layers & g.accepts) != 0 && (g.layers & f.accepts) != 0;
    }
    void compare(const cdprep_box_pairs& pairs) const {
        std::vector<std::array<std::uint32_t, 2>> expected;
        for (std::uint32_t a = 0; a < count_; ++a) {
            for (std::uint32_t b = a + 1; b < count_; ++b) {
                if (meet(a, b)) expected.push_back({a, b});
            }
        }
        const bool fits = expected.size() <= most_pairs_;
        MUST((pairs.complete == CDPREP_YES) == fits);
        MUST(pairs.needed == (fits ? 0 : expected.size()));
        MUST(pairs.count == (fits ? expected.size() : 0));
        for (std::size_t i = 0; i < pairs.count; ++i) {
            MUST(pairs.items[i].a == expected[i][0] && pairs.items[i].b == expected[i][1]);
        }
    }

    Draw& draw_;
    Lanes lanes_;
    AlignedBytes memory_;
    cdprep_broad_phase* broad_phase_ = nullptr;
    std::array<cdprep_world_box, kMostBoxes> boxes_{};
    std::array<cdprep_box_filter, kMostBoxes> filters_{};
    std::vector<std::uint32_t> moved_;  ///< since the last update that was not refused
    std::uint32_t count_ = 0, last_count_ = 0, most_pairs_ = 0;
    bool has_filters_ = false, had_filters_ = false;
    cdprep_error error_{};
};

constexpr int kMostUpdates = 48;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Draw draw({data, size});
    Boxes boxes(draw);
    for (int i = 0; i < kMostUpdates && !draw.is_at_end(); ++i) boxes.update();
    return 0;
}
