// SPDX-License-Identifier: MIT
// Do two baked models collide, and which triangles overlap, as one slides along x?
//
//     sample_touching bracket.cdp.h5 bolt.cdp.h5
#include <algorithm>
#include <iostream>
#include <vector>

#include "cdprep/pairs.h"

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: sample_touching A B\n";
        return 2;
    }
    const auto a = cdprep::Model::open(argv[1]);
    const auto b = cdprep::Model::open(argv[2]);
    if (!a || !b) {
        std::cerr << (a ? b : a).error().message << '\n';
        return 3;
    }
    cdprep::Workspace workspace;
    std::vector<cdprep::TrianglePair> pairs(1000);  // yours: queries never allocate
    for (const double x : {0.0, 23.0, 40.0, 80.0}) {
        const auto pose = cdprep::Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, 15, -19.5});
        if (!pose) {
            std::cerr << pose.error().message << '\n';
            return 2;
        }
        const auto placement = cdprep::Placement::b_moves(pose.value());
        const bool hit = cdprep::collide({a.value(), b.value(), placement}, workspace).hit ==
                         cdprep::Answer::yes;
        const std::size_t count =
            cdprep::overlaps({a.value(), b.value(), placement}, workspace, pairs);
        std::cout << "x = " << x << ": " << (hit ? "collision" : "free") << ", " << count
                  << " overlapping pairs";
        for (std::size_t i = 0; i < std::min<std::size_t>({count, pairs.size(), 3}); ++i) {
            std::cout << (i == 0 ? ": " : ", ") << pairs[i].a << '-' << pairs[i].b;
        }
        std::cout << '\n';
    }
}
