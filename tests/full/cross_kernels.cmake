# SPDX-License-Identifier: MIT
# tests/full/cross compares the kernels of WebAssembly with those of this machine.
add_executable(cross_kernels EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/cross_kernels.cpp)
cdprep_compile_options(cross_kernels)
target_include_directories(cross_kernels PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/lib)
target_compile_definitions(cross_kernels PRIVATE ${CDPREP_KERNEL_DEFINITIONS})
target_link_libraries(cross_kernels PRIVATE cdprep::cdprep)
