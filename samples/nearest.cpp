// SPDX-License-Identifier: MIT
// Where is the surface nearest to a point?
//
//     cdprep bake samples/meshes/bracket.obj -o bracket.cdp.h5
//     sample_nearest bracket.cdp.h5 10 15 20
#include <cstdlib>
#include <iostream>

#include "cdprep/points.h"

int main(int argc, char** argv) {
    if (argc != 5) {
        std::cerr << "usage: sample_nearest FILE X Y Z\n";
        return 2;
    }
    const auto opened = cdprep::Model::open(argv[1]);
    if (!opened) {
        std::cerr << opened.error().message << '\n';
        return 3;
    }
    cdprep::Workspace workspace;  // scratch memory: make it once, use it for every query
    const cdprep::Double3 query{std::atof(argv[2]), std::atof(argv[3]), std::atof(argv[4])};
    const auto hit = cdprep::closest_point(opened.value(), query, workspace);
    if (!hit) {
        std::cout << "the model has no triangles\n";
        return 0;
    }
    std::cout << "nearest at (" << hit->point.x << ", " << hit->point.y << ", " << hit->point.z
              << "), " << hit->upper << " units away, on triangle " << hit->triangle << '\n';
}
