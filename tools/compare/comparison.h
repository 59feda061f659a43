// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "study/machine.h"
#include "study/pose_set.h"
#include "study/table.h"

namespace cdprep::study {

/// A model in a comparison, as read and as built.
struct ComparedModel {
    std::string name;
    std::string file;
    std::size_t read_vertices = 0;
    std::size_t read_triangles = 0;
    std::uint64_t read_hash = 0;
    std::size_t built_vertices = 0;
    std::size_t built_triangles = 0;
    std::uint64_t built_hash = 0;
    std::string likeness;  ///< a sentence
};

/// The poses at which a pair was queried.
struct ComparedPair {
    std::string a;
    std::string b;
    PoseSet poses;
};

/// The settings of all measurements. With the models, they suffice to repeat them.
struct ComparisonSettings {
    std::string version;  ///< of the program
    bool quick = false;
    std::uint64_t seed = 1;
    std::size_t per_stratum = 0;     ///< poses
    std::string poses;               ///< the folder that they were read from; empty: they are drawn
    std::size_t pairs_left_out = 0;  ///< by --quick
    std::size_t rounds = 0;
    std::size_t threads = 0;
};

/// The tables of the comparative study and of Ponce Atencio's talk, for some models.
struct Comparison {
    ComparisonSettings settings;
    Machine machine;
    std::vector<ComparedModel> models;
    std::vector<ComparedPair> pairs;
    std::vector<Table> tables;
    std::vector<Check> checks;
    std::vector<std::string> errata;  ///< of both publications: a sentence each
    std::vector<std::string> peers;   ///< which libraries answered, or why none did: sentences
};

}  // namespace cdprep::study
