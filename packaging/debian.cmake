# SPDX-License-Identifier: MIT
# Debian packages of a build that is configured for them: packaging/README.md has the commands.
# Without CDPREP_TOOLS, they are those of the library alone.
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr" OR NOT BUILD_SHARED_LIBS)
    message(FATAL_ERROR "CDPREP_DEBIAN needs the prefix /usr and shared libraries, but "
        "CMAKE_INSTALL_PREFIX is \"${CMAKE_INSTALL_PREFIX}\" and BUILD_SHARED_LIBS is "
        "\"${BUILD_SHARED_LIBS}\": use `cmake --preset debian`.")
endif()

set(CDPREP_PACKAGE_CONTACT "The cdprep developers <cdprep@localhost>"
    CACHE STRING "Maintainer of the packages; set it before you publish them")
set(CPACK_PACKAGE_CONTACT ${CDPREP_PACKAGE_CONTACT})
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL runtime development documentation)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Defines the package of a component: what Debian calls it, its section, what it needs, and a text
# of lines below 80 characters. Their first line is PROJECT_DESCRIPTION.
set(version "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
function(cdprep_define_package component name section depends text)
    string(TOUPPER ${component} upper)
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_DESCRIPTION "${text}" PARENT_SCOPE)
    install(FILES ${PROJECT_SOURCE_DIR}/packaging/debian/copyright
                  ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian.gz
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endfunction()

set(library libcdprep${CDPREP_SOVERSION})
cdprep_define_package(runtime ${library} libs ""
    "The library maps models that cdprep baked. It answers which triangles
overlap, how far apart two models are, and where they touch. Answers are
exact, and the same on every machine.")
cdprep_define_package(development libcdprep-dev libdevel "${library} (= ${version})"
    "Headers for C99 and C++20, with the files of CMake and pkg-config.")
if(CDPREP_TOOLS)
    list(APPEND CPACK_COMPONENTS_ALL program)
    cdprep_define_package(program cdprep science "${library} (= ${version})"
        "The program bakes mesh files into models that the library maps. It validates
and repairs meshes, cuts them into convex pieces, and answers queries.")
    install(CODE "
        file(GLOB pages \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1/*.1)
        execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)
    " COMPONENT program)
endif()
cdprep_define_package(documentation cdprep-doc doc ""
    "Documents of the program and the library, the format of baked files, and
samples in C and C++.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)

# The loader's cache is renewed when the libraries come and go.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/triggers)

# A changelog of Debian's form, which names the version alone: CHANGELOG.md has the changes. Its date
# is as it is written, or that of SOURCE_DATE_EPOCH: the same sources give the same file.
file(READ packaging/debian/changelog changelog)
string(CONFIGURE "${changelog}" changelog @ONLY)
if(DEFINED ENV{SOURCE_DATE_EPOCH})
    string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
    string(REGEX REPLACE "(\n -- [^\n]*>  )[^\n]*" "\\1${date}" changelog "${changelog}")
endif()
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian "${changelog}")
execute_process(COMMAND gzip -9nf ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian
    COMMAND_ERROR_IS_FATAL ANY)

include(CPack)
