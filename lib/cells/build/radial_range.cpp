// SPDX-License-Identifier: MIT
#include "cells/build/tetra_steps.h"

#include "cells/build/cone_maximum.h"

namespace cdprep::build {

void add_part(const ConeFaces& faces, const SeenTriangle& t, RadialRange& range) noexcept {
    std::array<double, 3> sum{};
    RadialRange whole;
    for (std::size_t i = 0; i < 3; ++i) {
        sum[i] = sum_in(faces.sign, t[i]);
        const double slack = kValueSlacks * slack_of(t[i]);
        whole.add({sum[i] - slack, sum[i] + slack});
    }
    const bool lowers = whole.least < range.least && range.least > 0;
    const bool raises = whole.greatest > range.greatest;
    // Nearly always the whole triangle is within the range of others.
    if (!lowers && !raises) return;
    const FaceValues f = face_values(faces, t);
    if (raises) range.greatest = std::max(range.greatest, cone_maximum(f, sum));
    if (lowers) {
        const double least = -cone_maximum(f, {-sum[0], -sum[1], -sum[2]});
        range.least = std::min(range.least, std::max(0.0, least));
    }
}

}  // namespace cdprep::build
