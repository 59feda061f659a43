// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/scene_file.h"

namespace cdprep::scenes {

Result<Pose> pose_of(const SceneFile& scene, const FileObject& object, double time_s) {
    Result<Pose> pose = scene.motions[object.motion].at(time_s, object.offset);
    if (pose) return pose;
    return Error{pose.error().code,
                 scene.name + ": object '" + object.name + "': " + pose.error().message};
}

}  // namespace cdprep::scenes
