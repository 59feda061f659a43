// SPDX-License-Identifier: MIT
// Drops the body of an MJCF file onto its floor for two seconds in MuJoCo, and prints what became
// of it as JSON: drop.mjs in C++. The body is the last, and has a free joint.
//
// Usage: drop_mujoco MODEL.mjcf X Y Z QX QY QZ QW
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;

constexpr double kSeconds = 2;

/// Each mesh, as given and as MuJoCo's own hull of it.
void count_points(const mjModel& model, Json& result) {
    int given = 0, kept = 0;
    for (int i = 0; i < model.nmesh; ++i) {
        given += model.mesh_vertnum[i];
        const int graph = model.mesh_graphadr[i];
        if (graph >= 0) kept += model.mesh_graph[graph];  // begins with the number of points
    }
    result["parts"] = model.nmesh;
    result["given"] = given;
    result["kept"] = kept;
}

Json drop(const mjModel& model, const std::array<double, 7>& start) {
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&model), mj_deleteData);
    const std::array<double, 7> q = {start[0], start[1], start[2], start[6],
                                     start[3], start[4], start[5]};
    std::copy(q.begin(), q.end(), data->qpos);
    bool is_finite = true;
    const auto steps = std::lround(kSeconds / model.opt.timestep);
    for (long step = 0; step < steps; ++step) {
        mj_step(&model, data.get());
        for (int i = 0; i < model.nq; ++i) is_finite = is_finite && std::isfinite(data->qpos[i]);
    }
    const mjtNum *at = data->qpos, *v = data->qvel;
    Json result = {
        {"mass", model.body_mass[model.nbody - 1]}, {"is_finite", is_finite},
        {"position", {at[0], at[1], at[2]}},        {"quaternion", {at[4], at[5], at[6], at[3]}},
        {"speed", std::hypot(v[0], v[1], v[2])},    {"spin", std::hypot(v[3], v[4], v[5])}};
    count_points(model, result);
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 9) {
        std::fprintf(stderr, "usage: drop_mujoco MODEL.mjcf X Y Z QX QY QZ QW\n");
        return 2;
    }
    std::array<double, 7> start{};
    for (std::size_t i = 0; i < start.size(); ++i) start[i] = std::atof(argv[2 + i]);
    std::array<char, 1000> why = {};
    const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
        mj_loadXML(argv[1], nullptr, why.data(), static_cast<int>(why.size())), mj_deleteModel);
    if (!model) {
        std::fprintf(stderr, "%s\n", why.data());
        return 1;
    }
    if (model->nq != 7) {
        std::fprintf(stderr, "%s has no body with a free joint\n", argv[1]);
        return 1;
    }
    std::puts(drop(*model, start).dump().c_str());
    return 0;
}
