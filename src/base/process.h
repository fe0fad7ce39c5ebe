// Other programs, started with a pipe to their input.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

/// Where the shell would find a program; nullopt where it would not.
std::optional<std::filesystem::path> findProgram(const std::string& name);

/// A program that reads what is written to it. What it says on standard error is kept.
class ChildProcess {
public:
    /// Of its standard output.
    enum class Output { dropped, kept };
    /// Throws Error (missingInput) where there is no such program.
    explicit ChildProcess(const std::vector<std::string>& command, Output output = Output::dropped);
    /// Ends the program, if it still runs.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// False once the program takes no more.
    bool write(std::span<const std::byte> bytes);
    struct Result {
        int exitCode;  ///< 128 and the signal's number where one ended it
        std::string said;
    };
    /// Closes its input and waits.
    Result finish();

private:
    int process_ = 0, input_ = -1, said_ = -1;
};

}  // namespace limn
