// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <assimp/DefaultIOSystem.h>

#include "input_files.h"

namespace cdprep::import {

/// Opens for assimp the files that it may read, and records the opened and the missing ones.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    explicit FolderFiles(InputFiles& files) : files_(files) {}

    bool Exists(const char* name) const override;
    Assimp::IOStream* Open(const char* name, const char* mode) override;

private:
    InputFiles& files_;
};

}  // namespace cdprep::import
