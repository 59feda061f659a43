// SPDX-License-Identifier: MIT
// Prints every pair of triangles of two OFF files that have a point in common,
// by CGAL's exact predicates and brute force. Triangles must not be degenerate.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

double read_double(std::istream& in) {
    std::string word;
    in >> word;
    return std::strtod(word.c_str(), nullptr);
}

std::vector<Kernel::Triangle_3> read_off(const char* path) {
    std::ifstream in(path);
    std::string word;
    std::size_t vertices = 0, faces = 0, edges = 0;
    in >> word >> vertices >> faces >> edges;
    std::vector<Kernel::Point_3> points;
    for (std::size_t i = 0; i < vertices; ++i) {
        const double x = read_double(in), y = read_double(in), z = read_double(in);
        points.emplace_back(x, y, z);
    }
    std::vector<Kernel::Triangle_3> triangles;
    for (std::size_t i = 0; i < faces; ++i) {
        std::size_t corners = 0;
        std::array<std::size_t, 3> corner{};
        in >> corners >> corner[0] >> corner[1] >> corner[2];
        triangles.emplace_back(points.at(corner[0]), points.at(corner[1]), points.at(corner[2]));
    }
    return triangles;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const auto a = read_off(argv[1]);
    const auto b = read_off(argv[2]);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            if (CGAL::do_intersect(a[i], b[j])) std::cout << i << ' ' << j << '\n';
        }
    }
}
