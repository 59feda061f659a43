// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/assimp_child.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "import/collada_asset.h"
#include "import/flatten_scene.h"
#include "import/named_runs.h"

namespace cdprep::import {
namespace {

constexpr const char* kProgram = "cdprep-import-child";
constexpr int kResult = 3;  // descriptor numbers in the child
constexpr int kLifeline = 4;

/// A file descriptor that this object owns and closes. Move-only.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        close();
    }

    [[nodiscard]] int number() const noexcept {
        return number_;
    }
    void close() noexcept {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

private:
    int number_;
};

/// Returns the path of the child program: beside the running program, where it is installed, or
/// in a build tree.
std::optional<std::filesystem::path> find_child_program() {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return std::nullopt;
    const std::filesystem::path folder = self.parent_path();
    std::vector<std::filesystem::path> places = {folder / kProgram,
                                                 folder / "../libexec/cdprep" / kProgram};
    constexpr int kBuildTreeDepth = 6;
    std::filesystem::path above = folder;
    for (int i = 0; i < kBuildTreeDepth; ++i, above = above.parent_path()) {
        places.push_back(above / "bin" / kProgram);
    }
    const auto found = std::find_if(places.begin(), places.end(), [](const auto& place) {
        return ::access(place.c_str(), X_OK) == 0;
    });
    return found == places.end() ? std::nullopt : std::optional(*found);
}

/// The end of the child process.
struct Ending {
    bool in_time = true;
    int status = 0;  ///< from waitpid()
};

class Child {
public:
    /// Starts the program. It holds `result` as kResult and the other end of the
    /// lifeline as kLifeline. The lifeline closes when the program ends.
    static std::optional<Child> start(const std::filesystem::path& program,
                                      const std::filesystem::path& path, int result,
                                      const ImportOptions& options) {
        std::array<int, 2> pipe{};
        if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return std::nullopt;
        Descriptor ours(pipe[0]);
        const Descriptor theirs(pipe[1]);

        // Descriptors are first moved to higher numbers, so that they do not collide.
        constexpr int kFirstFree = 10;
        const Descriptor result_copy(::fcntl(result, F_DUPFD_CLOEXEC, kFirstFree));
        const Descriptor theirs_copy(::fcntl(theirs.number(), F_DUPFD_CLOEXEC, kFirstFree));
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
            ::posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
        }
        ::posix_spawn_file_actions_adddup2(&actions, result_copy.number(), kResult);
        ::posix_spawn_file_actions_adddup2(&actions, theirs_copy.number(), kLifeline);
        ::posix_spawn_file_actions_addclosefrom_np(&actions, kLifeline + 1);

        std::array<std::string, 4> words = {program.string(), path.string(),
                                            std::to_string(options.memory_bytes),
                                            std::to_string(options.time.count() + 1)};
        std::array<char*, 5> arguments = {words[0].data(), words[1].data(), words[2].data(),
                                          words[3].data(), nullptr};
        std::array<char*, 1> environment = {nullptr};
        pid_t process = 0;
        const int failed = ::posix_spawn(&process, program.c_str(), &actions, nullptr,
                                         arguments.data(), environment.data());
        ::posix_spawn_file_actions_destroy(&actions);
        if (failed) return std::nullopt;
        return Child(process, std::move(ours));
    }

    /// Waits until the child ends, and kills it when the time is up.
    Ending wait(std::chrono::seconds time) {
        Ending ending;
        const auto last = std::chrono::steady_clock::now() + time;
        for (;;) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                last - std::chrono::steady_clock::now());
            constexpr std::int64_t kLongestPoll = 1 << 30;
            pollfd lifeline{lifeline_.number(), POLLIN, 0};
            const auto wait_ms = std::clamp<std::int64_t>(left.count() + 1, 0, kLongestPoll);
            const int ready = ::poll(&lifeline, 1, static_cast<int>(wait_ms));
            if (ready > 0) break;
            if (ready < 0 && errno == EINTR) continue;
            if (left.count() > 0) continue;
            ::kill(process_, SIGKILL);
            ending.in_time = false;
            break;
        }
        while (::waitpid(process_, &ending.status, 0) < 0 && errno == EINTR) {
        }
        return ending;
    }

private:
    Child(pid_t process, Descriptor lifeline) : process_(process), lifeline_(std::move(lifeline)) {}

    pid_t process_;
    Descriptor lifeline_;
};

Error out_of_time(const SourceFile& file, const ImportOptions& options) {
    return file.over_budget("the import took longer than the limit of " +
                            std::to_string(options.time.count()) +
                            " s. Raise --import-time to read it");
}

Error out_of_memory(const SourceFile& file, std::uint64_t input_bytes,
                    const ImportOptions& options) {
    const std::uint64_t input = std::max<std::uint64_t>(input_bytes, file.bytes().size());
    const std::uint64_t honest = honest_memory(input);
    if (honest < options.memory_bytes) {
        return file.unreadable("has " + std::to_string(input) + " bytes but needs more than " +
                               std::to_string(honest >> 20) +
                               " MiB of memory: a count in the file is wrong");
    }
    const std::string limit = std::to_string(options.memory_bytes >> 20) + " MiB";
    return file.over_budget("the import needs more than the limit of " + limit +
                            " of memory. Raise --import-memory to read it");
}

/// Returns one line without the full stop. The texts of importers have many forms.
std::string as_clause(std::string_view text) {
    constexpr std::size_t kShown = 300;
    std::string clause = utf8_name(text.substr(0, kShown));
    while (!clause.empty() && (clause.back() == '.' || clause.back() == ' ')) clause.pop_back();
    return clause.empty() ? "the file cannot be read" : clause;
}

Error failure(const SourceFile& file, const Ending& ending, const ImportOptions& options) {
    if (!ending.in_time) return out_of_time(file, options);
    if (WIFSIGNALED(ending.status)) {
        const int signal = WTERMSIG(ending.status);
        if (signal == SIGXCPU) return out_of_time(file, options);
        if (signal == SIGXFSZ) return out_of_memory(file, 0, options);
        return file.unreadable("the importer crashed on it (signal " + std::to_string(signal) +
                               ")");
    }
    return file.unreadable("the importer gave no result (exit " +
                           std::to_string(WEXITSTATUS(ending.status)) + ")");
}

/// Returns the reason why the child's result is no scene, or nothing.
std::optional<Error> find_failure(const SourceFile& file, std::span<const std::byte> bytes,
                                  const Ending& ending, const ImportOptions& options) {
    const auto header = read_scene_header(bytes);
    const bool ended_well = WIFEXITED(ending.status) && WEXITSTATUS(ending.status) == 0;
    if (!header || !ended_well) return failure(file, ending, options);
    const auto* text = reinterpret_cast<const char*>(bytes.data() + bytes.size());
    const std::string_view message(text - header->text_bytes, header->text_bytes);
    switch (header->outcome) {
        case SceneOutcome::read:
            return std::nullopt;
        case SceneOutcome::unreadable:
            return file.unreadable(as_clause(message));
        default:
            return out_of_memory(file, header->input_bytes, options);
    }
}

}  // namespace

ChildResult::ChildResult(int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || status.st_size <= 0) return;
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (memory == MAP_FAILED) return;
    bytes_ = {static_cast<const std::byte*>(memory), size};
}

ChildResult::ChildResult(ChildResult&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

ChildResult::~ChildResult() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

Result<ChildResult> read_in_child(const SourceFile& file, const std::filesystem::path& path,
                                  const ImportOptions& options) {
    if (const std::string outside = find_outside_reference(file.bytes()); !outside.empty()) {
        return file.unreadable("refers to another file, " + utf8_name(outside) +
                               ", which is not supported");
    }
    const auto program = find_child_program();
    if (!program) {
        return file.unreadable(std::string("the program ") + kProgram +
                               ", which reads this format, is neither beside cdprep nor in "
                               "../libexec/cdprep");
    }
    const Descriptor result(::memfd_create("cdprep-import", MFD_CLOEXEC));
    auto child = Child::start(*program, path, result.number(), options);
    if (result.number() < 0 || !child) {
        return file.unreadable(program->string() +
                               ", which reads this format, cannot be started: " +
                               std::generic_category().message(errno));
    }
    const Ending ending = child->wait(options.time);
    ChildResult scene(result.number());
    if (auto error = find_failure(file, scene.bytes(), ending, options)) return *std::move(error);
    return scene;
}

Result<mesh::TriangleSoup> import_in_child(const SourceFile& file,
                                           const std::filesystem::path& path,
                                           const ImportOptions& options) {
    const Result<ChildResult> scene = read_in_child(file, path, options);
    if (!scene) return scene.error();
    Result<mesh::TriangleSoup> soup = flatten_scene(file, scene->bytes(), options);
    if (soup) add_collada_asset(file.bytes(), soup.value());
    return soup;
}

}  // namespace cdprep::import
