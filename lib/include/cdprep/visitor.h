// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

namespace cdprep {

/// Something to be called with each answer; false ends the search. Refers to the
/// callable and copies nothing, which must outlive the call it is handed to. It may
/// not throw and may not use the workspace of the question. Runs in the floating-point
/// environment of the caller.
template <class Answer>
class Visitor {
public:
    template <class Visit>
    requires(!std::is_same_v<std::remove_const_t<Visit>, Visitor>) Visitor(Visit& visit)
    noexcept  // NOLINT(google-explicit-constructor)
        : context_(const_cast<void*>(static_cast<const void*>(&visit))),
          call_([](void* context, const Answer& answer) {
              return static_cast<bool>((*static_cast<Visit*>(context))(answer));
          }) {}
    bool operator()(const Answer& answer) const {
        return call_(context_, answer);
    }

private:
    void* context_;
    bool (*call_)(void*, const Answer&);
};

}  // namespace cdprep
