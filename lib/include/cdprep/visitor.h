// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

namespace cdprep {

/// A reference to a callable that receives each answer. If the callable returns false, the search
/// ends. A Visitor does not copy the callable, which must outlive the query. The callable must not
/// throw and must not use the workspace of the query. The callable runs in the caller's
/// floating-point environment.
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
