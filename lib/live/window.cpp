// SPDX-License-Identifier: MIT
#include "cdprep/window.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "build/bad_argument.h"
#include "build/frame_map.h"
#include "build/make_nodes.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/advanced/section_list.h"
#include "cdprep/format/float_environment.h"
#include "core/carver.h"
#include "core/moved_model.h"
#include "core/require.h"
#include "core/triangle_facts.h"
#include "live/image_table.h"
#include "live/spread.h"
#include "walk/box_placement.h"
#include "walk/near_leaves.h"
#include "walk/proven_gap.h"

// A window is the image of a model with room for all its leaves. A fill replaces leaves, boxes and
// numbers, and then what the header says about them. Each place of a leaf has three corners of its
// own. Leaves that hold model coordinates without loss need no positions. Positions and triangles
// are then hidden from the queries.

namespace cdprep {
namespace {

using build::bad_argument;
using format::BvhLeaf;
using format::BvhNode;
using format::kBvhWidth;
using format::OrientedNode;
using format::SectionId;
using format::Triangle;

constexpr std::size_t kCornersOfLeaf = std::size_t{3} * kBvhWidth;
constexpr Ask kServed = Ask::collide | Ask::overlap | Ask::distance | Ask::within | Ask::ray |
                        Ask::closest | Ask::touch;

/// With 32 bits, memory does not hold the largest windows.
std::optional<Error> find_size_fault(std::uint64_t size) {
    if (size <= PTRDIFF_MAX) return std::nullopt;
    return bad_argument("The window needs at least " + std::to_string(size) +
                        " bytes, more than memory holds.");
}

std::optional<Error> find_fault(const WindowLimits& limits) {
    if (limits.leaves >= 1 && limits.leaves <= kMostWindowLeaves) {
        constexpr std::uint64_t kLeast = sizeof(BvhLeaf) + kCornersOfLeaf * sizeof(Double3);
        return find_size_fault(limits.leaves * kLeast);  // before the image takes memory
    }
    return bad_argument("A window of " + std::to_string(limits.leaves) +
                        " leaves cannot be made: the number must be 1 to " +
                        std::to_string(kMostWindowLeaves) + ".");
}

/// Sets the oriented boxes of a node to its boxes. An unused box, from 1 to -1, gets half extents
/// of -1, as it should.
void orient_boxes(const BvhNode& node, OrientedNode& to) noexcept {
    for (std::size_t box = 0; box < kBvhWidth; ++box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float lower = node.lower[axis][box], upper = node.upper[axis][box];
            const float middle = (lower + upper) / 2;
            const double half = std::max(double{upper} - middle, middle - double{lower});
            to.centre[axis][box] = middle;
            to.half[axis][box] = build::float_above(half);
            to.axis[0][axis][box] = axis == 0 ? 1 : 0;
            to.axis[1][axis][box] = axis == 1 ? 1 : 0;
        }
    }
}

void copy_oriented(const OrientedNode& from, std::size_t at, OrientedNode& to,
                   std::size_t place) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
        to.axis[0][k][place] = from.axis[0][k][at];
        to.axis[1][k][place] = from.axis[1][k][at];
        to.centre[k][place] = from.centre[k][at];
        to.half[k][place] = from.half[k][at];
    }
}

/// The arrays of a window in which every triangle is a point at 0, for the first image.
class EmptyWindow {
public:
    explicit EmptyWindow(std::uint32_t leaves)
        : positions_(leaves * kCornersOfLeaf),
          triangles_(std::size_t{leaves} * kBvhWidth),
          source_(triangles_.size()),
          nodes_(format::bvh_shape(leaves * kBvhWidth).node_count),
          leaves_(leaves),
          marks_((triangles_.size() + 63) / 64) {
        for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
            triangles_[i].vertex = {3 * i, 3 * i + 1, 3 * i + 2};
        }
        std::iota(source_.begin(), source_.end(), 0U);
        for (BvhLeaf& leaf : leaves_) leaf.count = kBvhWidth;
        const format::BvhShape shape = format::bvh_shape(leaves * kBvhWidth);
        for (std::uint32_t i = 0; i < shape.count[0]; ++i) {
            build::set_unused_boxes(nodes_[shape.first[0] + i], shape.used_boxes(0, i));
        }
        build::make_nodes(nodes_, leaves * kBvhWidth, serial_for);
        oriented_.resize(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) orient_boxes(nodes_[i], oriented_[i]);
        list_.add(SectionId::positions_f64, positions_);
        list_.add(SectionId::triangles, triangles_);
        list_.add(SectionId::source_triangle, source_);
        list_.add(SectionId::bvh_nodes, nodes_);
        list_.add(SectionId::bvh_leaves, leaves_);
        list_.add(SectionId::oriented_nodes, oriented_);
        list_.add(SectionId::degenerate_bits, marks_);
        facts_.triangle_count = leaves * kBvhWidth;
        facts_.vertex_count = static_cast<std::uint32_t>(positions_.size());
    }
    EmptyWindow(const EmptyWindow&) = delete;
    EmptyWindow& operator=(const EmptyWindow&) = delete;

    [[nodiscard]] std::span<const build::Section> sections() const {
        return list_.sections();
    }
    [[nodiscard]] const format::FileHeader& facts() const {
        return facts_;
    }

private:
    std::vector<Double3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> source_;
    std::vector<BvhNode> nodes_;
    std::vector<BvhLeaf> leaves_;
    std::vector<OrientedNode> oriented_;
    std::vector<std::uint64_t> marks_;
    build::SectionList list_;
    format::FileHeader facts_{};
};

/// What a window keeps behind its image.
struct WindowTables {
    WindowTables(Carver& carver, std::uint32_t leaves) noexcept
        : lanes(carver.take<std::uint8_t>(leaves), leaves),
          kept(carver.take<std::uint32_t>(leaves), leaves),
          items(carver.take<SpreadItem>(leaves), leaves) {}

    std::span<std::uint8_t> lanes;  ///< per leaf: the places that have a triangle
    std::span<std::uint32_t> kept;  ///< the leaves of A
    std::span<SpreadItem> items;    ///< the same, with places, while they are arranged
};

Result<std::size_t> bytes_of(const WindowLimits& limits, const EmptyWindow& empty) {
    const Result<std::size_t> image = build::image_size(empty.sections());
    if (!image) return image.error();
    Carver carver(nullptr);
    const WindowTables tables(carver, limits.leaves);
    const std::uint64_t size = std::uint64_t{*image} + carver.used();
    if (const auto fault = find_size_fault(size)) return *fault;
    return static_cast<std::size_t>(size);
}

/// The places of a leaf that have a triangle.
std::uint8_t lanes_of(const Model& model, std::uint32_t leaf) noexcept {
    unsigned lanes = 0;
    each_in_leaf(model, leaf, [&](std::uint32_t place) {
        lanes |= 1U << (place % kBvhWidth);
        return true;
    });
    return static_cast<std::uint8_t>(lanes);
}

void copy_box(const BvhNode& from, std::size_t at, BvhNode& to, std::size_t place) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        to.lower[axis][place] = from.lower[axis][at];
        to.upper[axis][place] = from.upper[axis][at];
    }
}

}  // namespace

struct Window::State {
    State(std::span<std::byte> bytes, Model opened, const WindowTables& with) noexcept
        : image(bytes),
          model(std::move(opened)),
          positions(elements_of<Double3>(bytes, SectionId::positions_f64)),
          triangles(elements_of<Triangle>(bytes, SectionId::triangles)),
          source(elements_of<std::uint32_t>(bytes, SectionId::source_triangle)),
          nodes(elements_of<BvhNode>(bytes, SectionId::bvh_nodes)),
          leaves(elements_of<BvhLeaf>(bytes, SectionId::bvh_leaves)),
          oriented(elements_of<OrientedNode>(bytes, SectionId::oriented_nodes)),
          marks(elements_of<std::uint64_t>(bytes, SectionId::degenerate_bits)),
          tables(with) {}

    /// Finds the leaves within the largest radius that fits, up to `radius`. Returns that radius,
    /// and their number in `count`.
    double find_leaves(const Model& a, const Model& b, const Placement& placement, double radius,
                       std::size_t& count) noexcept;
    /// Sorts the leaves so that those of each node are near each other.
    void arrange_leaves(const Model& a, std::size_t count) noexcept;
    void copy_leaves(const Model& a, std::size_t count) noexcept;
    void copy_corners(const Model& a, std::uint32_t leaf, std::size_t to) noexcept;
    void orient_nodes(const format::BvhShape& shape) noexcept;
    /// Writes what follows from the number of leaves, and the facts that are those of A.
    void update(const Model& a, std::size_t count) noexcept;

    std::span<std::byte> image;
    Model model;
    std::span<Double3> positions;
    std::span<Triangle> triangles;
    std::span<std::uint32_t> source;
    std::span<BvhNode> nodes;
    std::span<BvhLeaf> leaves;
    std::span<OrientedNode> oriented;
    std::span<std::uint64_t> marks;
    WindowTables tables;
    WindowFill filled;
    PairCache when_filled;  ///< the placement, and the radius as the gap
};

double Window::State::find_leaves(const Model& a, const Model& b, const Placement& placement,
                                  double radius, std::size_t& count) noexcept {
    const auto fits = [&](double reach) {
        count = find_near_leaves(a, b, placement, reach, tables.kept);
        return count <= tables.kept.size();
    };
    if (fits(radius)) return radius;
    // The slack is at least 2^-47 of the largest coordinates, so no two points are farther apart.
    double too_wide = std::min(radius, double_slack(a, b, placement) * 0x1p49);
    double fitting = too_wide;
    constexpr int kHalvings = 20;
    for (int i = 0; i < kHalvings && !fits(fitting = too_wide / 2); ++i) too_wide = fitting;
    if (count > tables.kept.size()) return fits(0) ? 0 : -1;
    constexpr int kTries = 4;
    for (int i = 0; i < kTries; ++i) {
        const double between = (fitting + too_wide) / 2;
        (fits(between) ? fitting : too_wide) = between;
    }
    return fits(fitting) ? fitting : -1;
}

/// A's order leaves gaps where leaves are missing. Nodes of eight leaves in that order would be far
/// larger than A's, and a query would open twice as many.
void Window::State::arrange_leaves(const Model& a, std::size_t count) noexcept {
    const std::uint32_t lowest = a.bvh().shape.first[0];
    const std::span<SpreadItem> items = tables.items.first(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t leaf = tables.kept[i];
        const BvhNode& node = a.bvh().nodes[lowest + leaf / kBvhWidth];
        SpreadItem& item = items[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            item.middle[axis] =
                node.lower[axis][leaf % kBvhWidth] + node.upper[axis][leaf % kBvhWidth];
        }
        item.id = leaf;
    }
    spread(items, static_cast<std::uint32_t>((count + kBvhWidth - 1) / kBvhWidth), Fill::full);
    for (std::size_t i = 0; i < count; ++i) tables.kept[i] = items[i].id;
}

void Window::State::copy_corners(const Model& a, std::uint32_t leaf, std::size_t to) noexcept {
    const MovedModel still(a, nullptr);
    const std::uint32_t last = a.triangle_count() - 1;
    for (std::uint32_t lane = 0; lane < kBvhWidth; ++lane) {
        const Corners corners = still.corners(std::min(leaf * kBvhWidth + lane, last));
        std::ranges::copy(
            corners, positions.begin() +
                         static_cast<std::ptrdiff_t>(to * kCornersOfLeaf + std::size_t{3} * lane));
    }
}

void Window::State::copy_leaves(const Model& a, std::size_t count) noexcept {
    const std::span<const BvhNode> from = a.bvh().nodes;
    const std::span<const OrientedNode> from_oriented = a.bvh().oriented;
    const std::uint32_t lowest = a.bvh().shape.first[0];
    const std::span<const std::uint64_t> degenerate = a.mesh().degenerate_bits;
    const bool is_exact = a.has_exact_leaves();
    const std::uint32_t lowest_here =
        format::bvh_shape(static_cast<std::uint32_t>(count * kBvhWidth)).first[0];
    std::ranges::fill(marks, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t leaf = tables.kept[i];
        leaves[i] = a.bvh().leaves[leaf];
        tables.lanes[i] = lanes_of(a, leaf);
        const std::size_t node = lowest + leaf / kBvhWidth, here = lowest_here + i / kBvhWidth;
        copy_box(from[node], leaf % kBvhWidth, nodes[here], i % kBvhWidth);
        if (!from_oriented.empty()) {
            copy_oriented(from_oriented[node], leaf % kBvhWidth, oriented[here], i % kBvhWidth);
        }
        const std::size_t first = std::size_t{leaf} * kBvhWidth;
        const std::size_t used = std::min<std::size_t>(kBvhWidth, a.triangle_count() - first);
        std::ranges::copy(a.source().triangle.subspan(first, used),
                          source.begin() + static_cast<std::ptrdiff_t>(i * kBvhWidth));
        if (!degenerate.empty()) {
            const std::uint64_t of_leaf = (degenerate[first / 64] >> (first % 64)) & 0xff;
            marks[i * kBvhWidth / 64] |= of_leaf << (i * kBvhWidth % 64);
        }
        if (!is_exact) copy_corners(a, leaf, i);
    }
}

/// The boxes around leaves have those of A. A box farther up has no other leaves of A's below, so
/// it gets the axes of the frame.
void Window::State::orient_nodes(const format::BvhShape& shape) noexcept {
    for (std::uint32_t i = 0; i < shape.first[0]; ++i) orient_boxes(nodes[i], oriented[i]);
    const std::uint32_t last = shape.count[0] - 1;
    OrientedNode unused;
    BvhNode none;
    build::set_unused_boxes(none, 0);
    orient_boxes(none, unused);
    for (std::size_t box = shape.used_boxes(0, last); box < kBvhWidth; ++box) {
        copy_oriented(unused, box, oriented[shape.first[0] + last], box);
    }
}

void Window::State::update(const Model& a, std::size_t count) noexcept {
    const auto leaf_count = static_cast<std::uint32_t>(count);
    const std::uint32_t places = leaf_count * kBvhWidth;
    const format::BvhShape shape = format::bvh_shape(places);
    const bool is_oriented = !a.bvh().oriented.empty();
    if (count > 0) {
        const std::uint32_t last = shape.count[0] - 1;
        build::set_unused_boxes(nodes[shape.first[0] + last], shape.used_boxes(0, last));
        build::make_nodes(nodes.first(shape.node_count), places, serial_for);
        if (is_oriented) orient_nodes(shape);
    }
    const bool has_corners = !a.has_exact_leaves();
    model.set_leaves(leaf_count, has_corners ? positions : std::span<Double3>(),
                     has_corners ? triangles : std::span<Triangle>(),
                     is_oriented ? oriented : std::span<OrientedNode>());
    model.set_torn(a.triangle_number_bound());
    format::FileHeader facts = a.header();
    facts.flags &= std::uint32_t{format::model_exact_leaves};
    facts.triangle_count = places;
    facts.vertex_count = static_cast<std::uint32_t>(positions.size());
    // A cache must tell these leaves of A from all others.
    ImageTable table(image);
    for (format::SectionEntry& entry : table.entries()) {
        if (entry.id == SectionId::bvh_nodes) entry.checksum = a.header().content_hash;
        if (entry.id == SectionId::bvh_leaves) {
            entry.checksum = format::checksum(std::as_bytes(tables.kept.first(count)));
        }
    }
    table.write(facts);
}

Window::Window(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;
Window::~Window() = default;

Result<std::size_t> Window::bytes(const WindowLimits& limits) {
    const format::FloatEnvironment environment;
    if (const auto fault = find_fault(limits)) return *fault;
    return bytes_of(limits, EmptyWindow(limits.leaves));
}

Result<Window> Window::in(std::span<std::byte> memory, const WindowLimits& limits) {
    const format::FloatEnvironment environment;
    if (const auto fault = find_fault(limits)) return *fault;
    const EmptyWindow empty(limits.leaves);
    const Result<std::size_t> size = bytes_of(limits, empty);
    if (!size) return size.error();
    if (memory.size() < *size) {
        return bad_argument("The window needs " + std::to_string(*size) + " bytes, but " +
                            std::to_string(memory.size()) + " were given.");
    }
    const Result<std::span<std::byte>> image =
        build::build_image(empty.facts(), empty.sections(), memory);
    if (!image) return image.error();
    Result<Model> opened = Model::open(std::span<const std::byte>(*image), {.name = "window"});
    if (!opened) return opened.error();
    Carver carver(image->data() + image->size());
    auto state = std::make_unique<State>(*image, std::move(opened).value(),
                                         WindowTables(carver, limits.leaves));
    state->model.set_part(kServed);
    state->model.set_lanes(state->tables.lanes, 0);
    Window window(std::move(state));
    window.clear();
    return window;
}

void Window::clear() noexcept {
    ImageTable table(state_->image);
    format::FileHeader facts = format::read_header(state_->image);
    facts.triangle_count = 0;
    table.write(facts);
    state_->model.set_leaves(0, {}, {}, {});
    state_->model.set_torn(0);
    state_->filled = {};
    state_->when_filled = {};
}

WindowFill Window::fill(const Pair& pair, double radius) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    if (&a == &state_->model || &b == &state_->model) {
        stop_with("Neither model of Window::fill() may be the model of the window itself.");
    }
    require(a, b, Ask::distance);
    clear();
    if (!(radius >= 0)) return {};
    State& state = *state_;
    std::size_t count = 0;
    const bool is_empty = a.triangle_count() == 0 || b.triangle_count() == 0;
    if (!is_empty) radius = state.find_leaves(a, b, pair.placement, radius, count);
    if (radius < 0) return {};
    state.arrange_leaves(a, count);
    state.copy_leaves(a, count);
    state.update(a, count);
    state.filled = {radius, static_cast<std::uint32_t>(count)};
    if (b.triangle_count() > 0) {
        const double gap = is_empty ? std::numeric_limits<double>::infinity() : radius;
        remember_gap(state.when_filled, state.model, b, pair.placement, gap);
    }
    return state.filled;
}

WindowFill Window::filled() const noexcept {
    return state_->filled;
}

const Model& Window::model() const noexcept {
    return state_->model;
}

double Window::margin(const Model& probe, const Placement& placement) const noexcept {
    const format::FloatEnvironment environment;
    if (probe.triangle_count() == 0) return std::numeric_limits<double>::infinity();
    const double left = gap_left(state_->when_filled, state_->model, probe, placement);
    // The bounds of distances may be off by rounding that is less than one more slack.
    return left - double_slack(state_->model, probe, placement);
}

BoundedDistance Window::distance(const Pair& pair, Workspace& workspace,
                                 const DistanceOptions& options,
                                 const DistanceBudget& budget) const noexcept {
    const format::FloatEnvironment environment;
    if (&pair.a.get() != &state_->model) {
        stop_with("Model A of Window::distance() must be the model of the window.");
    }
    BoundedDistance found = bounded_distance(pair, workspace, options, {.work = budget.work});
    // The share covers the width of a distance's interval, with room. Answers about A are then the
    // same, bit for bit.
    constexpr double kShare = 1 - 0x1p-30;
    const double beyond = margin(pair.b, pair.placement) * kShare;
    const bool is_sure = found.upper == 0 || std::min(found.upper, options.max_distance) <= beyond;
    found.is_complete = found.is_complete && is_sure;
    if (!found.is_complete) {
        found.lower = std::min(found.lower, std::max(0.0, beyond));
        if (found.nearest) found.nearest->lower = found.lower;
    }
    if (budget.last != nullptr) budget.last->note(pair.placement, found);
    return found;
}

}  // namespace cdprep
