// SPDX-License-Identifier: MIT
#include "export/colliders_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace cdprep::report {
namespace {

using Json = nlohmann::json;

/// A box of 1 x 2 x 3 with one corner at (0.1, 0, 0).
convex::ConvexHull small_box() {
    std::vector<format::Double3> points;
    for (unsigned k = 0; k < 8; ++k) {
        points.push_back(
            {(k & 1U) == 0 ? 0.1 : 1.1, (k & 2U) == 0 ? 0.0 : 2.0, (k & 4U) == 0 ? 0.0 : 3.0});
    }
    return convex::convex_hull(points);
}

TEST(CollidersJson, HasPointsTrianglesAndMass) {
    const convex::ConvexHull box = small_box();
    Colliders colliders;
    colliders.name = "box";
    colliders.metres_per_unit = 0.001;
    colliders.mass = write::BodyMass{6, {1, 2, 3}, {11, 22, 33, 12, 23, 31}};
    colliders.is_of_solid = true;
    colliders.error = 0.25;
    colliders.parts = {{"box_00", &box}, {"box_01", &box}};
    const Json json = Json::parse(colliders_json(colliders));
    EXPECT_EQ(json["format"], "cdprep colliders");
    EXPECT_EQ(json["version"], 1);
    EXPECT_EQ(json["name"], "box");
    EXPECT_EQ(json["metres_per_unit"], 0.001);
    EXPECT_EQ(json["error"], 0.25);
    EXPECT_EQ(json["mass"]["volume"], 6);
    EXPECT_EQ(json["mass"]["centre"], Json({1, 2, 3}));
    EXPECT_EQ(json["mass"]["inertia"], Json({{11, 12, 31}, {12, 22, 23}, {31, 23, 33}}));
    EXPECT_EQ(json["mass"]["of_solid"], true);
    EXPECT_EQ(json["mass"]["moments"].size(), 3U);
    EXPECT_EQ(json["mass"]["axes"].size(), 4U);
    ASSERT_EQ(json["parts"].size(), 2U);
    const Json& part = json["parts"][1];
    EXPECT_EQ(part["name"], "box_01");
    ASSERT_EQ(part["points"].size(), 24U);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(part["points"][3 * i].get<double>(), box.points[i].x);
        EXPECT_EQ(part["points"][3 * i + 1].get<double>(), box.points[i].y);
        EXPECT_EQ(part["points"][3 * i + 2].get<double>(), box.points[i].z);
    }
    ASSERT_EQ(part["triangles"].size(), 3 * box.facets.size());
    for (std::size_t i = 0; i < 36; ++i) {
        EXPECT_EQ(part["triangles"][i], box.facets[i / 3][i % 3]);
    }
    EXPECT_NEAR(part["volume"].get<double>(), 6, 1e-14);
}

TEST(CollidersJson, UnknownsAreNull) {
    const Json json = Json::parse(colliders_json({}));
    EXPECT_TRUE(json["metres_per_unit"].is_null());
    EXPECT_TRUE(json["mass"].is_null());
    EXPECT_TRUE(json["parts"].empty());
}

}  // namespace
}  // namespace cdprep::report
