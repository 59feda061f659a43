# SPDX-License-Identifier: MIT
# Other libraries, which benchmarks and studies are set beside. None is linked into the product, and
# all are optional.

function(cdprep_define_peer name)
    add_library(cdprep_peer_${name} INTERFACE)
    string(TOUPPER ${name} upper)
    target_compile_definitions(cdprep_peer_${name} INTERFACE CDPREP_HAVE_${upper})
    target_link_libraries(cdprep_peer_${name} INTERFACE ${ARGN})
endfunction()

# Sets the target beside those of the named libraries that are installed: each defines
# CDPREP_HAVE_NAME.
function(cdprep_link_peers target)
    foreach(name IN LISTS ARGN)
        if(TARGET cdprep_peer_${name})
            target_link_libraries(${target} PRIVATE cdprep_peer_${name})
        endif()
    endforeach()
endfunction()

find_package(fcl QUIET CONFIG)
if(fcl_FOUND)
    cdprep_define_peer(fcl fcl)
endif()

find_package(ccd QUIET CONFIG)
if(ccd_FOUND)
    cdprep_define_peer(ccd ccd)
endif()

find_package(CGAL QUIET CONFIG)
if(CGAL_FOUND)
    cdprep_define_peer(cgal CGAL::CGAL)
endif()

# Embree's own configuration asks for TBB, which is not to be looked for without the tools.
if(CDPREP_TOOLS)
    find_package(embree 3 QUIET CONFIG)
endif()
if(embree_FOUND)
    cdprep_define_peer(embree embree)
endif()

include(${CMAKE_CURRENT_LIST_DIR}/bullet.cmake)
if(CDPREP_BULLET_INCLUDE AND CDPREP_BULLET_COLLISION AND CDPREP_BULLET_MATH)
    cdprep_define_peer(bullet ${CDPREP_BULLET_COLLISION} ${CDPREP_BULLET_MATH})
    target_include_directories(cdprep_peer_bullet SYSTEM INTERFACE ${CDPREP_BULLET_INCLUDE})
    if(CDPREP_BULLET_DYNAMICS)
        cdprep_define_peer(bullet_dynamics ${CDPREP_BULLET_DYNAMICS})
    endif()
endif()

# Its configuration says how large a number of its is, and where its headers are.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
    pkg_check_modules(CDPREP_ODE QUIET IMPORTED_TARGET ode)
endif()
if(CDPREP_ODE_FOUND)
    cdprep_define_peer(ode PkgConfig::CDPREP_ODE)
endif()

find_library(CDPREP_QHULL qhull_r)
if(CDPREP_QHULL)
    cdprep_define_peer(qhull ${CDPREP_QHULL})
endif()

set(missing "")
foreach(name fcl ccd cgal embree bullet ode qhull)
    if(NOT TARGET cdprep_peer_${name})
        list(APPEND missing ${name})
    endif()
endforeach()
if(missing)
    list(JOIN missing ", " missing)
    message(STATUS "Not found, and left out of benchmarks and studies: ${missing}.")
endif()
