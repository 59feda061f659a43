// SPDX-License-Identifier: MIT
#ifdef CDPREP_HAVE_CCD
#include <ccd/ccd.h>

#include <algorithm>

#include "accuracy/peers/peer.h"

namespace cdprep::test {
namespace {

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
    const auto& points = *static_cast<const Points*>(object);
    const auto height = [&](const Double3& p) {
        return direction->v[0] * p.x + direction->v[1] * p.y + direction->v[2] * p.z;
    };
    const auto best =
        std::max_element(points.begin(), points.end(),
                         [&](const Double3& p, const Double3& q) { return height(p) < height(q); });
    ccdVec3Set(point, best->x, best->y, best->z);
}

void middle(const void* object, ccd_vec3_t* point) {
    const auto& points = *static_cast<const Points*>(object);
    ccdVec3Set(point, 0, 0, 0);
    for (const Double3& p : points) {
        const auto count = static_cast<double>(points.size());
        point->v[0] += p.x / count;
        point->v[1] += p.y / count;
        point->v[2] += p.z / count;
    }
}

ccd_t settings() {
    ccd_t made;
    CCD_INIT(&made);
    made.support1 = made.support2 = support;
    made.center1 = made.center2 = middle;
    made.max_iterations = 500;
    return made;
}

}  // namespace

void add_ccd(std::vector<Peer>& peers) {
    Peer gjk = {"libccd-GJK"};
    gjk.hulls_collide = [](const Points& a, const Points& b) {
        const ccd_t made = settings();
        return ccdGJKIntersect(&a, &b, &made) != 0;
    };
    Peer mpr = {"libccd-MPR"};
    mpr.hulls_collide = [](const Points& a, const Points& b) {
        const ccd_t made = settings();
        return ccdMPRIntersect(&a, &b, &made) != 0;
    };
    peers.push_back(gjk);
    peers.push_back(mpr);
}

}  // namespace cdprep::test
#endif
