# SPDX-License-Identifier: MIT
# Install rules, exported targets (find_package(cdprep)) and pkg-config. The components are the
# packages of packaging/debian.cmake.
include(CMakePackageConfigHelpers)

# Libraries and programs find the shared libraries beside them, wherever the prefix is moved. In
# the folders of the system, the loader finds them.
function(cdprep_find_beside target from)
    if(BUILD_SHARED_LIBS AND NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
        file(RELATIVE_PATH way ${from} ${CMAKE_INSTALL_FULL_LIBDIR})
        set_target_properties(${target} PROPERTIES INSTALL_RPATH $ORIGIN/${way})
    endif()
endfunction()

install(TARGETS cdprep cdprep_cells EXPORT cdprepTargets
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
cdprep_find_beside(cdprep_cells ${CMAKE_INSTALL_FULL_LIBDIR})
install(DIRECTORY format/include/ lib/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    COMPONENT development)

set(cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/cdprep)
install(EXPORT cdprepTargets NAMESPACE cdprep:: DESTINATION ${cmake_folder} COMPONENT development)
configure_package_config_file(cmake/cdprepConfig.cmake.in cdprepConfig.cmake
    INSTALL_DESTINATION ${cmake_folder})
write_basic_package_version_file(cdprepConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cdprepConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/cdprepConfigVersion.cmake
    DESTINATION ${cmake_folder} COMPONENT development)

# The prefix is found from the place of the .pc file, so that it may be moved. That of the system is
# not: pkg-config leaves out -I/usr/include if it is spelt so.
set(CDPREP_PC_PREFIX ${CMAKE_INSTALL_PREFIX})
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND NOT IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
    string(REGEX REPLACE "[^/]+" ".." up ${CMAKE_INSTALL_LIBDIR})
    set(CDPREP_PC_PREFIX \${pcfiledir}/../${up})
endif()
foreach(folder LIBDIR INCLUDEDIR)
    set(CDPREP_PC_${folder} \${prefix}/${CMAKE_INSTALL_${folder}})
    if(IS_ABSOLUTE ${CMAKE_INSTALL_${folder}})
        set(CDPREP_PC_${folder} ${CMAKE_INSTALL_${folder}})
    endif()
endforeach()
# A static library names what it needs in Libs, because a linker for C needs it in any case.
list(JOIN CDPREP_CXX_LIBRARY " " cxx_library)
if(BUILD_SHARED_LIBS)
    set(CDPREP_PC_LIBS_PRIVATE " ${cxx_library}")
    if(WIN32)
        set(CDPREP_PC_CFLAGS " -DCDPREP_SHARED")
    endif()
else()
    set(CDPREP_PC_LIBS " ${cxx_library}")
endif()
foreach(name cdprep cdprep_cells)
    configure_file(cmake/${name}.pc.in ${name}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()

# Documents keep their places, so that links between them hold. Samples are installed as examples.
file(GLOB documents RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS
    *.md docs/*.md format/*.md packaging/*.md samples/*.md tests/accuracy/*.md)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${documents})
set(documents_folder ${CMAKE_CURRENT_BINARY_DIR}/documents)
file(REMOVE_RECURSE ${documents_folder})
foreach(document IN LISTS documents)
    file(READ ${document} text)
    string(REGEX REPLACE "\\]\\(((\\.\\./)*)samples/" "](\\1examples/" text "${text}")
    string(REGEX REPLACE "^samples/" "examples/" document ${document})
    file(WRITE ${documents_folder}/${document} "${text}")
endforeach()
install(DIRECTORY ${documents_folder}/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
file(GLOB linked RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS
    tools/*/*.schema.json tools/validate/RULES.md)
foreach(file IN LISTS linked)
    cmake_path(GET file PARENT_PATH folder)
    install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT documentation)
endforeach()
install(FILES LICENSES/MIT.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation
    FILES_MATCHING PATTERN "*.png" PATTERN "*.svg")
install(DIRECTORY samples/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT documentation
    FILES_MATCHING PATTERN "*.c" PATTERN "*.cpp" PATTERN "*.h" PATTERN "*.mjs" PATTERN "*.obj"
        PATTERN "*.json" PATTERN "*.pc2")

if(CDPREP_TOOLS)
    install(TARGETS cdprep_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
    cdprep_find_beside(cdprep_program ${CMAKE_INSTALL_FULL_BINDIR})
    install(TARGETS cdprep-import-child
        RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/cdprep COMPONENT program)
    cdprep_find_beside(cdprep-import-child ${CMAKE_INSTALL_FULL_LIBEXECDIR}/cdprep)
    set(manuals ${CMAKE_CURRENT_BINARY_DIR}/manuals)
    install(DIRECTORY ${manuals}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
    install(FILES ${manuals}/completion/cdprep.bash COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME cdprep)
    install(FILES ${manuals}/completion/_cdprep COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${manuals}/completion/cdprep.fish COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
    install(FILES LICENSES/GPL-3.0-or-later.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT documentation)
endif()
