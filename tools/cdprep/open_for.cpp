// SPDX-License-Identifier: GPL-3.0-or-later
#include "open_for.h"

namespace cdprep::cli {

Result<Model> open_for(const std::filesystem::path& path, Ask asks, Structure through) {
    return Model::open(path, asks | ask_of(through));
}

}  // namespace cdprep::cli
