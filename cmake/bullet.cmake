# SPDX-License-Identifier: MIT
# Bullet in its default build: float. Optional: tools/simulate/dynamics moves bodies with it, and
# benchmarks and studies are set beside it.
include_guard(GLOBAL)
find_path(CDPREP_BULLET_INCLUDE BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h
    PATH_SUFFIXES bullet)
find_library(CDPREP_BULLET_DYNAMICS BulletDynamics)
find_library(CDPREP_BULLET_COLLISION BulletCollision)
find_library(CDPREP_BULLET_MATH LinearMath)
set(CDPREP_BULLET_FOUND NO CACHE INTERNAL "Bullet with its dynamics")
if(CDPREP_BULLET_INCLUDE AND CDPREP_BULLET_DYNAMICS AND CDPREP_BULLET_COLLISION
   AND CDPREP_BULLET_MATH)
    set(CDPREP_BULLET_FOUND YES CACHE INTERNAL "Bullet with its dynamics")
endif()
