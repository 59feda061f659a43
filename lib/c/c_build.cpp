// SPDX-License-Identifier: MIT
#include "cdprep/c/build.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "c/c_model.h"
#include "c/c_workspace.h"
#include "cdprep/advanced/build_image.h"
#include "cdprep/advanced/build_model.h"
#include "cdprep/format/float_environment.h"
#include "core/share_out.h"

namespace cdprep::c {

template <>
struct Input<cdprep_build_options> {
    static const InputType type;
    static cdprep_build_options defaults() noexcept {
        return {};
    }
};

namespace {

using format::Double3;
using format::Float3;
using format::Triangle;

constexpr std::array kFields = {
    Field{"precision", offsetof(cdprep_build_options, precision), Holds::choice, CDPREP_SINGLE},
};

constexpr Name kOptions = {"options"};

/// The queries that sections of build_model() serve.
constexpr Ask kBuildable = Ask::collide | Ask::overlap | Ask::distance | Ask::within |
                           Ask::continuous | Ask::self | Ask::deform | Ask::tear | Ask::haptic |
                           Ask::inside | Ask::ray | Ask::closest | Ask::touch | Ask::corners |
                           Ask::solid;

static_assert(alignof(cdprep_model) <= CDPREP_ALIGNMENT);
static_assert(CDPREP_ALIGNMENT % format::kSectionAlignment == 0);
static_assert(sizeof(Double3) == 3 * sizeof(double) && alignof(Double3) == alignof(double));
static_assert(sizeof(Float3) == 3 * sizeof(float) && alignof(Float3) == alignof(float));
static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t) &&
              alignof(Triangle) == alignof(std::uint32_t));

/// The offset of each part of the model's block: the object, the image, the index.
struct Layout {
    std::uint64_t image = aligned(sizeof(cdprep_model));
    std::uint64_t index;
    std::uint64_t size;

    /// `indexed` is a number of triangles plus a number of vertices; see index_size().
    Layout(std::uint64_t image_size, std::uint64_t indexed) noexcept
        : index(image + image_size), size(index + indexed * sizeof(std::uint32_t)) {}
};

/// Checked options of a build. The contents of arrays are checked later.
struct Planned {
    cdprep_build_options options{};
    cdprep_allocator allocator{};
    build::PlannedModel model;
    std::size_t size = 0;  ///< of a block that is large enough

    [[nodiscard]] std::span<const Double3> doubles() const noexcept {
        return {reinterpret_cast<const Double3*>(options.positions), model.vertex_count};
    }
    [[nodiscard]] std::span<const Float3> floats() const noexcept {
        return {reinterpret_cast<const Float3*>(options.positions_f32), model.vertex_count};
    }
    [[nodiscard]] std::span<const Triangle> triangles() const noexcept {
        return {reinterpret_cast<const Triangle*>(options.triangles), model.triangle_count};
    }
};

int check_arrays(Call& call, const cdprep_build_options& options) noexcept {
    const bool has_doubles = options.positions != nullptr;
    const bool has_floats = options.positions_f32 != nullptr;
    if (options.vertex_count > 0 && !has_doubles && !has_floats) {
        return call.refuse(CDPREP_WHY_NULL, kOptions.of("positions"),
                           "is null, and so is options.positions_f32; one of them must be set.");
    }
    if (options.triangle_count > 0) {
        if (const int code = call.need(options.triangles, kOptions.of("triangles"))) return code;
    }
    if (!has_doubles || !has_floats) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_NO_MEANING, kOptions.of("positions_f32"),
                       "is set, and so is options.positions; only one of them may be set.");
}

/// Refuses more elements than a model has, or than memory holds.
int check_count(Call& call, const char* field, std::size_t count, std::size_t element_size,
                std::uint32_t most) noexcept {
    if (count > most) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kOptions.of(field),
                           "is %zu; a model has at most %u.", count, most);
    }
    if (count <= PTRDIFF_MAX / element_size) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kOptions.of(field), "is more than memory holds.");
}

/// Refuses queries that need sections which build_model() does not make.
int check_buildable(Call& call, std::uint32_t ask) noexcept {
    const Ask refused = without(static_cast<Ask>(ask), kBuildable);
    for (const Needs& row : needs()) {
        if (!contains(refused, row.ask)) continue;
        return call.refuse(
            CDPREP_WHY_NOT_BAKED, kOptions.of("ask"),
            "is 0x%x, but models built in memory do not serve %s. Bake the mesh with %s.", ask,
            row.name, row.bake_option);
    }
    return CDPREP_OK;
}

/// Computes the rest of the plan from the checked options.
int plan(Call& call, Planned& planned) noexcept {
    const cdprep_build_options& options = planned.options;
    const bool is_single = options.positions_f32 != nullptr || options.precision == CDPREP_SINGLE;
    const Ask asks = options.ask == 0 ? kBuildable : static_cast<Ask>(options.ask);
    build::PlannedModel& model = planned.model;
    model.vertex_count = static_cast<std::uint32_t>(options.vertex_count);
    model.triangle_count = static_cast<std::uint32_t>(options.triangle_count);
    model.precision =
        is_single ? build::Precision::single_precision : build::Precision::double_precision;
    model.wanted = sections_for(asks);
    // Only pair queries read oriented boxes, which cost time and memory.
    const bool is_oriented = model.wanted.contains(SectionId::oriented_nodes);
    model.bounds = is_oriented ? build::BvhBounds::oriented : build::BvhBounds::aligned;
    const std::uint64_t indexed = std::uint64_t{model.triangle_count} + model.vertex_count;
    const Layout most(build::image_size_bound(model), indexed);
    if (most.size > PTRDIFF_MAX) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kOptions.of("triangle_count"),
                           "is %zu: the model is larger than memory.", options.triangle_count);
    }
    planned.size = static_cast<std::size_t>(most.size);
    return CDPREP_OK;
}

int read(Call& call, const cdprep_build_options* given, Planned& planned) noexcept {
    if (const int code = read_input(call, kOptions, given, planned.options)) return code;
    const cdprep_build_options& options = planned.options;
    const std::size_t position_size =
        3 * (options.positions_f32 != nullptr ? sizeof(float) : sizeof(double));
    if (const int code = check_arrays(call, options)) return code;
    if (const int code =
            read_allocator(call, kOptions.of("allocator"), options.allocator, planned.allocator)) {
        return code;
    }
    if (const int code = check_asks(call, kOptions.of("ask"), options.ask)) return code;
    if (const int code = check_buildable(call, options.ask)) return code;
    if (const int code = check_count(call, "vertex_count", options.vertex_count, position_size,
                                     format::kMaxVertices)) {
        return code;
    }
    if (const int code = check_count(call, "triangle_count", options.triangle_count,
                                     sizeof(Triangle), format::kMaxTriangles)) {
        return code;
    }
    return plan(call, planned);
}

/// Returns the index of the first number that is NaN or beyond `most`, or `count`.
template <class Real>
std::size_t find_wrong(const Real* numbers, std::size_t count, double most) noexcept {
    const format::FloatEnvironment environment;
    for (std::size_t i = 0; i < count; ++i) {
        if (!(std::fabs(double{numbers[i]}) <= most)) return i;
    }
    return count;
}

template <class Real>
int check_positions(Call& call, const char* field, const Real* numbers, std::size_t vertex_count,
                    double most) noexcept {
    const std::size_t wrong = find_wrong(numbers, 3 * vertex_count, most);
    if (wrong == 3 * vertex_count) return CDPREP_OK;
    const format::FloatEnvironment environment;
    const double number{numbers[wrong]};
    const Name vertex = kOptions.of(field, wrong / 3);
    if (const int code = check_numbers(call, vertex, Holds::number, &number, 1)) return code;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, vertex,
                       "is %.17g; with CDPREP_SINGLE it must be at most %.9g in magnitude.", number,
                       most);
}

int check_triangles(Call& call, const cdprep_build_options& options) noexcept {
    for (std::size_t i = 0; i < 3 * options.triangle_count; ++i) {
        if (options.triangles[i] < options.vertex_count) continue;
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kOptions.of("triangles", i / 3),
                           "has vertex %u, but the mesh has %zu vertices.", options.triangles[i],
                           options.vertex_count);
    }
    return CDPREP_OK;
}

/// Checks the contents of the arrays.
int check_mesh(Call& call, const Planned& planned) noexcept {
    const cdprep_build_options& options = planned.options;
    const bool is_rounded = options.positions != nullptr && options.precision == CDPREP_SINGLE;
    const double most =
        is_rounded ? double{std::numeric_limits<float>::max()} : format::kMaxCoordinate;
    const int code =
        options.positions_f32 != nullptr
            ? check_positions(call, "positions_f32", options.positions_f32, options.vertex_count,
                              most)
            : check_positions(call, "positions", options.positions, options.vertex_count, most);
    return code != CDPREP_OK ? code : check_triangles(call, options);
}

/// The lanes of a workspace as threads for the builders. Builders submit any number of tasks, which
/// may throw. The caller's `run` gets one task per lane and no exception.
class BuildersThreads {
public:
    explicit BuildersThreads(const cdprep_workspace& workspace) noexcept : workspace_(workspace) {}

    void operator()(std::size_t count, Task task) const {
        const CallersThreads threads(workspace_);
#if defined(__cpp_exceptions)
        std::atomic<bool> has_failed = false;
        std::exception_ptr thrown;
        share_jobs(count, workspace_.lanes.size(), threads, [&](std::size_t i, std::size_t) {
            if (has_failed.load(std::memory_order_relaxed)) return;
            try {
                task(i);
            } catch (...) {
                if (!has_failed.exchange(true)) thrown = std::current_exception();
            }
        });
        if (thrown != nullptr) std::rethrow_exception(thrown);
#else
        share_jobs(count, workspace_.lanes.size(), threads,
                   [&](std::size_t i, std::size_t) { task(i); });
#endif
    }

private:
    const cdprep_workspace& workspace_;
};

std::vector<Float3> rounded(std::span<const Double3> positions) {
    const format::FloatEnvironment environment;
    std::vector<Float3> floats;
    floats.reserve(positions.size());
    for (const Double3& p : positions) {
        floats.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    return floats;
}

Result<build::ModelArrays> built_arrays(const Planned& planned, const BuildersThreads& threads) {
    const build::BvhOptions options = {.parallel_for = threads, .bounds = planned.model.bounds};
    if (planned.options.positions_f32 != nullptr) {
        return build::build_model(planned.floats(), planned.triangles(), options);
    }
    if (planned.model.precision == build::Precision::single_precision) {
        return build::build_model(rounded(planned.doubles()), planned.triangles(), options);
    }
    return build::build_model(planned.doubles(), planned.triangles(), options);
}

/// Lays the arrays out, in the caller's memory or in memory of its own, and opens them as a model.
int lay_out(Call& call, const Planned& planned, const build::ModelArrays& arrays,
            const Given& given, cdprep_model** to) {
    const build::SectionList list = arrays.sections(planned.model.wanted);
    const Result<std::size_t> image_size = build::image_size(list.sections());
    if (!image_size) return call.fail(CDPREP_INTERNAL, image_size.error().message);
    const bool is_one_component = arrays.components.size() <= 1;
    const std::uint64_t indexed = std::uint64_t{arrays.facts.triangle_count} +
                                  (is_one_component ? 0U : arrays.facts.vertex_count);
    const Layout layout(image_size.value(), indexed);
    const auto size = static_cast<std::size_t>(layout.size);
    if (size > planned.size) {
        return call.fail(CDPREP_INTERNAL, "The model is larger than its bound.");
    }
    OwnedMemory own;
    if (given.start == nullptr) {
        if (const int code = own.allocate(call, planned.allocator, size)) return code;
    }
    auto* const block =
        static_cast<std::byte*>(given.start != nullptr ? given.start : own.get().start);
    const Result<std::span<std::byte>> image = build::build_image(
        arrays.facts, list.sections(), {block + layout.image, image_size.value()});
    if (!image) return call.fail(CDPREP_INTERNAL, image.error().message);
    Result<Model> opened =
        Model::open(std::span<const std::byte>(image.value()), {.name = "built model"});
    if (!opened) return call.fail(CDPREP_INTERNAL, opened.error().message);
    *to = new (block) cdprep_model(std::move(opened).value(), own.take(), {}, {});
    make_index(**to, block + layout.index);
    return CDPREP_OK;
}

int build_model(Call& call, const Planned& planned, const Given& given,
                const cdprep_workspace& workspace, cdprep_model** to) {
    const BuildersThreads threads(workspace);
    const Result<build::ModelArrays> arrays = built_arrays(planned, threads);
    if (!arrays) return call.fail(CDPREP_INTERNAL, arrays.error().message);
    return lay_out(call, planned, arrays.value(), given, to);
}

}  // namespace

const InputType Input<cdprep_build_options>::type = {"cdprep_build_options", 0xcd50000aU,
                                                     sizeof(cdprep_build_options),
                                                     sizeof(cdprep_build_options), kFields};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;

void cdprep_build_options_init(cdprep_build_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_model_build_size(const cdprep_build_options* options, size_t* size,
                            cdprep_error* error) {
    Call call(error);
    if (size != nullptr) *size = 0;
    if (const int code = call.need(options, {"options"})) return code;
    if (const int code = call.need(size, {"size"})) return code;
    cdprep::c::Planned planned;
    if (const int code = cdprep::c::read(call, options, planned)) return code;
    *size = planned.size;
    return CDPREP_OK;
}

int cdprep_model_build(const cdprep_build_options* options, void* memory, size_t size,
                       cdprep_workspace* workspace, cdprep_model** model, cdprep_error* error) {
    if (model != nullptr) *model = nullptr;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(options, {"options"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (const int code = call.need(model, {"model"})) return code;
        cdprep::c::Planned planned;
        if (const int code = cdprep::c::read(call, options, planned)) return code;
        if (const int code = cdprep::c::check_mesh(call, planned)) return code;
        const cdprep::c::Given given = {memory, size};
        if (const int code =
                cdprep::c::check_memory(call, given, planned.size, planned.options.allocator)) {
            return code;
        }
        cdprep::c::InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        return cdprep::c::build_model(call, planned, given, *workspace, model);
    });
}
