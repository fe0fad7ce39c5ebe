#include "base/process.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

namespace limn {

std::optional<std::filesystem::path> findProgram(const std::string& name) {
    if (name.find('/') != std::string::npos)
        return ::access(name.c_str(), X_OK) == 0 ? std::optional<std::filesystem::path>(name) : std::nullopt;
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const auto file = std::filesystem::path(folder) / name;
        if (::access(file.c_str(), X_OK) == 0) return file;
    }
    return std::nullopt;
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, Output output) {
    const auto program = findProgram(command.front());
    if (!program)
        throw Error(ExitCode::missingInput, {command.front()}, "the program is not there",
            fmt::format("install it (its package in Debian: {})", command.front()));
    std::array<int, 2> ends{-1, -1};
    said_ = ::memfd_create("said", MFD_CLOEXEC);
    if (said_ < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0)
        throw Error(ExitCode::internal, {command.front()}, fmt::format("no pipe to it ({})", std::strerror(errno)));
    input_ = ends[1];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    if (output == Output::kept)
        posix_spawn_file_actions_adddup2(&actions, said_, STDOUT_FILENO);
    else
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, said_, STDERR_FILENO);
    // The program shall end as programs do, whatever this process has arranged for itself (base/signals.h).
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const int failed = ::posix_spawn(&process_, program->c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    ::close(ends[0]);
    if (failed == 0) return;
    process_ = 0;
    throw Error(ExitCode::internal, {command.front()}, fmt::format("cannot be started ({})", std::strerror(failed)));
}

ChildProcess::~ChildProcess() {
    if (input_ >= 0) ::close(input_);
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    if (said_ >= 0) ::close(said_);
}

bool ChildProcess::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(input_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

ChildProcess::Result ChildProcess::finish() {
    ::close(std::exchange(input_, -1));
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {}
    process_ = 0;
    Result result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), {}};
    std::array<char, 4096> part{};
    ::lseek(said_, 0, SEEK_SET);
    for (ssize_t got = 0; (got = ::read(said_, part.data(), part.size())) > 0;)
        result.said.append(part.data(), static_cast<std::size_t>(got));
    return result;
}

}  // namespace limn
