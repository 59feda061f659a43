// SPDX-License-Identifier: MIT
#pragma once

/// The functions that make models from arrays at run time. build_model() and build_image() make the
/// bytes that Model::open() takes. LiveModel holds a model whose vertices move. Headers in
/// cdprep/advanced/ declare the single steps of these builds; headers in cdprep/cells/ build
/// octrees and tetra-trees.

#include "cdprep/advanced/build_image.h"
#include "cdprep/advanced/build_model.h"
#include "cdprep/live_model.h"
