// SPDX-License-Identifier: MIT
// Opens a file that is not there: proves that headers and libraries fit together.
#include <cstdio>

#include "cdprep/format/find_damage.h"
#include "cdprep/pairs.h"

int main() {
    const auto opened = cdprep::Model::open("no such file.cdp.h5");
    const bool refused = !opened && !opened.error().message.empty();
    const bool checked = cdprep::format::find_damage({}).has_value();
    std::puts(refused ? opened.error().message.c_str() : "opened a file that is not there");
    return refused && checked ? 0 : 1;
}
