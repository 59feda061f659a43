// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/quiet.h"

#include <iostream>
#include <streambuf>

namespace cdprep::cli {
namespace {

bool was_asked = false;

/// A stream buffer that discards everything.
class Nowhere : public std::streambuf {
    int overflow(int byte) override {
        return traits_type::not_eof(byte);
    }
    std::streamsize xsputn(const char* /*bytes*/, std::streamsize count) override {
        return count;
    }
};

}  // namespace

void add_quiet(const Command& command) {
    const auto be_quiet = [] {
        was_asked = true;
        static Nowhere& nowhere = *new Nowhere;  // outlives the stream, which is flushed last
        std::cout.rdbuf(&nowhere);
    };
    command.add_flag("-q,--quiet", be_quiet, "Print no report and no progress").group("General");
}

bool is_quiet() {
    return was_asked;
}

}  // namespace cdprep::cli
