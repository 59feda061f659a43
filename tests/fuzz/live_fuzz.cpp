// SPDX-License-Identifier: MIT
// A live model that tears and deforms, with numbers of any kind. A list of its triangles and brute
// force are the oracle. A change that is refused must change nothing.
#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "hostile_input.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace {

using namespace cdprep;        // NOLINT(google-build-using-namespace): a program of its own
using namespace cdprep::test;  // NOLINT(google-build-using-namespace)
using format::Triangle;

constexpr std::uint32_t kMostTriangles = 120;
constexpr std::uint32_t kMostVertices = 40;
constexpr int kMostChanges = 48;

/// A mesh that does not move, and what is asked about it.
struct Fixed {
    TestMesh mesh = icosphere(1);
    OpenModel model = open_tiny(mesh, {.double_precision = true});
    Workspace workspace;
};

Fixed& fixed() {
    static Fixed once;
    return once;
}

/// A live model, and what it should hold.
class Torn {
public:
    explicit Torn(Draw& draw) : draw_(draw) {
        const TestMesh base = random_soup(draw.byte(), draw.below(40), 0.5);
        const auto arrays = build::build_model(base.positions, base.triangles,
                                               {.bounds = build::BvhBounds::aligned});
        MUST(arrays);
        const auto vertices = static_cast<std::uint32_t>(base.positions.size());
        limits_ = {
            static_cast<std::uint32_t>(base.triangles.size()) + draw.below(kMostTriangles) + 1,
            vertices + draw.below(kMostVertices) + 1};
        LiveLimits spoilt = limits_;
        (draw.one_in(2) ? spoilt.triangles : spoilt.vertices) = draw.word();
        static_cast<void>(LiveModel::bytes(arrays.value(), spoilt));
        const auto size = LiveModel::bytes(arrays.value(), limits_);
        MUST(size);
        memory_ = AlignedBytes(size.value());
        auto made = LiveModel::in(memory_.span(), arrays.value(), limits_);
        MUST(made);
        live_.emplace(std::move(made).value());
        positions_ = base.positions;
        positions_.resize(limits_.vertices);
        has_position_.resize(limits_.vertices);
        for (const Triangle& t : base.triangles) {
            for (const std::uint32_t v : t.vertex) has_position_[v] = true;
        }
        for (std::uint32_t i = 0; i < base.triangles.size(); ++i) triangles_[i] = base.triangles[i];
        next_ = static_cast<std::uint32_t>(base.triangles.size());
    }

    void change() {
        if (draw_.one_in(8)) MUST(live_->rebuild(draw_.below(3) * 200) <= 400);
        switch (draw_.below(5)) {
            case 0:
                return append();
            case 1:
                return remove();
            case 2:
                return move_all();
            default:
                return move_some();
        }
    }

    void check() {
        MUST(live_->triangle_count() == triangles_.size());
        TestMesh mesh{positions_, {}};
        std::vector<std::uint32_t> numbers;
        for (const auto& [number, triangle] : triangles_) {
            mesh.triangles.push_back(triangle);
            numbers.push_back(number);
        }
        const Placement placement = Placement::b_moves({});
        std::vector<TrianglePair> expected = brute_force_pairs(mesh, fixed().mesh, placement);
        for (TrianglePair& pair : expected) pair.a = numbers[pair.a];
        std::sort(expected.begin(), expected.end());
        std::vector<TrianglePair> own = own_pairs(mesh);
        for (TrianglePair& each : own) each = {numbers[each.a], numbers[each.b]};
        MUST(all_own_pairs(live_->model(), fixed().workspace) == own);
        const Pair pair{live_->model(), fixed().model.model, placement, {}, &cache_};
        MUST(all_pairs(pair.a, pair.b, placement, fixed().workspace) == expected);
        MUST((collide(pair, fixed().workspace).hit == Answer::yes) == !expected.empty());
        const auto near = distance(pair, fixed().workspace);
        MUST(near.has_value() == !numbers.empty());
        if (near) {
            MUST(triangles_.contains(near->triangle_a));
            MUST((near->upper == 0) == !expected.empty());
        }
        std::vector<std::uint32_t> all(numbers.size() + 1);
        const double far = 0x1p1002;
        all.resize(touching_triangles(live_->model(), Box{{-far, -far, -far}, {far, far, far}},
                                      fixed().workspace, all));
        MUST(all == numbers);
    }

private:
    double coordinate() {
        return draw_.one_in(24) ? draw_.number() : static_cast<std::int8_t>(draw_.byte()) / 64.0;
    }
    static bool is_good(const Double3& p) {
        const auto fits = [](double x) { return std::fabs(x) <= 0x1p1000; };
        return fits(p.x) && fits(p.y) && fits(p.z);
    }

    void append() {
        std::vector<Triangle> added(draw_.below(24));
        bool is_good = added.size() + triangles_.size() <= limits_.triangles;
        for (Triangle& t : added) {
            for (std::uint32_t& v : t.vertex) {
                v = draw_.one_in(64) ? draw_.word() : draw_.below(limits_.vertices);
                is_good = is_good && v < limits_.vertices && has_position_[v];
            }
        }
        const auto first = live_->append(added);
        MUST(first.ok() == is_good);
        if (!is_good) return;
        MUST(first.value() == next_);
        for (const Triangle& t : added) triangles_[next_++] = t;
    }

    void remove() {
        std::vector<std::uint32_t> numbers;
        for (const auto& [number, triangle] : triangles_) {
            if (draw_.one_in(4)) numbers.push_back(number);
        }
        if (draw_.one_in(8)) numbers.push_back(draw_.word());
        const bool is_good = std::all_of(numbers.begin(), numbers.end(), [&](std::uint32_t number) {
            return triangles_.contains(number);
        });
        MUST(live_->remove(numbers).ok() == is_good);
        if (!is_good) return;
        for (const std::uint32_t number : numbers) triangles_.erase(number);
    }

    void move_some() {
        std::vector<std::uint32_t> vertices;
        std::vector<Double3> to;
        bool all_good = true;
        for (std::uint32_t count = draw_.below(12); count > 0; --count) {
            vertices.push_back(draw_.one_in(64) ? draw_.word() : draw_.below(limits_.vertices));
            to.push_back({coordinate(), coordinate(), coordinate()});
            all_good = all_good && vertices.back() < limits_.vertices && is_good(to.back());
        }
        MUST(live_->refit(vertices, to).ok() == all_good);
        if (!all_good) return;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            positions_[vertices[i]] = to[i];
            has_position_[vertices[i]] = true;
        }
    }

    void move_all() {
        std::vector<Double3> to = positions_;
        to.resize(live_->position_count());
        const double by = coordinate();
        for (Double3& p : to) p.x += by * p.y;
        const bool all_good = std::all_of(to.begin(), to.end(), is_good);
        MUST(live_->refit(to).ok() == all_good);
        if (!all_good) return;
        std::copy(to.begin(), to.end(), positions_.begin());
        std::fill_n(has_position_.begin(), to.size(), true);
    }

    Draw& draw_;
    LiveLimits limits_;
    AlignedBytes memory_{0};
    std::optional<LiveModel> live_;
    PairCache cache_;
    std::vector<Double3> positions_;
    std::vector<bool> has_position_;
    std::map<std::uint32_t, Triangle> triangles_;
    std::uint32_t next_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Draw draw({data, size});
    Torn torn(draw);
    torn.check();
    for (int i = 0; i < kMostChanges && !draw.is_at_end(); ++i) {
        torn.change();
        // Brute force takes long where coordinates differ by many powers of two.
        if (draw.one_in(12)) torn.check();
    }
    torn.check();
    return 0;
}
