// SPDX-License-Identifier: MIT
// Where every field of the C API is, on machines of 64 bits: a program that was compiled before
// finds it there. A change that is meant is made here too, and named in CHANGELOG.md.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "cdprep/cdprep.h"

namespace {

#if UINTPTR_MAX == UINT64_MAX
#define SIZE(type, size) static_assert(sizeof(type) == (size))
#define PLACE(type, field, place) static_assert(offsetof(type, field) == (place))

SIZE(cdprep_head, 8);
PLACE(cdprep_head, tag, 4);
SIZE(cdprep_error, 512);
PLACE(cdprep_error, why, 4);
PLACE(cdprep_error, argument, 8);
PLACE(cdprep_error, message, 64);
SIZE(cdprep_version, 40);
PLACE(cdprep_version, minor, 4);
PLACE(cdprep_version, patch, 8);
PLACE(cdprep_version, abi, 12);
PLACE(cdprep_version, oldest_format, 16);
PLACE(cdprep_version, newest_format, 20);
PLACE(cdprep_version, kernels, 24);
SIZE(cdprep_allocator, 24);
PLACE(cdprep_allocator, release, 8);
PLACE(cdprep_allocator, context, 16);
SIZE(cdprep_workspace_options, 48);
PLACE(cdprep_workspace_options, lanes, 8);
PLACE(cdprep_workspace_options, counting, 12);
PLACE(cdprep_workspace_options, run, 16);
PLACE(cdprep_workspace_options, context, 24);
PLACE(cdprep_workspace_options, allocator, 32);
PLACE(cdprep_workspace_options, cells, 40);
SIZE(cdprep_counts, 256);
SIZE(cdprep_pose, 96);
SIZE(cdprep_open_options, 32);
PLACE(cdprep_open_options, ask, 8);
PLACE(cdprep_open_options, mode, 12);
PLACE(cdprep_open_options, name, 16);
PLACE(cdprep_open_options, allocator, 24);
SIZE(cdprep_build_options, 64);
PLACE(cdprep_build_options, ask, 8);
PLACE(cdprep_build_options, precision, 12);
PLACE(cdprep_build_options, positions, 16);
PLACE(cdprep_build_options, positions_f32, 24);
PLACE(cdprep_build_options, triangles, 32);
PLACE(cdprep_build_options, vertex_count, 40);
PLACE(cdprep_build_options, triangle_count, 48);
PLACE(cdprep_build_options, allocator, 56);
SIZE(cdprep_model_info, 152);
PLACE(cdprep_model_info, vertices, 4);
PLACE(cdprep_model_info, components, 8);
PLACE(cdprep_model_info, instances, 12);
PLACE(cdprep_model_info, groups, 16);
PLACE(cdprep_model_info, materials, 20);
PLACE(cdprep_model_info, pieces, 24);
PLACE(cdprep_model_info, hulls, 28);
PLACE(cdprep_model_info, verdicts, 32);
PLACE(cdprep_model_info, serves, 36);
PLACE(cdprep_model_info, closed, 40);
PLACE(cdprep_model_info, stores_f64, 44);
PLACE(cdprep_model_info, lower, 48);
PLACE(cdprep_model_info, upper, 72);
PLACE(cdprep_model_info, metres_per_unit, 96);
PLACE(cdprep_model_info, hash, 104);
PLACE(cdprep_model_info, reserved, 120);
SIZE(cdprep_corners, 112);
PLACE(cdprep_corners, vertex, 72);
PLACE(cdprep_corners, face, 84);
PLACE(cdprep_corners, instance, 88);
PLACE(cdprep_corners, group, 92);
PLACE(cdprep_corners, material, 96);
PLACE(cdprep_corners, component, 100);
PLACE(cdprep_corners, degenerate, 104);
PLACE(cdprep_corners, reserved, 108);
SIZE(cdprep_mesh, 56);
PLACE(cdprep_mesh, triangles, 8);
PLACE(cdprep_mesh, vertices, 16);
PLACE(cdprep_mesh, vertex_room, 24);
PLACE(cdprep_mesh, triangle_room, 32);
PLACE(cdprep_mesh, vertex_count, 40);
PLACE(cdprep_mesh, triangle_count, 48);
SIZE(cdprep_array, 24);
PLACE(cdprep_array, count, 8);
PLACE(cdprep_array, stride, 16);
SIZE(cdprep_mass, 80);
PLACE(cdprep_mass, centre, 8);
PLACE(cdprep_mass, inertia, 32);
SIZE(cdprep_verdict, 48);
PLACE(cdprep_verdict, promises, 4);
PLACE(cdprep_verdict, triangles, 8);
PLACE(cdprep_verdict, first_triangle, 12);
PLACE(cdprep_verdict, boundary_loops, 16);
PLACE(cdprep_verdict, euler, 20);
PLACE(cdprep_verdict, genus, 24);
PLACE(cdprep_verdict, reserved, 28);
PLACE(cdprep_verdict, area, 32);
PLACE(cdprep_verdict, volume, 40);
SIZE(cdprep_cache, 256);
SIZE(cdprep_pair, 248);
PLACE(cdprep_pair, a, 8);
PLACE(cdprep_pair, b, 16);
PLACE(cdprep_pair, cache, 24);
PLACE(cdprep_pair, moving, 32);
PLACE(cdprep_pair, body, 36);
PLACE(cdprep_pair, overlap, 40);
PLACE(cdprep_pair, degenerate, 44);
PLACE(cdprep_pair, through, 48);
PLACE(cdprep_pair, reserved, 52);
PLACE(cdprep_pair, pose_a, 56);
PLACE(cdprep_pair, pose_b, 152);
SIZE(cdprep_collision, 24);
PLACE(cdprep_collision, containment, 4);
PLACE(cdprep_collision, a_inside_b, 8);
PLACE(cdprep_collision, reserved, 12);
PLACE(cdprep_collision, winding, 16);
SIZE(cdprep_overlap, 8);
PLACE(cdprep_overlap, b, 4);
SIZE(cdprep_overlap_list, 24);
PLACE(cdprep_overlap_list, room, 8);
PLACE(cdprep_overlap_list, count, 16);
SIZE(cdprep_marks, 40);
PLACE(cdprep_marks, bits_b, 8);
PLACE(cdprep_marks, words_a, 16);
PLACE(cdprep_marks, words_b, 24);
PLACE(cdprep_marks, count, 32);
SIZE(cdprep_crossing, 64);
PLACE(cdprep_crossing, is_flat, 8);
PLACE(cdprep_crossing, reserved, 12);
PLACE(cdprep_crossing, ends, 16);
SIZE(cdprep_crossing_list, 24);
PLACE(cdprep_crossing_list, room, 8);
PLACE(cdprep_crossing_list, count, 16);
SIZE(cdprep_distance_options, 32);
PLACE(cdprep_distance_options, relative_error, 8);
PLACE(cdprep_distance_options, absolute_error, 16);
PLACE(cdprep_distance_options, max_distance, 24);
SIZE(cdprep_nearest, 80);
PLACE(cdprep_nearest, triangle_a, 4);
PLACE(cdprep_nearest, triangle_b, 8);
PLACE(cdprep_nearest, reserved, 12);
PLACE(cdprep_nearest, lower, 16);
PLACE(cdprep_nearest, upper, 24);
PLACE(cdprep_nearest, on_a, 32);
PLACE(cdprep_nearest, on_b, 56);
SIZE(cdprep_feature, 24);
PLACE(cdprep_feature, edge, 4);
PLACE(cdprep_feature, triangle, 8);
PLACE(cdprep_feature, vertex, 12);
SIZE(cdprep_contact_point, 64);
PLACE(cdprep_contact_point, on_b, 24);
PLACE(cdprep_contact_point, distance, 48);
PLACE(cdprep_contact_point, id, 56);
SIZE(cdprep_contact, 424);
PLACE(cdprep_contact, piece_b, 4);
PLACE(cdprep_contact, id, 8);
PLACE(cdprep_contact, feature_a, 16);
PLACE(cdprep_contact, feature_b, 40);
PLACE(cdprep_contact, flags, 64);
PLACE(cdprep_contact, point_count, 68);
PLACE(cdprep_contact, members, 72);
PLACE(cdprep_contact, reserved, 76);
PLACE(cdprep_contact, on_a, 80);
PLACE(cdprep_contact, on_b, 104);
PLACE(cdprep_contact, normal, 128);
PLACE(cdprep_contact, lower, 152);
PLACE(cdprep_contact, upper, 160);
PLACE(cdprep_contact, points, 168);
SIZE(cdprep_contact_list, 56);
PLACE(cdprep_contact_list, room, 8);
PLACE(cdprep_contact_list, count, 16);
PLACE(cdprep_contact_list, complete, 24);
PLACE(cdprep_contact_list, searched, 28);
PLACE(cdprep_contact_list, found, 32);
PLACE(cdprep_contact_list, computed, 40);
PLACE(cdprep_contact_list, work, 48);
SIZE(cdprep_contact_options, 40);
PLACE(cdprep_contact_options, tolerance, 8);
PLACE(cdprep_contact_options, manifold, 16);
PLACE(cdprep_contact_options, most, 20);
PLACE(cdprep_contact_options, work, 24);
PLACE(cdprep_contact_options, cluster_angle, 32);
SIZE(cdprep_hull, 16);
PLACE(cdprep_hull, scope, 8);
PLACE(cdprep_hull, number, 12);
SIZE(cdprep_hull_cache, 64);
SIZE(cdprep_hull_pair, 248);
PLACE(cdprep_hull_pair, a, 8);
PLACE(cdprep_hull_pair, b, 24);
PLACE(cdprep_hull_pair, cache, 40);
PLACE(cdprep_hull_pair, moving, 48);
PLACE(cdprep_hull_pair, reserved, 52);
PLACE(cdprep_hull_pair, pose_a, 56);
PLACE(cdprep_hull_pair, pose_b, 152);
SIZE(cdprep_penetration, 96);
PLACE(cdprep_penetration, reserved, 4);
PLACE(cdprep_penetration, lower, 8);
PLACE(cdprep_penetration, upper, 16);
PLACE(cdprep_penetration, normal, 24);
PLACE(cdprep_penetration, on_a, 48);
PLACE(cdprep_penetration, on_b, 72);
SIZE(cdprep_closest_features, 120);
PLACE(cdprep_closest_features, parallel, 4);
PLACE(cdprep_closest_features, a, 8);
PLACE(cdprep_closest_features, b, 32);
PLACE(cdprep_closest_features, lower, 56);
PLACE(cdprep_closest_features, upper, 64);
PLACE(cdprep_closest_features, on_a, 72);
PLACE(cdprep_closest_features, on_b, 96);
SIZE(cdprep_point_query, 48);
PLACE(cdprep_point_query, model, 8);
PLACE(cdprep_point_query, points, 16);
PLACE(cdprep_point_query, count, 24);
PLACE(cdprep_point_query, max_distance, 32);
PLACE(cdprep_point_query, through, 40);
PLACE(cdprep_point_query, reserved, 44);
SIZE(cdprep_closest_point, 48);
PLACE(cdprep_closest_point, triangle, 4);
PLACE(cdprep_closest_point, point, 8);
PLACE(cdprep_closest_point, lower, 32);
PLACE(cdprep_closest_point, upper, 40);
SIZE(cdprep_point_state, 16);
PLACE(cdprep_point_state, on_surface, 4);
PLACE(cdprep_point_state, winding, 8);
SIZE(cdprep_ray, 56);
PLACE(cdprep_ray, direction, 24);
PLACE(cdprep_ray, max_t, 48);
SIZE(cdprep_ray_query, 32);
PLACE(cdprep_ray_query, model, 8);
PLACE(cdprep_ray_query, rays, 16);
PLACE(cdprep_ray_query, count, 24);
SIZE(cdprep_ray_hit, 40);
PLACE(cdprep_ray_hit, triangle, 4);
PLACE(cdprep_ray_hit, t, 8);
PLACE(cdprep_ray_hit, point, 16);
SIZE(cdprep_ray_hit_list, 24);
PLACE(cdprep_ray_hit_list, room, 8);
PLACE(cdprep_ray_hit_list, count, 16);
SIZE(cdprep_shape_query, 208);
PLACE(cdprep_shape_query, model, 8);
PLACE(cdprep_shape_query, shape, 16);
PLACE(cdprep_shape_query, degenerate, 20);
PLACE(cdprep_shape_query, a, 24);
PLACE(cdprep_shape_query, b, 48);
PLACE(cdprep_shape_query, c, 72);
PLACE(cdprep_shape_query, radius, 96);
PLACE(cdprep_shape_query, max_distance, 104);
PLACE(cdprep_shape_query, world_from_model, 112);
SIZE(cdprep_triangle_list, 24);
PLACE(cdprep_triangle_list, room, 8);
PLACE(cdprep_triangle_list, count, 16);
#endif

/// What an initialiser writes, read as any caller could.
template <class T>
std::uint32_t tag_of(void (*init)(T*, std::size_t)) {
    T made;
    init(&made, sizeof made);
    EXPECT_EQ(made.head.size, sizeof made);
    return made.head.tag;
}

// Fixed once: a struct that an older program initialised is known by its tag.
TEST(CAbi, TagsAreWhatTheyWere) {
    EXPECT_EQ(tag_of(cdprep_workspace_options_init), 0xcd500001U);
    EXPECT_EQ(tag_of(cdprep_open_options_init), 0xcd500002U);
    EXPECT_EQ(tag_of(cdprep_pair_init), 0xcd500003U);
    EXPECT_EQ(tag_of(cdprep_distance_options_init), 0xcd500004U);
    EXPECT_EQ(tag_of(cdprep_contact_options_init), 0xcd500005U);
    EXPECT_EQ(tag_of(cdprep_hull_pair_init), 0xcd500006U);
    EXPECT_EQ(tag_of(cdprep_point_query_init), 0xcd500007U);
    EXPECT_EQ(tag_of(cdprep_ray_query_init), 0xcd500008U);
    EXPECT_EQ(tag_of(cdprep_shape_query_init), 0xcd500009U);
    EXPECT_EQ(tag_of(cdprep_build_options_init), 0xcd50000aU);
}

}  // namespace
