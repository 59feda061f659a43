// SPDX-License-Identifier: MIT
#pragma once

/// The C++ API: models, poses, and queries about them. Include cells.h, sweep.h, window.h and the
/// headers of cdprep/advanced/ and cdprep/cells/ where they are needed.

#include "cdprep/ask.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/broad_phase.h"
#include "cdprep/build.h"
#include "cdprep/contacts.h"
#include "cdprep/hulls.h"
#include "cdprep/live_model.h"
#include "cdprep/model.h"
#include "cdprep/motion.h"
#include "cdprep/pairs.h"
#include "cdprep/parallel.h"
#include "cdprep/plan.h"
#include "cdprep/points.h"
#include "cdprep/pose.h"
#include "cdprep/precondition.h"
#include "cdprep/result.h"
#include "cdprep/scene.h"
#include "cdprep/self.h"
#include "cdprep/time_of_impact.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"
