// SPDX-License-Identifier: MIT
#include "cdprep/cdprep.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "cdprep/cast_ray.h"
#include "cdprep/closest_point.h"
#include "cdprep/collide.h"
#include "cdprep/containment.h"
#include "cdprep/crossing_segments.h"
#include "cdprep/distance.h"
#include "cdprep/parallel_for.h"
#include "cdprep/split_overlap.h"
#include "cdprep/touching_box.h"
#include "cdprep/touching_capsule.h"
#include "cdprep/touching_sphere.h"
#include "cdprep/touching_triangle.h"
#include "cdprep/triangles_within.h"
#include "share_out.h"

struct cdprep_model {
    cdprep::Model model;
};

struct cdprep_workspace {
    cdprep::Workspace workspace;
};

struct cdprep_workspaces {
    std::span<cdprep::Workspace> all;
};

namespace cdprep {
namespace {

static_assert(sizeof(cdprep_triangle_pair) == sizeof(TrianglePair) &&
              offsetof(cdprep_triangle_pair, b) == offsetof(TrianglePair, b));
static_assert(sizeof(cdprep_pair_cache) == sizeof(PairCache) &&
              std::is_trivially_copyable_v<PairCache>);
static_assert(sizeof(cdprep_ray_hit) == sizeof(RayHit) &&
              offsetof(cdprep_ray_hit, point) == offsetof(RayHit, point) &&
              offsetof(cdprep_ray_hit, triangle) == offsetof(RayHit, triangle));
static_assert(CDPREP_BAD_ARGUMENT == static_cast<int>(ErrorCode::bad_argument) &&
              CDPREP_UNREADABLE == static_cast<int>(ErrorCode::unreadable) &&
              CDPREP_OVER_BUDGET == static_cast<int>(ErrorCode::over_budget) &&
              CDPREP_INTERNAL == static_cast<int>(ErrorCode::internal));

int fail(cdprep_error* error, int code, std::string_view message) noexcept {
    if (error == nullptr) return code;
    error->code = code;
    const std::size_t length = std::min(message.size(), sizeof error->message - 1);
    std::memcpy(error->message, message.data(), length);
    error->message[length] = 0;
    return code;
}

int fail(cdprep_error* error, const Error& why) noexcept {
    return fail(error, static_cast<int>(why.code), why.message);
}

/// Runs `ask`, which returns a code, and lets no exception out.
template <class Ask>
int guarded(cdprep_error* error, Ask ask) noexcept {
    try {
        return ask();
    } catch (const std::bad_alloc&) {
        return fail(error, CDPREP_OVER_BUDGET, "There is not enough memory.");
    } catch (const std::exception& thrown) {
        return fail(error, CDPREP_INTERNAL, thrown.what());
    } catch (...) {
        return fail(error, CDPREP_INTERNAL, "An unknown exception was thrown.");
    }
}

template <class... Pointers>
bool any_null(Pointers... pointers) noexcept {
    return ((pointers == nullptr) || ...);
}

int null_argument(cdprep_error* error) noexcept {
    return fail(error, CDPREP_BAD_ARGUMENT, "An argument is null that must not be.");
}

/// Copies as much of a sized struct as its maker knew; the rest stays at default.
template <class Options>
bool read_sized(const Options* from, Options& to) noexcept {
    if (from == nullptr) return true;
    if (from->size < sizeof from->size) return false;
    const std::uint32_t size = std::min<std::uint32_t>(from->size, sizeof to);
    std::memcpy(&to, from, size);
    return true;
}

int bad_size(cdprep_error* error) noexcept {
    return fail(error, CDPREP_BAD_ARGUMENT, "The size of a struct is not set; it must be sizeof.");
}

Result<Pose> pose_of(const cdprep_pose& pose) {
    std::array<double, 12> rows{};
    std::copy(std::begin(pose.rows), std::end(pose.rows), rows.begin());
    return Pose::from_rows(rows);
}

/// The placement, or a code with `error` filled.
int read_placement(const cdprep_placement& given, std::optional<Placement>& placement,
                   cdprep_error* error) {
    if (given.size < sizeof given) return bad_size(error);
    const bool reads_a = given.kind != CDPREP_B_MOVES;
    const bool reads_b = given.kind != CDPREP_A_MOVES;
    const Result<Pose> a = reads_a ? pose_of(given.a) : Result<Pose>(Pose());
    if (!a) return fail(error, a.error());
    const Result<Pose> b = reads_b ? pose_of(given.b) : Result<Pose>(Pose());
    if (!b) return fail(error, b.error());
    switch (given.kind) {
        case CDPREP_B_MOVES:
            placement = Placement::b_moves(b.value());
            return CDPREP_OK;
        case CDPREP_A_MOVES:
            placement = Placement::a_moves(a.value());
            return CDPREP_OK;
        case CDPREP_RELATIVE:
            placement = Placement::relative(a.value(), b.value());
            return CDPREP_OK;
        case CDPREP_WORLD:
            placement = Placement::world(a.value(), b.value());
            return CDPREP_OK;
        default:
            return fail(error, CDPREP_BAD_ARGUMENT, "The kind of a placement is not 0 to 3.");
    }
}

CollideOptions contact_options(const cdprep_contact_options& given) noexcept {
    CollideOptions options;
    if (given.as == CDPREP_SOLID) options.as = As::solid;
    if (given.contact == CDPREP_PROPER) options.contact = Contact::proper;
    if (given.degenerate == CDPREP_SKIP_DEGENERATE) options.degenerate = Degenerate::skip;
    return options;
}

DistanceOptions distance_options(const cdprep_distance_options& given) noexcept {
    return {.relative_error = given.relative_error,
            .absolute_error = given.absolute_error,
            .max_distance = given.max_distance,
            .as = given.as == CDPREP_SOLID ? As::solid : As::surface};
}

cdprep_distance_options default_distance_options() noexcept {
    const DistanceOptions defaults;
    return {sizeof(cdprep_distance_options), CDPREP_SURFACE, defaults.relative_error,
            defaults.absolute_error, defaults.max_distance};
}

OverlapOptions overlap_options(const cdprep_contact_options& given) noexcept {
    const CollideOptions options = contact_options(given);
    return {options.contact, options.degenerate};
}

int word(Answer answer) noexcept {
    switch (answer) {
        case Answer::no:
            return CDPREP_NO;
        case Answer::yes:
            return CDPREP_YES;
        default:
            return CDPREP_UNKNOWN;
    }
}

void store(const Double3& p, double* numbers) noexcept {
    numbers[0] = p.x;
    numbers[1] = p.y;
    numbers[2] = p.z;
}

void store(const Collision& found, cdprep_collision& to) noexcept {
    to = {found.hit ? 1 : 0, word(found.containment.answer), found.containment.a_inside_b ? 1 : 0,
          found.containment.winding};
}

void store(const std::optional<Distance>& result, int& found, cdprep_distance& to) noexcept {
    found = result ? 1 : 0;
    to = {};
    if (!result) return;
    to.lower = result->lower;
    to.upper = result->upper;
    store(result->witness_a, to.witness_a);
    store(result->witness_b, to.witness_b);
    to.triangle_a = result->triangle_a;
    to.triangle_b = result->triangle_b;
}

cdprep_crossing crossing_of(const Crossing& crossing) noexcept {
    cdprep_crossing to{};
    to.pair = {crossing.pair.a, crossing.pair.b};
    to.is_flat = crossing.is_flat ? 1 : 0;
    store(crossing.from, to.from);
    store(crossing.to, to.to);
    return to;
}

cdprep_ray_hit hit_of(const RayHit& hit) noexcept {
    cdprep_ray_hit to{};
    to.t = hit.t;
    store(hit.point, to.point);
    to.triangle = hit.triangle;
    return to;
}

std::span<TrianglePair> room_of(cdprep_triangle_pair* pairs, std::size_t room) noexcept {
    return {reinterpret_cast<TrianglePair*>(pairs), room};
}

Double3 point_of(const double* numbers) noexcept {
    return {numbers[0], numbers[1], numbers[2]};
}

Ray ray_of(const double* origin, const double* direction) noexcept {
    return {point_of(origin), point_of(direction)};
}

/// What is asked about a shape, beside the shape.
struct ShapeAsked {
    cdprep_shape shape{};
    TouchOptions options;
    double max_distance = std::numeric_limits<double>::infinity();
};

/// Reads both structs, or returns a code with `error` filled.
int read_shape(const cdprep_shape& shape, const cdprep_shape_options* options, ShapeAsked& asked,
               cdprep_error* error) {
    cdprep_shape_options given{};
    given.max_distance = asked.max_distance;
    if (!read_sized(&shape, asked.shape) || !read_sized(options, given)) return bad_size(error);
    if (shape.size < sizeof shape) return bad_size(error);
    asked.max_distance = given.max_distance;
    if (given.degenerate == CDPREP_SKIP_DEGENERATE) asked.options.degenerate = Degenerate::skip;
    if (given.is_moved == 0) return CDPREP_OK;
    const Result<Pose> pose = pose_of(given.world_from_model);
    if (!pose) return fail(error, pose.error());
    asked.options.world_from_model = pose.value();
    return CDPREP_OK;
}

/// Calls `ask` with the shape that the kind names.
template <class Ask>
int ask_shape(const cdprep_shape& s, cdprep_error* error, Ask ask) {
    switch (s.kind) {
        case CDPREP_BOX:
            return ask(Box{point_of(s.a), point_of(s.b)});
        case CDPREP_SPHERE:
            return ask(Sphere{point_of(s.a), s.radius});
        case CDPREP_CAPSULE:
            return ask(Capsule{point_of(s.a), point_of(s.b), s.radius});
        case CDPREP_TRIANGLE:
            return ask(LooseTriangle{{point_of(s.a), point_of(s.b), point_of(s.c)}});
        default:
            return fail(error, CDPREP_BAD_ARGUMENT, "The kind of a shape is not 0 to 3.");
    }
}

/// What a workspace's scratch takes where another one's follows.
std::size_t scratch_bytes() noexcept {
    return (Workspace::size() + Workspace::alignment() - 1) / Workspace::alignment() *
           Workspace::alignment();
}

/// Beside its scratch, the object itself.
std::size_t workspace_bytes() noexcept {
    return scratch_bytes() + sizeof(Workspace);
}

constexpr std::size_t kWorkspacesObject = sizeof(cdprep_workspaces);
static_assert(alignof(cdprep_workspaces) <= alignof(Workspace));

int opened(Result<Model> result, cdprep_model** model, cdprep_error* error) {
    if (!result) return fail(error, result.error());
    *model = new cdprep_model{std::move(result).value()};
    return CDPREP_OK;
}

/// A question about two models: checks what every such question checks, then asks.
template <class Ask>
int ask_pair(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
             cdprep_workspace* workspace, cdprep_error* error, Ask ask) noexcept {
    if (any_null(a, b, placement, workspace)) return null_argument(error);
    return guarded(error, [&]() -> int {
        std::optional<Placement> placed;
        if (const int code = read_placement(*placement, placed, error)) return code;
        return ask(a->model, b->model, *placed, workspace->workspace);
    });
}

/// Where the C++ questions keep their cache, from and back to the C struct.
class CacheCopy {
public:
    explicit CacheCopy(cdprep_pair_cache* cache) noexcept : outer_(cache) {
        if (cache != nullptr) std::memcpy(static_cast<void*>(&inner_), cache, sizeof inner_);
    }
    CacheCopy(const CacheCopy&) = delete;
    CacheCopy& operator=(const CacheCopy&) = delete;
    ~CacheCopy() {
        if (outer_ != nullptr) std::memcpy(outer_, &inner_, sizeof inner_);
    }
    [[nodiscard]] PairCache* get() noexcept {
        return outer_ == nullptr ? nullptr : &inner_;
    }

private:
    cdprep_pair_cache* outer_;
    PairCache inner_;
};

/// Like every task of a C program's threads: `work` is ours, a Task.
void run_task(const void* work, std::size_t number) {
    (*static_cast<const Task*>(work))(number);
}

/// The threads of a C program, as ParallelFor wants them.
struct CThreads {
    cdprep_parallel_for given;

    void operator()(std::size_t count, Task task) const {
        if (given.run == nullptr) return serial_for(count, task);
        given.run(given.context, count, run_task, &task);
    }
};

/// Whether the job can be asked, or a code with `error` filled.
int check_job(const cdprep_pair_job& job, cdprep_error* error) {
    if (any_null(job.a, job.b, job.placement)) return null_argument(error);
    std::optional<Placement> placed;
    return read_placement(*job.placement, placed, error);
}

/// The first thing that is wrong with a job, and its number.
int check_jobs(std::span<const cdprep_pair_job> jobs, cdprep_error* error) {
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        cdprep_error wrong{};
        const int code = check_job(jobs[i], &wrong);
        if (code == CDPREP_OK) continue;
        return fail(error, code,
                    "Job " + std::to_string(i) + ", the first being 0: " + wrong.message);
    }
    return CDPREP_OK;
}

/// A question about many pairs: checks what every such question checks, then calls
/// `ask(i, a, b, placement, workspace, cache)` for each.
template <class Ask>
int ask_jobs(const cdprep_pair_job* jobs, std::size_t count, cdprep_workspaces* workspaces,
             const cdprep_parallel_for* parallel_for, cdprep_error* error, Ask ask) noexcept {
    if (workspaces == nullptr || (jobs == nullptr && count > 0)) return null_argument(error);
    CThreads threads{};
    if (!read_sized(parallel_for, threads.given)) return bad_size(error);
    return guarded(error, [&]() -> int {
        if (const int code = check_jobs({jobs, count}, error)) return code;
        const std::span<Workspace> all = workspaces->all;
        share_jobs(count, all.size(), threads, [&](std::size_t i, std::size_t worker) {
            const cdprep_pair_job& job = jobs[i];
            std::optional<Placement> placed;
            if (read_placement(*job.placement, placed, nullptr) != CDPREP_OK) return;
            CacheCopy copy(job.cache);
            ask(i, job.a->model, job.b->model, *placed, all[worker], copy.get());
        });
        return CDPREP_OK;
    });
}

}  // namespace
}  // namespace cdprep

using cdprep::Model;
using cdprep::PairCache;
using cdprep::Placement;
using cdprep::Workspace;

int cdprep_open(const char* path, cdprep_model** model, cdprep_error* error) {
    if (cdprep::any_null(path, model)) return cdprep::null_argument(error);
    *model = nullptr;
    return cdprep::guarded(error, [&] { return cdprep::opened(Model::open(path), model, error); });
}

int cdprep_open_memory(const void* bytes, size_t size, const char* name, cdprep_model** model,
                       cdprep_error* error) {
    if (cdprep::any_null(bytes, name, model)) {
        return cdprep::null_argument(error);
    }
    *model = nullptr;
    return cdprep::guarded(error, [&] {
        const std::span<const std::byte> file(static_cast<const std::byte*>(bytes), size);
        return cdprep::opened(Model::open(file, cdprep::SectionSet::all(), name), model, error);
    });
}

int cdprep_open_trusted(const char* path, cdprep_model** model, cdprep_error* error) {
    if (cdprep::any_null(path, model)) return cdprep::null_argument(error);
    *model = nullptr;
    return cdprep::guarded(error,
                           [&] { return cdprep::opened(Model::open_trusted(path), model, error); });
}

void cdprep_close(cdprep_model* model) {
    delete model;
}

uint32_t cdprep_triangle_count(const cdprep_model* model) {
    return model == nullptr ? 0 : model->model.triangle_count();
}

uint32_t cdprep_vertex_count(const cdprep_model* model) {
    return model == nullptr ? 0 : model->model.vertex_count();
}

int cdprep_is_closed(const cdprep_model* model) {
    return model != nullptr && model->model.is_closed() ? 1 : 0;
}

// The workspace's own object lies behind its scratch.
size_t cdprep_workspace_size(void) {
    return Workspace::size() + Workspace::alignment() + sizeof(cdprep_workspace);
}

size_t cdprep_workspace_alignment(void) {
    return Workspace::alignment();
}

cdprep_workspace* cdprep_make_workspace(void* memory, size_t size) {
    if (memory == nullptr || size < cdprep_workspace_size()) return nullptr;
    const std::span<std::byte> bytes(static_cast<std::byte*>(memory), size);
    std::optional<Workspace> workspace = Workspace::in(bytes);
    if (!workspace) return nullptr;
    return new (bytes.data() + cdprep::scratch_bytes()) cdprep_workspace{std::move(*workspace)};
}

size_t cdprep_workspaces_size(size_t count) {
    if (count > (SIZE_MAX - cdprep::kWorkspacesObject) / cdprep::workspace_bytes()) {
        return SIZE_MAX;
    }
    return count * cdprep::workspace_bytes() + cdprep::kWorkspacesObject;
}

// First every one's scratch, then their own objects, then what knows where those are.
cdprep_workspaces* cdprep_make_workspaces(void* memory, size_t size, size_t count) {
    if (memory == nullptr || count == 0 || size < cdprep_workspaces_size(count)) return nullptr;
    auto* const bytes = static_cast<std::byte*>(memory);
    auto* const objects = reinterpret_cast<Workspace*>(bytes + count * cdprep::scratch_bytes());
    for (size_t i = 0; i < count; ++i) {
        const std::size_t at = i * cdprep::scratch_bytes();
        std::optional<Workspace> workspace = Workspace::in({bytes + at, Workspace::size()});
        if (!workspace) return nullptr;
        new (objects + i) Workspace(std::move(*workspace));
    }
    return new (objects + count) cdprep_workspaces{{std::launder(objects), count}};
}

int cdprep_collide(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
                   cdprep_workspace* workspace, const cdprep_contact_options* options,
                   cdprep_pair_cache* cache, cdprep_collision* collision, cdprep_error* error) {
    if (collision == nullptr) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::CacheCopy copy(cache);
            cdprep::store(cdprep::collide(ma, mb, placed, scratch, cdprep::contact_options(given),
                                          copy.get()),
                          *collision);
            return CDPREP_OK;
        });
}

int cdprep_find_containment(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            cdprep_containment* containment, cdprep_error* error) {
    if (containment == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            const cdprep::Containment found = cdprep::find_containment(ma, mb, placed, scratch);
            *containment = {cdprep::word(found.answer), found.a_inside_b ? 1 : 0, found.winding};
            return CDPREP_OK;
        });
}

int cdprep_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                 const cdprep_placement* placement, cdprep_workspace* workspace,
                                 const cdprep_contact_options* options, cdprep_pair_cache* cache,
                                 cdprep_triangle_pair* pairs, size_t room, size_t* count,
                                 cdprep_error* error) {
    if (count == nullptr || (pairs == nullptr && room > 0)) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::CacheCopy copy(cache);
            *count =
                cdprep::overlapping_triangles(ma, mb, placed, scratch, cdprep::room_of(pairs, room),
                                              cdprep::overlap_options(given), copy.get());
            return CDPREP_OK;
        });
}

int cdprep_visit_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                       const cdprep_placement* placement,
                                       cdprep_workspace* workspace,
                                       const cdprep_contact_options* options,
                                       cdprep_pair_cache* cache, cdprep_pair_visitor visit,
                                       void* context, cdprep_error* error) {
    if (visit == nullptr) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::CacheCopy copy(cache);
            const auto hand_on = [&](const cdprep::TrianglePair& pair) {
                const cdprep_triangle_pair found = {pair.a, pair.b};
                return visit(context, &found) != 0;
            };
            cdprep::visit_overlapping_triangles(ma, mb, placed, scratch, hand_on,
                                                cdprep::overlap_options(given), copy.get());
            return CDPREP_OK;
        });
}

int cdprep_mark_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                      const cdprep_placement* placement,
                                      cdprep_workspace* workspace,
                                      const cdprep_contact_options* options,
                                      cdprep_pair_cache* cache, uint64_t* bits_a, size_t words_a,
                                      uint64_t* bits_b, size_t words_b, size_t* count,
                                      cdprep_error* error) {
    if (count == nullptr || (bits_a == nullptr && words_a > 0) ||
        (bits_b == nullptr && words_b > 0)) {
        return cdprep::null_argument(error);
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::CacheCopy copy(cache);
            *count = cdprep::mark_overlapping_triangles(ma, mb, placed, scratch, {bits_a, words_a},
                                                        {bits_b, words_b},
                                                        cdprep::overlap_options(given), copy.get());
            return CDPREP_OK;
        });
}

int cdprep_crossing_segments(const cdprep_model* a, const cdprep_model* b,
                             const cdprep_placement* placement, cdprep_workspace* workspace,
                             const cdprep_contact_options* options, cdprep_crossing* crossings,
                             size_t room, size_t* count, cdprep_error* error) {
    if (count == nullptr || (crossings == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            std::size_t found = 0;
            const auto take = [&](const cdprep::Crossing& crossing) {
                if (found++ < room) crossings[found - 1] = cdprep::crossing_of(crossing);
                return true;
            };
            cdprep::visit_crossing_segments(ma, mb, placed, scratch, take,
                                            cdprep::overlap_options(given));
            *count = found;
            return CDPREP_OK;
        });
}

int cdprep_visit_crossing_segments(const cdprep_model* a, const cdprep_model* b,
                                   const cdprep_placement* placement, cdprep_workspace* workspace,
                                   const cdprep_contact_options* options,
                                   cdprep_crossing_visitor visit, void* context,
                                   cdprep_error* error) {
    if (visit == nullptr) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            const auto hand_on = [&](const cdprep::Crossing& crossing) {
                const cdprep_crossing found = cdprep::crossing_of(crossing);
                return visit(context, &found) != 0;
            };
            cdprep::visit_crossing_segments(ma, mb, placed, scratch, hand_on,
                                            cdprep::overlap_options(given));
            return CDPREP_OK;
        });
}

int cdprep_distance_between(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            const cdprep_distance_options* options, cdprep_pair_cache* cache,
                            int* found, cdprep_distance* distance, cdprep_error* error) {
    if (cdprep::any_null(found, distance)) return cdprep::null_argument(error);
    cdprep_distance_options given = cdprep::default_distance_options();
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::CacheCopy copy(cache);
            cdprep::store(cdprep::distance(ma, mb, placed, scratch, cdprep::distance_options(given),
                                           copy.get()),
                          *found, *distance);
            return CDPREP_OK;
        });
}

int cdprep_is_within(const cdprep_model* a, const cdprep_model* b,
                     const cdprep_placement* placement, cdprep_workspace* workspace,
                     double tolerance, cdprep_pair_cache* cache, int* within, cdprep_error* error) {
    if (within == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::CacheCopy copy(cache);
            *within = cdprep::is_within(ma, mb, placed, tolerance, scratch, copy.get()) ? 1 : 0;
            return CDPREP_OK;
        });
}

int cdprep_triangles_within(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            double tolerance, const cdprep_contact_options* options,
                            cdprep_triangle_pair* pairs, size_t room, size_t* count,
                            cdprep_error* error) {
    if (count == nullptr || (pairs == nullptr && room > 0)) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            *count = cdprep::triangles_within(ma, mb, placed, tolerance, scratch,
                                              cdprep::room_of(pairs, room),
                                              {cdprep::overlap_options(given).degenerate});
            return CDPREP_OK;
        });
}

int cdprep_cast_ray(const cdprep_model* model, const double origin[3], const double direction[3],
                    double max_t, cdprep_workspace* workspace, int* found, cdprep_ray_hit* hit,
                    cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, found, hit)) {
        return cdprep::null_argument(error);
    }
    const auto result = cdprep::cast_ray(model->model, cdprep::ray_of(origin, direction),
                                         workspace->workspace, {max_t});
    *found = result ? 1 : 0;
    *hit = result ? cdprep::hit_of(*result) : cdprep_ray_hit{};
    return CDPREP_OK;
}

int cdprep_ray_hits(const cdprep_model* model, const double origin[3], const double direction[3],
                    double max_t, cdprep_workspace* workspace, int* hits, cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, hits)) {
        return cdprep::null_argument(error);
    }
    const cdprep::Ray ray = cdprep::ray_of(origin, direction);
    *hits = cdprep::ray_hits(model->model, ray, workspace->workspace, {max_t}) ? 1 : 0;
    return CDPREP_OK;
}

int cdprep_all_ray_hits(const cdprep_model* model, const double origin[3],
                        const double direction[3], double max_t, cdprep_workspace* workspace,
                        cdprep_ray_hit* hits, size_t room, size_t* count, cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, count) ||
        (hits == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    const std::span<cdprep::RayHit> kept(reinterpret_cast<cdprep::RayHit*>(hits), room);
    *count = cdprep::all_ray_hits(model->model, cdprep::ray_of(origin, direction),
                                  workspace->workspace, kept, {max_t});
    return CDPREP_OK;
}

int cdprep_visit_ray_hits(const cdprep_model* model, const double origin[3],
                          const double direction[3], double max_t, cdprep_workspace* workspace,
                          cdprep_ray_visitor visit, void* context, cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, visit)) {
        return cdprep::null_argument(error);
    }
    const auto hand_on = [&](const cdprep::RayHit& hit) {
        const cdprep_ray_hit found = cdprep::hit_of(hit);
        return visit(context, &found) != 0;
    };
    cdprep::visit_ray_hits(model->model, cdprep::ray_of(origin, direction), workspace->workspace,
                           hand_on, {max_t});
    return CDPREP_OK;
}

int cdprep_find_closest_point(const cdprep_model* model, const double query[3], double max_distance,
                              cdprep_workspace* workspace, int* found,
                              cdprep_closest_point* closest, cdprep_error* error) {
    if (cdprep::any_null(model, query, workspace, found, closest)) {
        return cdprep::null_argument(error);
    }
    const auto result = cdprep::closest_point(model->model, {query[0], query[1], query[2]},
                                              workspace->workspace, max_distance);
    *found = result ? 1 : 0;
    *closest = {};
    if (!result) return CDPREP_OK;
    cdprep::store(result->point, closest->point);
    closest->lower = result->lower;
    closest->upper = result->upper;
    closest->triangle = result->triangle;
    return CDPREP_OK;
}

int cdprep_touches(const cdprep_model* model, const cdprep_shape* shape,
                   cdprep_workspace* workspace, const cdprep_shape_options* options, int* touches,
                   cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, touches)) return cdprep::null_argument(error);
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&](const auto& given) {
            const bool found =
                cdprep::touches(model->model, given, workspace->workspace, asked.options);
            *touches = found ? 1 : 0;
            return CDPREP_OK;
        });
    });
}

int cdprep_touching_triangles(const cdprep_model* model, const cdprep_shape* shape,
                              cdprep_workspace* workspace, const cdprep_shape_options* options,
                              uint32_t* triangles, size_t room, size_t* count,
                              cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, count) || (triangles == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&](const auto& given) {
            *count = cdprep::touching_triangles(model->model, given, workspace->workspace,
                                                std::span(triangles, room), asked.options);
            return CDPREP_OK;
        });
    });
}

int cdprep_visit_touching_triangles(const cdprep_model* model, const cdprep_shape* shape,
                                    cdprep_workspace* workspace,
                                    const cdprep_shape_options* options,
                                    cdprep_triangle_visitor visit, void* context,
                                    cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, visit)) return cdprep::null_argument(error);
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&](const auto& given) {
            const auto hand_on = [&](std::uint32_t triangle) {
                return visit(context, triangle) != 0;
            };
            cdprep::visit_touching_triangles(model->model, given, workspace->workspace, hand_on,
                                             asked.options);
            return CDPREP_OK;
        });
    });
}

int cdprep_distance_to(const cdprep_model* model, const cdprep_shape* shape,
                       cdprep_workspace* workspace, const cdprep_shape_options* options, int* found,
                       cdprep_shape_distance* distance, cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, found, distance)) {
        return cdprep::null_argument(error);
    }
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&]<class Shape>(const Shape& given) {
            if constexpr (std::is_same_v<Shape, cdprep::Capsule> ||
                          std::is_same_v<Shape, cdprep::LooseTriangle>) {
                const auto result =
                    cdprep::distance_to(model->model, given, workspace->workspace,
                                        {asked.options.world_from_model, asked.max_distance});
                *found = result ? 1 : 0;
                *distance = {};
                if (!result) return static_cast<int>(CDPREP_OK);
                distance->lower = result->lower;
                distance->upper = result->upper;
                cdprep::store(result->on_model, distance->on_model);
                cdprep::store(result->on_shape, distance->on_shape);
                distance->triangle = result->triangle;
                return static_cast<int>(CDPREP_OK);
            } else {
                return cdprep::fail(error, CDPREP_BAD_ARGUMENT,
                                    "Distances are measured to capsules and triangles alone.");
            }
        });
    });
}

int cdprep_includes(const cdprep_model* model, const double point[3], cdprep_workspace* workspace,
                    cdprep_inclusion* inclusion, cdprep_error* error) {
    if (cdprep::any_null(model, point, workspace, inclusion)) {
        return cdprep::null_argument(error);
    }
    const cdprep::Inclusion result =
        cdprep::includes(model->model, {point[0], point[1], point[2]}, workspace->workspace);
    *inclusion = {cdprep::word(result.answer), result.on_surface ? 1 : 0, result.winding};
    return CDPREP_OK;
}

int cdprep_collide_all(const cdprep_pair_job* jobs, size_t count, cdprep_workspaces* workspaces,
                       const cdprep_parallel_for* parallel_for,
                       const cdprep_contact_options* options, cdprep_collision* collisions,
                       cdprep_error* error) {
    if (collisions == nullptr && count > 0) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::CollideOptions asked = cdprep::contact_options(given);
    return cdprep::ask_jobs(
        jobs, count, workspaces, parallel_for, error,
        [&](size_t i, const Model& a, const Model& b, const Placement& placement,
            Workspace& scratch, PairCache* cache) {
            cdprep::store(cdprep::collide(a, b, placement, scratch, asked, cache), collisions[i]);
        });
}

int cdprep_distance_between_all(const cdprep_pair_job* jobs, size_t count,
                                cdprep_workspaces* workspaces,
                                const cdprep_parallel_for* parallel_for,
                                const cdprep_distance_options* options, int* found,
                                cdprep_distance* distances, cdprep_error* error) {
    if (count > 0 && cdprep::any_null(found, distances)) return cdprep::null_argument(error);
    cdprep_distance_options given = cdprep::default_distance_options();
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::DistanceOptions asked = cdprep::distance_options(given);
    return cdprep::ask_jobs(jobs, count, workspaces, parallel_for, error,
                            [&](size_t i, const Model& a, const Model& b,
                                const Placement& placement, Workspace& scratch, PairCache* cache) {
                                cdprep::store(
                                    cdprep::distance(a, b, placement, scratch, asked, cache),
                                    found[i], distances[i]);
                            });
}

int cdprep_is_within_all(const cdprep_pair_job* jobs, size_t count, cdprep_workspaces* workspaces,
                         const cdprep_parallel_for* parallel_for, double tolerance, int* within,
                         cdprep_error* error) {
    if (within == nullptr && count > 0) return cdprep::null_argument(error);
    return cdprep::ask_jobs(
        jobs, count, workspaces, parallel_for, error,
        [&](size_t i, const Model& a, const Model& b, const Placement& placement,
            Workspace& scratch, PairCache* cache) {
            within[i] = cdprep::is_within(a, b, placement, tolerance, scratch, cache) ? 1 : 0;
        });
}

int cdprep_overlapping_triangles_all(const cdprep_pair_job* jobs, size_t count,
                                     cdprep_workspaces* workspaces,
                                     const cdprep_parallel_for* parallel_for,
                                     const cdprep_contact_options* options,
                                     cdprep_overlap_answer* answers, cdprep_error* error) {
    if (answers == nullptr && count > 0) return cdprep::null_argument(error);
    for (size_t i = 0; i < count; ++i) {
        if (answers[i].pairs == nullptr && answers[i].room > 0) {
            return cdprep::null_argument(error);
        }
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::OverlapOptions asked = cdprep::overlap_options(given);
    return cdprep::ask_jobs(jobs, count, workspaces, parallel_for, error,
                            [&](size_t i, const Model& a, const Model& b,
                                const Placement& placement, Workspace& scratch, PairCache* cache) {
                                cdprep_overlap_answer& to = answers[i];
                                to.count = cdprep::overlapping_triangles(
                                    a, b, placement, scratch, cdprep::room_of(to.pairs, to.room),
                                    asked, cache);
                            });
}

int cdprep_mark_overlapping_triangles_all(const cdprep_pair_job* jobs, size_t count,
                                          cdprep_workspaces* workspaces,
                                          const cdprep_parallel_for* parallel_for,
                                          const cdprep_contact_options* options,
                                          cdprep_marked_triangles* answers, cdprep_error* error) {
    if (answers == nullptr && count > 0) return cdprep::null_argument(error);
    for (size_t i = 0; i < count; ++i) {
        const cdprep_marked_triangles& to = answers[i];
        if ((to.bits_a == nullptr && to.words_a > 0) || (to.bits_b == nullptr && to.words_b > 0)) {
            return cdprep::null_argument(error);
        }
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::OverlapOptions asked = cdprep::overlap_options(given);
    return cdprep::ask_jobs(jobs, count, workspaces, parallel_for, error,
                            [&](size_t i, const Model& a, const Model& b,
                                const Placement& placement, Workspace& scratch, PairCache* cache) {
                                cdprep_marked_triangles& to = answers[i];
                                to.count = cdprep::mark_overlapping_triangles(
                                    a, b, placement, scratch, {to.bits_a, to.words_a},
                                    {to.bits_b, to.words_b}, asked, cache);
                            });
}

int cdprep_split_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                       const cdprep_placement* placement,
                                       cdprep_workspaces* workspaces,
                                       const cdprep_parallel_for* parallel_for,
                                       const cdprep_contact_options* options,
                                       cdprep_triangle_pair* pairs, size_t room, size_t* count,
                                       cdprep_error* error) {
    if (cdprep::any_null(a, b, placement, workspaces, count) || (pairs == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    cdprep_contact_options given{};
    cdprep::CThreads threads{};
    if (!cdprep::read_sized(options, given) || !cdprep::read_sized(parallel_for, threads.given)) {
        return cdprep::bad_size(error);
    }
    return cdprep::guarded(error, [&]() -> int {
        std::optional<Placement> placed;
        if (const int code = cdprep::read_placement(*placement, placed, error)) return code;
        *count = cdprep::split_overlapping_triangles(a->model, b->model, *placed, workspaces->all,
                                                     threads, cdprep::room_of(pairs, room),
                                                     cdprep::overlap_options(given));
        return CDPREP_OK;
    });
}
