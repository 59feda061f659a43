// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene_file/changing_model.h"
#include "scene_file/load_models.h"

namespace cdprep::report {

/// Returns a page of text: layers, the plan, what is not computed and the bytes of the scene. Then
/// follow the models. For each it lists what it must serve. It also lists the sections that are
/// read and those never touched, with their bytes. For each live model it tells how it changes, and
/// its bytes.
[[nodiscard]] std::string plan_text(const scenes::SceneFile& scene, const Plan& plan,
                                    std::span<const scenes::SceneModel> models,
                                    std::span<const scenes::ChangingObjects> changing);

/// Returns the same as JSON (simulate.schema.json).
[[nodiscard]] std::string plan_json(const scenes::SceneFile& scene, const Plan& plan,
                                    std::span<const scenes::SceneModel> models,
                                    std::span<const scenes::ChangingObjects> changing);

/// Returns the JSON of a scene for which there is no plan.
[[nodiscard]] std::string refused_json(const std::string& scene, int exit,
                                       const std::vector<std::string>& refusals);

}  // namespace cdprep::report
