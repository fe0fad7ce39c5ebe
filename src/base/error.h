// The three ways in which limn says that something is wrong:
//   assert        a bug of ours; Error(internal) where release builds must notice it too
//   throw Error   bad input or a failing environment: where, what, how to mend it, and the exit code
//   std::optional normal absence
// `main` catches; tests/unit/style_test.cpp lists who else does, and why.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace limn {

/// Exit codes follow sysexits(3) where one fits: farms can then tell what to retry from what to report.
enum class ExitCode : int {
    done = 0,
    someFramesFailed = 1,
    outOfMemory = 33,
    usage = 64,    ///< command line or config
    badData = 65,  ///< scene data
    missingInput = 66,
    noDevice = 69,  ///< no usable GL device
    internal = 70,
    cannotCreate = 73,
    ioError = 74,  ///< I/O error or disk full
    transient = 75,
    noPermission = 77,
};

/// A place in a text file. Lines and columns count from 1; 0 means "the whole file" or "no column".
struct Location {
    std::string file;
    int line = 0;
    int column = 0;

    /// "file:line:column", leaving out what is unknown.
    std::string text() const;
};

/// One thing that is wrong, in words for the person who can mend it.
struct Error : std::exception {
    Error(ExitCode code, Location where, std::string what, std::string remedy = {});

    const char* what() const noexcept override { return message.c_str(); }

    ExitCode code;
    Location where;
    std::string problem;  ///< what is wrong
    std::string remedy;   ///< how to mend it; may be empty
    std::string message;  ///< "where: problem; remedy", presentable (base/text.h)
};

/// Several errors that were found together. Never empty when thrown.
struct Errors : std::exception {
    const char* what() const noexcept override;

    /// The exit code of the first error.
    ExitCode code() const { return list.front().code; }

    std::vector<Error> list;
};

/// Collects errors so that a person sees all of them at once.
class ErrorCollector {
public:
    void add(Error error) { errors_.list.push_back(std::move(error)); }
    /// Runs `work` and collects what it throws. False if it threw.
    template <class Work>
    bool run(Work&& work);
    bool empty() const { return errors_.list.empty(); }
    const std::vector<Error>& list() const { return errors_.list; }

    /// Throws Errors when anything was collected.
    void throwIfAny() const;

private:
    Errors errors_;
};

/// Runs `work` and adds what it throws, Error or Errors, to `into`: for work on several threads, and for several files.
template <class Work>
void collect(std::vector<Error>& into, Work&& work) {
    try {
        work();
    } catch (const Error& error) { into.push_back(error); } catch (const Errors& several) {
        into.insert(into.end(), several.list.begin(), several.list.end());
    }
}

template <class Work>
bool ErrorCollector::run(Work&& work) {
    const std::size_t before = errors_.list.size();
    collect(errors_.list, work);
    return errors_.list.size() == before;
}

/// The exit code that fits a failed system call (errno) while *creating or writing* a file.
ExitCode exitCodeForWrite(int errorNumber);
/// The exit code that fits a failed system call (errno) while *reading* a file.
ExitCode exitCodeForRead(int errorNumber);

}  // namespace limn
