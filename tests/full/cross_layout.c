// SPDX-License-Identifier: MIT
// Compiles where every field of the C API is where its golden list says, with pointers of 32 bits.
// The list computes these places; here a compiler that makes such code confirms them.
#include <stddef.h>

#include "cdprep/cdprep.h"

#define CDPREP_STRUCT(type, size_64, size_32) _Static_assert(sizeof(type) == size_32, #type);
#define CDPREP_FIELD(type, field, place_64, place_32) \
    _Static_assert(offsetof(type, field) == place_32, #type "." #field);
#define CDPREP_VALUE(name, value) _Static_assert(name == value, #name);
#define CDPREP_CALLBACK(name, ...)
#define CDPREP_FUNCTION(name, ...)
#include "c_abi.inc"
