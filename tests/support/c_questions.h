// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "cdprep/cdprep.h"

// Every query of the C API in one form, for tests that run all of them.

namespace cdprep::test {

/// Two models, of which B is moved, and the workspace for a query.
struct CScene {
    const cdprep_model* a;
    const cdprep_model* b;
    double x;  ///< the distance by which B is moved along x
    cdprep_workspace* workspace;
};

/// The result of a query.
struct CAnswer {
    int code = 0;
    int why = 0;
    bool is_unknown = false;  ///< the query makes no statement
    std::string bytes;        ///< of the result; equal results have equal bytes
};

/// A query, and the queries that both models must serve.
struct CQuestion {
    const char* name;
    std::uint32_t needs;
    CAnswer (*ask)(const CScene& scene);
};

inline cdprep_pair pair_of(const CScene& scene) {
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = scene.a;
    pair.b = scene.b;
    pair.pose_b.rows[9] = scene.x;
    return pair;
}

namespace detail {

template <class T>
void append(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
CAnswer told(int code, const cdprep_error& error, bool is_unknown, const T& answer) {
    CAnswer told = {code, error.why, is_unknown, {}};
    append(told.bytes, answer);
    return told;
}

inline constexpr std::size_t kRoom = 512;

/// Runs a query for a list; returns its count and its items.
template <class Item, class List, class Ask>
CAnswer told_list(Ask&& ask) {
    static Item items[kRoom];
    std::memset(static_cast<void*>(items), 0, sizeof items);
    List list{};
    list.items = items;
    list.room = kRoom;
    list.count = 77;
    cdprep_error error;
    const int code = ask(&list, &error);
    CAnswer answer = {code, error.why, list.count == 0, {}};
    append(answer.bytes, list.count);
    if (code == CDPREP_OK) {
        answer.bytes.append(reinterpret_cast<const char*>(items), sizeof items);
    }
    return answer;
}

/// A visitor that adds up its arguments. The sum does not depend on the order.
inline int add_to(void* sum, std::uint64_t value) {
    *static_cast<std::uint64_t*>(sum) += value;
    return 1;
}

template <class Ask>
CAnswer told_sum(Ask&& ask) {
    std::uint64_t sum = 0;
    cdprep_error error;
    const int code = ask(&sum, &error);
    return told(code, error, sum == 0, sum);
}

template <std::uint32_t kBody, std::uint32_t kThrough>
CAnswer collide(const CScene& scene) {
    cdprep_pair pair = pair_of(scene);
    pair.body = kBody;
    pair.through = kThrough;
    cdprep_collision found{};
    cdprep_error error;
    const int code = cdprep_collide(&pair, scene.workspace, &found, &error);
    return told(code, error, found.hit == CDPREP_UNKNOWN, found);
}

template <std::uint32_t kThrough>
CAnswer overlaps(const CScene& scene) {
    cdprep_pair pair = pair_of(scene);
    pair.through = kThrough;
    return told_list<cdprep_overlap, cdprep_overlap_list>([&](auto* list, cdprep_error* error) {
        return cdprep_overlaps(&pair, scene.workspace, list, error);
    });
}

inline cdprep_self_query self_of(const CScene& scene) {
    cdprep_self_query query;
    cdprep_self_query_init(&query, sizeof query);
    query.model = scene.a;
    return query;
}

template <std::uint32_t kBody, std::uint32_t kThrough>
CAnswer distance(const CScene& scene) {
    cdprep_pair pair = pair_of(scene);
    pair.body = kBody;
    pair.through = kThrough;
    cdprep_nearest found{};
    found.found = 77;
    cdprep_error error;
    const int code = cdprep_distance(&pair, nullptr, scene.workspace, &found, &error);
    return told(code, error, found.found == CDPREP_NO, found);
}

/// B comes from 4 farther, and stops where it would be.
template <std::uint32_t kBody>
CAnswer time_of_impact(const CScene& scene) {
    cdprep_moving_pair pair;
    cdprep_moving_pair_init(&pair, sizeof pair);
    pair.a = scene.a;
    pair.b = scene.b;
    pair.body = kBody;
    pair.motion_b.start.rows[9] = scene.x + 4;
    pair.motion_b.end.rows[9] = scene.x;
    cdprep_impact found{};
    found.kind = 77;
    cdprep_error error;
    const int code = cdprep_time_of_impact(&pair, scene.workspace, &found, &error);
    return told(code, error, found.kind == CDPREP_IMPACT_UNKNOWN, found);
}

template <std::uint32_t kThrough>
CAnswer inside(const CScene& scene) {
    const double points[6] = {0.5, 0.5, 0.5, 0.5, 0.25, 2};
    cdprep_point_query query;
    cdprep_point_query_init(&query, sizeof query);
    query.model = scene.a;
    query.points = points;
    query.count = 2;
    query.through = kThrough;
    struct {
        cdprep_point_state state[2];
    } found{};
    cdprep_error error;
    const int code = cdprep_points_inside(&query, scene.workspace, found.state, &error);
    return told(code, error, found.state[0].inside == CDPREP_UNKNOWN, found);
}

inline const cdprep_ray kRay = {{-3, 0.5, 0.375}, {1, 0, 0}, 1e9};

inline cdprep_ray_query rays_of(const CScene& scene) {
    cdprep_ray_query query;
    cdprep_ray_query_init(&query, sizeof query);
    query.model = scene.a;
    query.rays = &kRay;
    return query;
}

inline cdprep_shape_query shape_of(const CScene& scene) {
    cdprep_shape_query query;
    cdprep_shape_query_init(&query, sizeof query);
    query.model = scene.a;
    query.shape = CDPREP_SPHERE;
    query.a[0] = 1.25;
    query.a[1] = query.a[2] = 0.5;
    query.radius = 0.5;
    return query;
}

inline cdprep_hull_pair hulls_of(const CScene& scene, std::uint32_t scope) {
    cdprep_hull_pair pair;
    cdprep_hull_pair_init(&pair, sizeof pair);
    pair.a = {scene.a, scope, 0};
    pair.b = {scene.b, scope, 0};
    pair.pose_b.rows[9] = scene.x;
    return pair;
}

template <std::uint32_t kScope>
CAnswer hulls(const CScene& scene) {
    const cdprep_hull_pair pair = hulls_of(scene, kScope);
    cdprep_nearest found{};
    found.found = 77;
    cdprep_error error;
    const int code = cdprep_hulls_distance(&pair, nullptr, &found, &error);
    return told(code, error, found.found == CDPREP_NO, found);
}

/// Draws triangles. The sum of their numbers does not depend on their order.
template <std::uint32_t kWhat>
CAnswer draw(const CScene& scene) {
    return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
        cdprep_draw draw;
        cdprep_draw_init(&draw, sizeof draw);
        draw.what = kWhat;
        draw.context = sum;
        draw.triangle = [](void* to, const double* corners, std::uint32_t /*rgba*/) {
            std::uint64_t bits = 0;
            for (int i = 0; i < 9; ++i) {
                std::uint64_t number = 0;
                std::memcpy(&number, corners + i, sizeof number);
                bits = bits * 31 + number;
            }
            return add_to(to, bits);
        };
        const cdprep_pose pose = pair_of(scene).pose_b;
        return cdprep_model_draw(scene.a, &pose, &draw, error);
    });
}

}  // namespace detail

/// Returns each query once, and through each structure.
inline const std::vector<CQuestion>& c_questions() {
    using namespace detail;
    static const std::vector<CQuestion> questions = {
        {"collide", CDPREP_ASK_COLLIDE, collide<CDPREP_SURFACE, CDPREP_THROUGH_BVH>},
        {"collide solid", CDPREP_ASK_COLLIDE | CDPREP_ASK_SOLID,
         collide<CDPREP_SOLID, CDPREP_THROUGH_BVH>},
        {"collide through octree", CDPREP_ASK_COLLIDE | CDPREP_ASK_OCTREE,
         collide<CDPREP_SURFACE, CDPREP_THROUGH_OCTREE>},
        {"collide through adaptive octree", CDPREP_ASK_COLLIDE | CDPREP_ASK_ADAPTIVE_OCTREE,
         collide<CDPREP_SURFACE, CDPREP_THROUGH_ADAPTIVE_OCTREE>},
        {"collide through hashed octree", CDPREP_ASK_COLLIDE | CDPREP_ASK_HASHED_OCTREE,
         collide<CDPREP_SURFACE, CDPREP_THROUGH_HASHED_OCTREE>},
        {"collide solid through tetra-tree",
         CDPREP_ASK_COLLIDE | CDPREP_ASK_SOLID | CDPREP_ASK_TETRA_TREE,
         collide<CDPREP_SOLID, CDPREP_THROUGH_TETRA_TREE>},
        {"collide through pieces", CDPREP_ASK_COLLIDE | CDPREP_ASK_PIECES,
         collide<CDPREP_SURFACE, CDPREP_THROUGH_PIECES>},
        {"containment", CDPREP_ASK_COLLIDE | CDPREP_ASK_SOLID,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             cdprep_collision found{};
             cdprep_error error;
             const int code = cdprep_containment(&pair, scene.workspace, &found, &error);
             return told(code, error, found.hit == CDPREP_UNKNOWN, found);
         }},
        {"collide at level", CDPREP_ASK_TETRA_TREE,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             std::uint32_t hit = 77;
             cdprep_error error;
             const int code = cdprep_collide_at_level(&pair, 2, scene.workspace, &hit, &error);
             return told(code, error, hit == CDPREP_UNKNOWN, hit);
         }},
        {"overlaps", CDPREP_ASK_OVERLAP, overlaps<CDPREP_THROUGH_BVH>},
        {"overlaps through octree", CDPREP_ASK_OVERLAP | CDPREP_ASK_OCTREE,
         overlaps<CDPREP_THROUGH_OCTREE>},
        {"overlaps through tetra-tree", CDPREP_ASK_OVERLAP | CDPREP_ASK_TETRA_TREE,
         overlaps<CDPREP_THROUGH_TETRA_TREE>},
        {"overlaps through pieces", CDPREP_ASK_OVERLAP | CDPREP_ASK_PIECES,
         overlaps<CDPREP_THROUGH_PIECES>},
        {"overlaps split", CDPREP_ASK_OVERLAP,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             return told_list<cdprep_overlap, cdprep_overlap_list>(
                 [&](auto* list, cdprep_error* error) {
                     return cdprep_overlaps_split(&pair, scene.workspace, list, error);
                 });
         }},
        {"overlaps mark", CDPREP_ASK_OVERLAP,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             std::uint64_t bits[2][8] = {};
             cdprep_marks marks = {bits[0], bits[1], 8, 8, 77};
             cdprep_error error;
             const int code = cdprep_overlaps_mark(&pair, scene.workspace, &marks, &error);
             CAnswer answer = told(code, error, marks.count == 0, bits);
             append(answer.bytes, marks.count);
             return answer;
         }},
        {"overlaps visit", CDPREP_ASK_OVERLAP,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, const cdprep_overlap* overlap) {
                     return add_to(to, 1000 + 100 * overlap->a + overlap->b);
                 };
                 return cdprep_overlaps_visit(&pair, scene.workspace, add, sum, error);
             });
         }},
        {"crossings visit", CDPREP_ASK_OVERLAP,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, const cdprep_crossing* crossing) {
                     return add_to(to, 1000 + 100 * crossing->pair.a + crossing->pair.b);
                 };
                 return cdprep_crossings_visit(&pair, scene.workspace, add, sum, error);
             });
         }},
        {"crossings", CDPREP_ASK_OVERLAP,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             cdprep_crossing_list list = {nullptr, 0, 77};
             cdprep_error error;
             const int code = cdprep_crossings(&pair, scene.workspace, &list, &error);
             return told(code, error, list.count == 0, list.count);
         }},
        {"self overlaps", CDPREP_ASK_OVERLAP | CDPREP_ASK_CORNERS,
         [](const CScene& scene) {
             const cdprep_self_query query = self_of(scene);
             return told_list<cdprep_overlap, cdprep_overlap_list>(
                 [&](auto* list, cdprep_error* error) {
                     return cdprep_self_overlaps(&query, scene.workspace, list, error);
                 });
         }},
        {"self overlaps visit", CDPREP_ASK_OVERLAP | CDPREP_ASK_CORNERS,
         [](const CScene& scene) {
             const cdprep_self_query query = self_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, const cdprep_overlap* overlap) {
                     return add_to(to, 1000 + 100 * overlap->a + overlap->b);
                 };
                 return cdprep_self_overlaps_visit(&query, scene.workspace, add, sum, error);
             });
         }},
        {"distance", CDPREP_ASK_DISTANCE, distance<CDPREP_SURFACE, CDPREP_THROUGH_BVH>},
        {"distance solid", CDPREP_ASK_DISTANCE | CDPREP_ASK_SOLID,
         distance<CDPREP_SOLID, CDPREP_THROUGH_BVH>},
        {"distance through pieces", CDPREP_ASK_DISTANCE | CDPREP_ASK_PIECES,
         distance<CDPREP_SURFACE, CDPREP_THROUGH_PIECES>},
        {"time of impact", CDPREP_ASK_DISTANCE, time_of_impact<CDPREP_SURFACE>},
        {"time of impact solid", CDPREP_ASK_DISTANCE | CDPREP_ASK_SOLID,
         time_of_impact<CDPREP_SOLID>},
        {"distance bounded", CDPREP_ASK_DISTANCE,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             cdprep_bounded found{};
             cdprep_error error;
             const int code =
                 cdprep_distance_bounded(&pair, nullptr, 0, scene.workspace, &found, &error);
             return told(code, error, found.complete == CDPREP_UNKNOWN, found.nearest);
         }},
        {"within", CDPREP_ASK_WITHIN,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             std::uint32_t within = 77;
             cdprep_error error;
             const int code = cdprep_within(&pair, 0.5, scene.workspace, &within, &error);
             return told(code, error, within == CDPREP_UNKNOWN, within);
         }},
        {"pairs within", CDPREP_ASK_WITHIN,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             return told_list<cdprep_overlap, cdprep_overlap_list>(
                 [&](auto* list, cdprep_error* error) {
                     return cdprep_pairs_within(&pair, 0.5, scene.workspace, list, error);
                 });
         }},
        {"pairs within visit", CDPREP_ASK_WITHIN,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, const cdprep_overlap* overlap) {
                     return add_to(to, 1000 + 100 * overlap->a + overlap->b);
                 };
                 return cdprep_pairs_within_visit(&pair, 0.5, scene.workspace, add, sum, error);
             });
         }},
        {"contacts visit", CDPREP_ASK_CONTACTS,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, const cdprep_contact* contact) {
                     return add_to(to, 1000 + 100 * contact->piece_a + contact->piece_b);
                 };
                 return cdprep_contacts_visit(&pair, nullptr, scene.workspace, add, sum, error);
             });
         }},
        {"contacts", CDPREP_ASK_CONTACTS,
         [](const CScene& scene) {
             const cdprep_pair pair = pair_of(scene);
             cdprep_contact_options options;
             cdprep_contact_options_init(&options, sizeof options);
             options.tolerance = 0.5;
             options.manifold = 4;
             return told_list<cdprep_contact, cdprep_contact_list>(
                 [&](auto* list, cdprep_error* error) {
                     return cdprep_contacts(&pair, &options, scene.workspace, list, error);
                 });
         }},
        {"hulls distance", CDPREP_ASK_HULLS, hulls<CDPREP_HULL_WHOLE>},
        {"hulls distance of pieces", CDPREP_ASK_PIECES | CDPREP_ASK_CORNERS,
         hulls<CDPREP_HULL_PIECE>},
        {"hull find", CDPREP_ASK_HULLS,
         [](const CScene& scene) {
             cdprep_hull found = {scene.a, 77, 77};
             cdprep_error error;
             const int code = cdprep_hull_find(scene.a, CDPREP_HULL_WHOLE, 0, &found, &error);
             const bool is_unknown = found.model == nullptr;
             found.model = nullptr;  // an address is not part of the result
             return told(code, error, is_unknown, found);
         }},
        {"hulls collide", CDPREP_ASK_HULLS,
         [](const CScene& scene) {
             const cdprep_hull_pair pair = hulls_of(scene, CDPREP_HULL_WHOLE);
             std::uint32_t hit = 77;
             cdprep_error error;
             const int code = cdprep_hulls_collide(&pair, &hit, &error);
             return told(code, error, hit == CDPREP_UNKNOWN, hit);
         }},
        {"hulls within", CDPREP_ASK_HULLS,
         [](const CScene& scene) {
             const cdprep_hull_pair pair = hulls_of(scene, CDPREP_HULL_WHOLE);
             std::uint32_t within = 77;
             cdprep_error error;
             const int code = cdprep_hulls_within(&pair, 0.5, &within, &error);
             return told(code, error, within == CDPREP_UNKNOWN, within);
         }},
        {"hulls penetration", CDPREP_ASK_HULLS,
         [](const CScene& scene) {
             const cdprep_hull_pair pair = hulls_of(scene, CDPREP_HULL_WHOLE);
             cdprep_penetration found{};
             found.found = 77;
             cdprep_error error;
             const int code = cdprep_hulls_penetration(&pair, nullptr, &found, &error);
             return told(code, error, found.found == CDPREP_NO, found);
         }},
        {"hull mesh of a piece", CDPREP_ASK_PIECES | CDPREP_ASK_CORNERS,
         [](const CScene& scene) {
             static double positions[3 * kRoom];
             struct {
                 std::size_t counts[2];
                 std::uint32_t triangles[3 * kRoom];
             } found{};
             cdprep_mesh mesh = {positions, found.triangles, nullptr, kRoom, kRoom, 77, 77};
             const cdprep_hull hull = {scene.a, CDPREP_HULL_PIECE, 0};
             cdprep_error error;
             const int code = cdprep_hull_mesh(&hull, &mesh, &error);
             found.counts[0] = mesh.vertex_count;
             found.counts[1] = mesh.triangle_count;
             return told(code, error, mesh.triangle_count == 0, found);
         }},
        {"hulls features", CDPREP_ASK_CONTACTS,
         [](const CScene& scene) {
             const cdprep_hull_pair pair = hulls_of(scene, CDPREP_HULL_PIECE);
             cdprep_closest_features found{};
             found.found = 77;
             cdprep_error error;
             const int code = cdprep_hulls_features(&pair, &found, &error);
             return told(code, error, found.found == CDPREP_NO, found);
         }},
        {"points closest", CDPREP_ASK_CLOSEST,
         [](const CScene& scene) {
             const double point[3] = {0.5, 0.25, 2};
             cdprep_point_query query;
             cdprep_point_query_init(&query, sizeof query);
             query.model = scene.a;
             query.points = point;
             cdprep_closest_point found{};
             found.found = 77;
             cdprep_error error;
             const int code = cdprep_points_closest(&query, scene.workspace, &found, &error);
             return told(code, error, found.found == CDPREP_NO, found);
         }},
        {"points inside", CDPREP_ASK_INSIDE, inside<CDPREP_THROUGH_BVH>},
        {"points inside through octree", CDPREP_ASK_INSIDE | CDPREP_ASK_OCTREE,
         inside<CDPREP_THROUGH_OCTREE>},
        {"points inside through adaptive octree", CDPREP_ASK_INSIDE | CDPREP_ASK_ADAPTIVE_OCTREE,
         inside<CDPREP_THROUGH_ADAPTIVE_OCTREE>},
        {"points inside through tetra-tree", CDPREP_ASK_INSIDE | CDPREP_ASK_TETRA_TREE,
         inside<CDPREP_THROUGH_TETRA_TREE>},
        {"rays cast", CDPREP_ASK_RAY,
         [](const CScene& scene) {
             const cdprep_ray_query query = rays_of(scene);
             cdprep_ray_hit found{};
             found.found = 77;
             cdprep_error error;
             const int code = cdprep_rays_cast(&query, scene.workspace, &found, &error);
             return told(code, error, found.found == CDPREP_NO, found);
         }},
        {"rays any", CDPREP_ASK_RAY,
         [](const CScene& scene) {
             const cdprep_ray_query query = rays_of(scene);
             std::uint32_t hit = 77;
             cdprep_error error;
             const int code = cdprep_rays_any(&query, scene.workspace, &hit, &error);
             return told(code, error, hit == CDPREP_UNKNOWN, hit);
         }},
        {"rays all", CDPREP_ASK_RAY,
         [](const CScene& scene) {
             const cdprep_ray_query query = rays_of(scene);
             return told_list<cdprep_ray_hit, cdprep_ray_hit_list>(
                 [&](auto* list, cdprep_error* error) {
                     return cdprep_rays_all(&query, scene.workspace, list, error);
                 });
         }},
        {"rays visit", CDPREP_ASK_RAY,
         [](const CScene& scene) {
             const cdprep_ray_query query = rays_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, const cdprep_ray_hit* hit) {
                     return add_to(to, 1000 + hit->triangle);
                 };
                 return cdprep_rays_visit(&query, scene.workspace, add, sum, error);
             });
         }},
        {"touch visit", CDPREP_ASK_TOUCH,
         [](const CScene& scene) {
             const cdprep_shape_query query = shape_of(scene);
             return told_sum([&](std::uint64_t* sum, cdprep_error* error) {
                 const auto add = [](void* to, std::uint32_t triangle) {
                     return add_to(to, 1000 + triangle);
                 };
                 return cdprep_touch_visit(&query, scene.workspace, add, sum, error);
             });
         }},
        {"touch", CDPREP_ASK_TOUCH,
         [](const CScene& scene) {
             const cdprep_shape_query query = shape_of(scene);
             std::uint32_t touches = 77;
             cdprep_error error;
             const int code = cdprep_touch(&query, scene.workspace, &touches, &error);
             return told(code, error, touches == CDPREP_UNKNOWN, touches);
         }},
        {"touch list", CDPREP_ASK_TOUCH,
         [](const CScene& scene) {
             const cdprep_shape_query query = shape_of(scene);
             return told_list<std::uint32_t, cdprep_triangle_list>(
                 [&](auto* list, cdprep_error* error) {
                     return cdprep_touch_list(&query, scene.workspace, list, error);
                 });
         }},
        {"shape distance", CDPREP_ASK_TOUCH,
         [](const CScene& scene) {
             const cdprep_shape_query query = shape_of(scene);
             cdprep_nearest found{};
             found.found = 77;
             cdprep_error error;
             const int code = cdprep_shape_distance(&query, scene.workspace, &found, &error);
             return told(code, error, found.found == CDPREP_NO, found);
         }},
        {"touch many", CDPREP_ASK_TOUCH,
         [](const CScene& scene) {
             const std::array<cdprep_shape_query, 2> queries = {shape_of(scene), shape_of(scene)};
             std::array<std::uint32_t, 2> touches = {77, 77};
             cdprep_error error;
             const int code =
                 cdprep_touch_many(queries.data(), 2, scene.workspace, touches.data(), &error);
             return told(code, error, touches[1] == CDPREP_UNKNOWN, touches);
         }},
        {"shape distance many", CDPREP_ASK_TOUCH,
         [](const CScene& scene) {
             const cdprep_shape_query query = shape_of(scene);
             cdprep_nearest found{};
             found.found = 77;
             cdprep_error error;
             const int code =
                 cdprep_shape_distance_many(&query, 1, scene.workspace, &found, &error);
             return told(code, error, found.found == CDPREP_NO, found);
         }},
        {"model draw of surfaces", CDPREP_ASK_CORNERS, draw<CDPREP_DRAW_SURFACE>},
        {"model draw of hulls", CDPREP_ASK_HULLS, draw<CDPREP_DRAW_HULLS>},
        {"model draw of pieces", CDPREP_ASK_PIECES | CDPREP_ASK_CORNERS, draw<CDPREP_DRAW_PIECES>},
        {"model corners", CDPREP_ASK_CORNERS,
         [](const CScene& scene) {
             const std::uint32_t triangles[2] = {3, 1};
             struct {
                 cdprep_corners corners[2];
             } found{};
             cdprep_error error;
             const int code = cdprep_model_corners(scene.a, triangles, 2, found.corners, &error);
             found.corners[0].component = found.corners[1].component = 0;  // may be unknown
             return told(code, error, code != CDPREP_OK, found);
         }},
        {"model mesh", CDPREP_ASK_CORNERS,
         [](const CScene& scene) {
             static double positions[3 * kRoom];
             static std::uint32_t triangles[3 * kRoom];
             std::memset(triangles, 0, sizeof triangles);
             cdprep_mesh mesh = {positions, triangles, nullptr, kRoom, kRoom, 77, 77};
             cdprep_error error;
             const int code = cdprep_model_mesh(scene.a, &mesh, &error);
             CAnswer answer = told(code, error, mesh.triangle_count == 0, mesh.vertex_count);
             if (code == CDPREP_OK) append(answer.bytes, triangles);
             return answer;
         }},
        {"model level error", CDPREP_ASK_TETRA_TREE,
         [](const CScene& scene) {
             double bound = 77;
             cdprep_error error;
             const int code = cdprep_model_level_error(scene.a, 1, &bound, &error);
             return told(code, error, bound == 0, bound);
         }},
        {"model mass", CDPREP_ASK_RESPONSE,
         [](const CScene& scene) {
             cdprep_mass mass{};
             cdprep_error error;
             const int code = cdprep_model_mass(scene.a, &mass, &error);
             return told(code, error, mass.volume == 0, mass);
         }},
    };
    return questions;
}

}  // namespace cdprep::test
