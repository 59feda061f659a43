// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/star_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "crossings/arc.h"
#include "crossings/triangle_meeting.h"
#include "mesh/around_edge.h"
#include "mesh/point_tree.h"

namespace cdprep::mesh {
namespace {

/// More triangles than this at an edge form a book: seen from the ends of the edge, all overlap
/// there.
constexpr std::size_t kBook = 256;

/// A triangle as seen from the vertex: an arc of less than half a turn between two directions.
/// The arc lies in the ball over its chord.
struct Arc {
    Double3 centre;
    double radius;
    std::uint32_t triangle;
    std::uint32_t book;  ///< kNone: in no book

    [[nodiscard]] int size_class() const {
        return std::ilogb(radius);
    }
    [[nodiscard]] Box box(double more) const {
        const double r = radius + more;
        return {{centre.x - r, centre.y - r, centre.z - r},
                {centre.x + r, centre.y + r, centre.z + r}};
    }
};

/// Arcs of one size in one book, or in no book.
struct ArcTree {
    std::uint32_t book;
    int size_class;
    std::vector<std::uint32_t> arc;
    PointTree centres;
};

}  // namespace

class StarPairs::Search {
public:
    Search(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star)
        : mesh_(mesh), vertex_(vertex) {
        for (const std::uint32_t triangle : star) {
            for (const std::uint32_t spoke : spokes_of(triangle)) ++uses_[spoke];
        }
        std::erase_if(uses_, [](const auto& spoke) { return spoke.second <= kBook; });
        for (const std::uint32_t triangle : star) arcs_.push_back(arc_of(triangle));
        grow_trees();
        for (const auto& [spoke, uses] : uses_) open_book(spoke);
    }

    /// Handles one arc per call; after the arcs, one page per call.
    bool advance(const Visit& visit) {
        if (next_arc_ < arcs_.size()) {
            for (const ArcTree& tree : trees_) ask(next_arc_, tree, visit);
            ++next_arc_;
            return true;
        }
        if (next_page_ == pages_.size()) return false;
        for (std::size_t j = pages_[next_page_].first; j < next_page_; ++j) {
            const auto [a, b] = std::minmax({pages_[j].use / 3, pages_[next_page_].use / 3});
            visit(a, b);
        }
        ++next_page_;
        return true;
    }

private:
    [[nodiscard]] std::array<std::uint32_t, 2> spokes_of(std::uint32_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        if (v[0] == vertex_) return {v[1], v[2]};
        return {v[0], v[1] == vertex_ ? v[2] : v[1]};
    }

    [[nodiscard]] Arc arc_of(std::uint32_t triangle) const {
        const auto [p, q] = spokes_of(triangle);
        const Ball ball =
            arc_ball(mesh_.positions[vertex_], mesh_.positions[p], mesh_.positions[q]);
        return {ball.centre, ball.radius, triangle, book_of(p, q)};
    }

    /// Returns the spoke with more triangles, if either has many.
    [[nodiscard]] std::uint32_t book_of(std::uint32_t p, std::uint32_t q) const {
        const auto uses = [this](std::uint32_t spoke) {
            const auto found = uses_.find(spoke);
            return found == uses_.end() ? 0 : found->second;
        };
        if (uses(p) == 0 && uses(q) == 0) return kNone;
        return uses(p) >= uses(q) ? p : q;
    }

    void grow_trees() {
        std::map<std::pair<std::uint32_t, int>, std::vector<std::uint32_t>> kinds;
        for (std::uint32_t i = 0; i < arcs_.size(); ++i) {
            kinds[{arcs_[i].book, arcs_[i].size_class()}].push_back(i);
        }
        for (auto& [kind, arcs] : kinds) {
            std::vector<Double3> centres;
            for (const std::uint32_t i : arcs) centres.push_back(arcs_[i].centre);
            trees_.push_back(
                {kind.first, kind.second, std::move(arcs), PointTree(std::move(centres))});
        }
    }

    /// Visits the pairs of an arc with those arcs of a tree that are not smaller.
    void ask(std::uint32_t i, const ArcTree& tree, const Visit& visit) const {
        const Arc& arc = arcs_[i];
        const int size_class = arc.size_class();
        if (tree.size_class < size_class) return;
        if (arc.book == tree.book && arc.book != kNone) return;
        const Box around = arc.box(std::ldexp(2.0, tree.size_class));
        const Box box = arc.box(0);
        tree.centres.visit([&around](const Box& centres) { return around.meets(centres); },
                           [&](std::uint32_t number) {
                               const std::uint32_t j = tree.arc[number];
                               if (tree.size_class == size_class && j <= i) return;
                               if (box.meets(arcs_[j].box(0))) visit_pair(i, j, visit);
                           });
    }

    void visit_pair(std::uint32_t i, std::uint32_t j, const Visit& visit) const {
        const auto [a, b] = std::minmax(arcs_[i].triangle, arcs_[j].triangle);
        visit(a, b);
    }

    /// Sorts the pages of one book by their angle around its edge.
    void open_book(std::uint32_t spoke) {
        std::vector<HalfEdge> uses;
        for (const Arc& arc : arcs_) {
            if (arc.book == spoke) uses.push_back(use_of(arc.triangle, spoke));
        }
        if (uses.empty()) return;
        const AroundEdge around(mesh_.positions, mesh_.triangles, uses);
        const std::vector<HalfEdge> sorted = around.sorted(uses);
        std::size_t first = pages_.size();
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            if (i > 0 && !at_one_angle(sorted[i - 1], sorted[i])) first = pages_.size();
            pages_.push_back({sorted[i], first});
        }
    }

    [[nodiscard]] HalfEdge use_of(std::uint32_t triangle, std::uint32_t spoke) const {
        for (HalfEdge h = 3 * triangle;; ++h) {
            const std::uint32_t start = start_of(mesh_.triangles, h);
            const std::uint32_t end = end_of(mesh_.triangles, h);
            if (std::minmax(start, end) == std::minmax(vertex_, spoke)) return h;
        }
    }

    [[nodiscard]] bool at_one_angle(HalfEdge a, HalfEdge b) const {
        const auto apex = [this](HalfEdge h) { return apex_of(mesh_.triangles, h); };
        if (apex(a) == apex(b)) return true;
        const auto corners = [&](HalfEdge h) {
            return Corners{mesh_.positions[start_of(mesh_.triangles, h)],
                           mesh_.positions[end_of(mesh_.triangles, h)], mesh_.positions[apex(h)]};
        };
        return meeting_at_edge(corners(a), corners(b)).has_value();
    }

    /// A triangle of a book, and the first page at its angle.
    struct Page {
        HalfEdge use;
        std::size_t first;
    };

    const Mesh& mesh_;
    std::uint32_t vertex_;
    std::map<std::uint32_t, std::size_t> uses_;  ///< by spoke with a book: its triangles
    std::vector<Arc> arcs_;
    std::vector<ArcTree> trees_;
    std::vector<Page> pages_;
    std::uint32_t next_arc_ = 0;
    std::size_t next_page_ = 0;
};

StarPairs::StarPairs(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star)
    : search_(std::make_unique<Search>(mesh, vertex, star)) {}
StarPairs::StarPairs(StarPairs&&) noexcept = default;
StarPairs& StarPairs::operator=(StarPairs&&) noexcept = default;
StarPairs::~StarPairs() = default;

bool StarPairs::advance(const Visit& visit) {
    return search_->advance(visit);
}

}  // namespace cdprep::mesh
