# SPDX-License-Identifier: MIT
# Stops where memory is laid out otherwise than in a baked file, which is mapped as it is.
if(CMAKE_CXX_BYTE_ORDER STREQUAL "BIG_ENDIAN")
    message(FATAL_ERROR "cdprep needs a little-endian processor, but ${CMAKE_SYSTEM_PROCESSOR} is "
        "big-endian: a baked file is little-endian and is mapped as it is.")
endif()
if(NOT CMAKE_SIZEOF_VOID_P EQUAL 8 AND NOT CDPREP_PROCESSOR STREQUAL "wasm32")
    math(EXPR bits "8 * ${CMAKE_SIZEOF_VOID_P}")
    message(FATAL_ERROR "cdprep needs pointers of 64 bits, but those of this compiler have ${bits} "
        "bits: a model of many triangles does not fit in its memory. The only exception is WebAssembly.")
endif()
