# SPDX-License-Identifier: MIT
# tests/full/cross runs it with pointers of 32 bits.
add_executable(cross_sizes EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/cross_sizes.c)
cdprep_compile_options(cross_sizes)
target_link_libraries(cross_sizes PRIVATE cdprep::cdprep)
set_target_properties(cross_sizes PROPERTIES LINKER_LANGUAGE CXX)
