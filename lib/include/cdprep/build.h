// SPDX-License-Identifier: MIT
#pragma once

/// Models from arrays at run time: build_model() and build_image() make what Model::open() takes,
/// RuntimeModel keeps one whose vertices move. The single steps, octrees and tetra-trees have
/// headers of their own in cdprep/advanced/.

#include "cdprep/advanced/build_image.h"
#include "cdprep/advanced/build_model.h"
#include "cdprep/advanced/runtime_model.h"
