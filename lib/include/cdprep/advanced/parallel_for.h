// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <type_traits>

namespace cdprep {

/// Work in numbered shares. Calling it with a number does that share. A Task refers to the
/// callable, which may be a lambda written in the call, and copies nothing. Copying a Task costs as
/// much as copying two pointers.
class Task {
public:
    template <class Body>
    requires(!std::is_same_v<Body, Task>) Task(const Body& body)
    noexcept  // NOLINT(google-explicit-constructor)
        : context_(&body), call_([](const void* context, std::size_t number) {
              (*static_cast<const Body*>(context))(number);
          }) {}
    void operator()(std::size_t number) const {
        call_(context_, number);
    }

private:
    const void* context_;
    void (*call_)(const void*, std::size_t);
};

/// The caller's threads. The library starts none. It calls `run(count, task)`, which calls task(0)
/// ... task(count - 1) and returns when all are done. The calls may be in any order and on any
/// threads, or all on one. `count` may be 0. `run` must not throw, except to propagate an exception
/// of a task. Query tasks never throw; build_bvh() tasks may throw std::bad_alloc.
///
/// In queries, a task that begins late finds little work left, or none. The best `run` executes
/// tasks on its own thread too, until all tasks have begun. It then waits for tasks that other
/// threads have begun. A ParallelFor refers to the callable, a named object such as a lambda, and
/// copies nothing. The callable must outlive the call, and any options that hold the ParallelFor.
/// `run` runs in the floating-point environment of the caller; tasks compute in the default one on
/// every thread.
///
///     const auto run = [&](std::size_t count, cdprep::Task task) {
///         std::vector<std::jthread> threads;
///         for (std::size_t i = 0; i < count; ++i) threads.emplace_back(task, i);
///     };
class ParallelFor {
public:
    template <class Run>
    requires(!std::is_same_v<std::remove_const_t<Run>, ParallelFor>) ParallelFor(Run& run)
    noexcept  // NOLINT(google-explicit-constructor)
        : context_(const_cast<void*>(static_cast<const void*>(&run))),
          call_([](void* context, std::size_t count, Task task) {
              (*static_cast<Run*>(context))(count, task);
          }) {}
    void operator()(std::size_t count, Task task) const {
        call_(context_, count, task);
    }

private:
    void* context_;
    void (*call_)(void*, std::size_t, Task);
};

/// Runs the tasks one after the other on the calling thread.
inline constexpr auto serial_for = [](std::size_t count, Task task) {
    for (std::size_t i = 0; i < count; ++i) task(i);
};

/// Runs body(first, last) for consecutive parts of [0, count). Each part is a task of `size` items;
/// the last may have fewer. `size` is not 0.
template <class Body>
void for_chunks(std::size_t count, std::size_t size, ParallelFor parallel_for, const Body& body) {
    assert(size > 0);
    parallel_for((count + size - 1) / size, [&](std::size_t chunk) {
        const std::size_t first = chunk * size;
        body(first, std::min(count, first + size));
    });
}

}  // namespace cdprep
