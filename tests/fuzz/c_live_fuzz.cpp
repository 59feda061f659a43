// SPDX-License-Identifier: MIT
// Live models, sweeps and windows of the C API, with arguments of any kind. What a sweep denies
// must not be found at the ends of its step. What a window calls complete must be the distance of
// the large model. A change that is refused must change nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "hostile_input.h"

#include "cdprep/cdprep.h"

namespace {

using namespace cdprep::test;  // NOLINT(google-build-using-namespace): a program of its own

constexpr std::uint32_t kMostTriangles = 400;
constexpr std::uint32_t kMostVertices = 200;
constexpr int kMostSteps = 24;

/// A model of a ball, a small probe, and windows onto the ball. They stay for the whole program.
struct Rigid {
    AlignedBytes ball_file = bake(icosphere(3)), probe_file = bake(icosphere(1));
    cdprep_model* ball = open(ball_file);
    cdprep_model* probe = open(probe_file);

    static AlignedBytes bake(const TestMesh& mesh) {
        return bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
    }
    static cdprep_model* open(const AlignedBytes& file) {
        cdprep_model* model = nullptr;
        MUST(cdprep_model_open_memory(file.span().data(), file.span().size(), nullptr, &model,
                                      nullptr) == CDPREP_OK);
        return model;
    }
};

const Rigid& rigid() {
    static const Rigid once;
    return once;
}

double small(Draw& draw) {
    return static_cast<std::int8_t>(draw.byte()) / 64.0;
}

/// A number that is small or refused. Exact arithmetic takes long where numbers differ by many
/// powers of two; the other targets draw them.
double small_or_refused(Draw& draw) {
    const double number = draw.number();
    const double size = std::fabs(number);
    return (size > 8 && size <= 0x1p1000) || (size > 0 && size < 1e-3) ? 1 : number;
}

cdprep_pose shifted(double x, double y, double z) {
    return {{1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}};
}

/// A live ball that deforms and tears under a sweep.
class Swept {
public:
    explicit Swept(Draw& draw) : draw_(draw), lanes_(1 + draw.below(2)) {
        Longer<cdprep_live_options> given{};
        cdprep_live_options& o = given.value;
        cdprep_live_options_init(&o, sizeof o);
        o.model = rigid().probe;
        if (draw.one_in(2)) {
            o.max_triangles = kMostTriangles;
            o.max_vertices = kMostVertices;
        }
        tears_ = o.max_triangles != 0;
        Longer<cdprep_live_options> spoilt = given;
        (draw.one_in(2) ? spoilt.value.max_triangles : spoilt.value.max_vertices) = draw.word();
        spoilt.spoil(draw);
        std::size_t size = 99;
        if (spoilt.value.max_triangles <= kMostTriangles &&
            !is_answered(cdprep_live_size(&spoilt.value, &size, &error_), error_)) {
            MUST(size == 0);
        }
        MUST(is_answered(cdprep_live_size(&o, &size, &error_), error_));
        memory_ = AlignedBytes(size);
        MUST(cdprep_live_make(&o, memory_.span().data(), size, &live_, &error_) == CDPREP_OK);
        MUST(cdprep_sweep_make(cdprep_live_model(live_), nullptr, nullptr, 0, &sweep_, &error_) ==
             CDPREP_OK);
    }
    Swept(const Swept&) = delete;
    Swept& operator=(const Swept&) = delete;
    ~Swept() {
        cdprep_sweep_end(sweep_);
        cdprep_live_end(live_);
    }

    void step() {
        MUST(cdprep_sweep_start_step(sweep_, &error_) == CDPREP_OK);
        cdprep_motion motion = drawn_motion();
        const bool is_hostile = draw_.one_in(16);
        if (is_hostile) (draw_.one_in(2) ? motion.shift : motion.turn)[1] = small_or_refused(draw_);
        const bool touched_before = touches(0, motion);
        for (std::uint32_t changes = draw_.below(4); changes > 0; --changes) change();
        MUST(cdprep_sweep_finish_step(sweep_, &error_) == CDPREP_OK);
        std::uint32_t may_touch = 9;
        const bool is_known = is_answered(cdprep_sweep_may_touch(sweep_, rigid().ball, &motion,
                                                                 lanes_.get(), &may_touch, &error_),
                                          error_);
        MUST(is_known ? may_touch <= CDPREP_YES : may_touch == CDPREP_UNKNOWN);
        if (!is_known) {
            MUST(is_hostile);
            return;
        }
        // What was removed within the step is not in its boxes.
        const bool touches_then = touches(1, motion) || (touched_before && !has_removed_);
        if (touches_then) MUST(may_touch == CDPREP_YES);
        list(motion, may_touch);
        has_removed_ = false;
    }

private:
    cdprep_motion drawn_motion() {
        cdprep_moving_pair both;
        cdprep_moving_pair_init(&both, sizeof both);
        cdprep_motion motion = both.motion_b;
        motion.start = shifted(4 * small(draw_), small(draw_), small(draw_));
        motion.given_by = CDPREP_MOTION_VELOCITY;
        for (double& x : motion.shift) x = small(draw_);
        if (draw_.one_in(2)) motion.turn[draw_.below(3)] = 2 * small(draw_);
        return motion;
    }
    /// Whether the live model touches the ball at a time of the motion.
    bool touches(double time, const cdprep_motion& motion) {
        cdprep_pair pair;
        cdprep_pair_init(&pair, sizeof pair);
        pair.a = cdprep_live_model(live_);
        pair.b = rigid().ball;
        pair.moving = CDPREP_MOVE_B;
        if (!is_answered(cdprep_motion_pose(&motion, time, &pair.pose_b, &error_), error_)) {
            return false;
        }
        cdprep_collision found{};
        MUST(cdprep_collide(&pair, lanes_.get(), &found, &error_) == CDPREP_OK);
        return found.hit == CDPREP_YES;
    }
    void list(const cdprep_motion& motion, std::uint32_t may_touch) {
        std::array<cdprep_overlap, 8> items{};
        cdprep_overlap_list list = {items.data(), draw_.below(9), 99};
        MUST(cdprep_sweep_pairs(sweep_, rigid().ball, &motion, lanes_.get(), &list, &error_) ==
             CDPREP_OK);
        MUST((list.count > 0) == (may_touch == CDPREP_YES));
        cdprep_live_info info{};
        MUST(cdprep_live_describe(live_, &info, &error_) == CDPREP_OK);
        for (std::size_t i = 0; i < std::min(list.count, list.room); ++i) {
            MUST(items[i].a < info.number_bound);
        }
    }

    void change() {
        switch (draw_.below(6)) {
            case 0:
                return append();
            case 1:
                return remove();
            case 2:
                return read();
            case 3:
                return rebuild();
            default:
                return move();
        }
    }
    void move() {
        std::array<std::uint32_t, 6> vertices{};
        std::array<double, 18> to{};
        for (std::uint32_t& v : vertices) v = draw_.one_in(40) ? draw_.word() : draw_.below(42);
        for (double& x : to) x = draw_.one_in(60) ? small_or_refused(draw_) : 2 * small(draw_);
        Longer<cdprep_live_move> given{};
        cdprep_live_move_init(&given.value, sizeof given.value);
        if (!draw_.one_in(20)) given.value.vertices = vertices.data();
        if (!draw_.one_in(20)) given.value.positions = to.data();
        given.value.count = draw_.below(7);
        given.spoil(draw_);
        (void)is_answered(cdprep_live_refit(live_, &given.value, lanes_.get(), &error_), error_);
    }
    void rebuild() {
        std::uint32_t taken = 9;
        MUST(cdprep_live_rebuild(live_, 10 * draw_.below(99), &taken, &error_) == CDPREP_OK);
        cdprep_live_info info{};
        MUST(cdprep_live_describe(live_, &info, &error_) == CDPREP_OK);
        MUST(taken <= info.triangles);
    }
    /// What the live model lists and stores of itself.
    void read() {
        std::array<cdprep_live_triangle, 8> items{};
        cdprep_live_triangle_list list = {items.data(), draw_.below(9), 99};
        if (is_answered(cdprep_live_triangles(live_, &list, &error_), error_)) {
            MUST(tears_);
            cdprep_live_info info{};
            MUST(cdprep_live_describe(live_, &info, &error_) == CDPREP_OK);
            MUST(list.count == info.triangles);
            for (std::size_t i = 0; i < std::min(list.count, list.room); ++i) {
                MUST(items[i].number < info.number_bound && items[i].vertex[2] < kMostVertices);
                MUST(i == 0 || items[i - 1].number < items[i].number);
            }
        } else {
            MUST(!tears_ && list.count == 0);
        }
        cdprep_array image{};
        MUST(is_answered(cdprep_live_image(live_, &image, &error_), error_) == !tears_);
        if (tears_) return;
        AlignedBytes copy(image.count);
        std::memcpy(copy.span().data(), image.data, image.count);
        cdprep_model* model = nullptr;
        MUST(cdprep_model_open_memory(copy.span().data(), image.count, nullptr, &model, &error_) ==
             CDPREP_OK);
        cdprep_model_close(model);
    }
    void append() {
        std::array<std::uint32_t, 9> triangles{};
        for (std::uint32_t& v : triangles) v = draw_.one_in(40) ? draw_.word() : draw_.below(42);
        std::uint32_t first = 99;
        const int code =
            cdprep_live_append(live_, triangles.data(), draw_.below(4), &first, &error_);
        if (!is_answered(code, error_))
            MUST(first == CDPREP_NONE);
        else
            MUST(tears_);
    }
    void remove() {
        std::array<std::uint32_t, 4> numbers{};
        for (std::uint32_t& n : numbers) n = draw_.one_in(20) ? draw_.word() : draw_.below(100);
        const std::size_t count = draw_.below(5);
        const int code = cdprep_live_remove(live_, numbers.data(), count, &error_);
        if (is_answered(code, error_)) has_removed_ = true;
    }

    Draw& draw_;
    Lanes lanes_;
    AlignedBytes memory_{0};
    cdprep_live* live_ = nullptr;
    cdprep_sweep* sweep_ = nullptr;
    bool tears_ = false, has_removed_ = false;
    cdprep_error error_{};
};

/// A window onto the ball, near a probe that moves.
class Windowed {
public:
    explicit Windowed(Draw& draw) : draw_(draw), lanes_(1) {
        Longer<cdprep_window_options> given{};
        cdprep_window_options_init(&given.value, sizeof given.value);
        given.value.max_leaves = 1 + draw.below(200);
        Longer<cdprep_window_options> spoilt = given;
        spoilt.spoil(draw);
        if (draw.one_in(2)) spoilt.value.max_leaves = draw.word();
        std::size_t size = 99;
        if (!is_answered(cdprep_window_size(&spoilt.value, &size, &error_), error_))
            MUST(size == 0);
        MUST(cdprep_window_size(&given.value, &size, &error_) == CDPREP_OK);
        memory_ = AlignedBytes(size);
        MUST(cdprep_window_make(&given.value, memory_.span().data(), size, &window_, &error_) ==
             CDPREP_OK);
    }
    Windowed(const Windowed&) = delete;
    Windowed& operator=(const Windowed&) = delete;
    ~Windowed() {
        cdprep_window_end(window_);
    }

    void step() {
        if (draw_.one_in(3)) fill();
        cdprep_pair in_window = pair_of(cdprep_window_model(window_));
        double margin = 99;
        if (draw_.one_in(20)) in_window.a = draw_.one_in(2) ? rigid().ball : nullptr;
        if (!is_answered(cdprep_window_margin(&in_window, &margin, &error_), error_)) return;
        MUST(std::fabs(margin) <= 0x1p1000);
        Longer<cdprep_distance_options> options{};
        cdprep_distance_options_init(&options.value, sizeof options.value);
        if (draw_.one_in(4)) options.value.max_distance = draw_.number();
        options.spoil(draw_);
        cdprep_bounded found{};
        const std::uint64_t work = draw_.one_in(2) ? 0 : draw_.below(400);
        if (!is_answered(cdprep_window_distance(&in_window, &options.value, work, lanes_.get(),
                                                &found, &error_),
                         error_)) {
            MUST(found.complete == CDPREP_UNKNOWN);
            return;
        }
        MUST(found.complete <= CDPREP_YES && is_finite(found.nearest));
        compare(found, options.value, margin);
    }

private:
    cdprep_pair pair_of(const cdprep_model* a) const {
        cdprep_pair pair;
        cdprep_pair_init(&pair, sizeof pair);
        pair.a = a;
        pair.b = rigid().probe;
        pair.moving = CDPREP_MOVE_B;
        pair.pose_b = shifted(at_[0], at_[1], at_[2]);
        return pair;
    }
    void fill() {
        for (double& x : at_) x = 3 * small(draw_);
        const cdprep_pair pair = pair_of(rigid().ball);
        cdprep_window_info info{};
        const double radius = draw_.one_in(3) ? draw_.number() : std::fabs(small(draw_));
        const int code = cdprep_window_fill(window_, &pair, radius, &info, &error_);
        MUST(is_answered(code, error_) ==
             (radius >= 0 && (radius <= 0x1p1000 || std::isinf(radius))));
        for (double& x : at_) x += small(draw_) / 4;
    }
    /// Against the distance of the large model.
    void compare(const cdprep_bounded& found, const cdprep_distance_options& options,
                 double margin) {
        const cdprep_pair pair = pair_of(rigid().ball);
        cdprep_nearest full{};
        MUST(cdprep_distance(&pair, &options, lanes_.get(), &full, &error_) == CDPREP_OK);
        if (found.complete == CDPREP_NO) {
            if (full.found == CDPREP_YES) MUST(found.lower <= full.upper);
            return;
        }
        MUST(found.nearest.found == full.found);
        if (full.found == CDPREP_NO) return;
        MUST(found.nearest.lower == full.lower && found.nearest.upper == full.upper);
        MUST(full.upper == 0 || full.lower <= margin);
    }

    Draw& draw_;
    Lanes lanes_;
    AlignedBytes memory_{0};
    cdprep_window* window_ = nullptr;
    std::array<double, 3> at_{};
    cdprep_error error_{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Draw draw({data, size});
    Swept swept(draw);
    Windowed windowed(draw);
    for (int i = 0; i < kMostSteps && !draw.is_at_end(); ++i) {
        if (draw.one_in(2))
            swept.step();
        else
            windowed.step();
    }
    return 0;
}
