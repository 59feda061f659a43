# SPDX-License-Identifier: MIT
# Install rules, exported targets (find_package(cdprep)) and pkg-config.
include(CMakePackageConfigHelpers)

install(TARGETS cdprep_format cdprep cdprep_cells EXPORT cdprepTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY format/include/ lib/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT cdprepTargets NAMESPACE cdprep::
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdprep)
install(FILES LICENSES/MIT.txt format/FORMAT.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/cdprepConfig.cmake.in cdprepConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdprep)
write_basic_package_version_file(cdprepConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_file(cmake/cdprep.pc.in cdprep.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cdprepConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/cdprepConfigVersion.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cdprep)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cdprep.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

if(CDPREP_TOOLS)
    install(TARGETS cdprep_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    set(manuals ${CMAKE_CURRENT_BINARY_DIR}/manuals)
    install(DIRECTORY ${manuals}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
    install(FILES ${manuals}/completion/cdprep.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME cdprep)
    install(FILES ${manuals}/completion/_cdprep
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${manuals}/completion/cdprep.fish
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
    install(FILES LICENSES/GPL-3.0-or-later.txt DESTINATION ${CMAKE_INSTALL_DOCDIR})
    if(TARGET cdprep-import-child)
        install(TARGETS cdprep-import-child
            RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/cdprep)
    endif()
endif()
