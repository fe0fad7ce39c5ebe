#include "base/error.h"
#include "base/text.h"

#include <cerrno>

namespace limn {

std::string Location::text() const {
    std::string text = file;
    if (line > 0) text += ":" + std::to_string(line);
    if (line > 0 && column > 0) text += ":" + std::to_string(column);
    return text;
}

Error::Error(ExitCode code_, Location where_, std::string problem_, std::string remedy_)
    : code(code_), where(std::move(where_)), problem(std::move(problem_)), remedy(std::move(remedy_)) {
    const std::string place = where.text();
    message = (place.empty() ? "" : place + ": ") + problem + (remedy.empty() ? "" : "; " + remedy);
    // Bugs are told in full: what a compiler of shaders says takes many lines.
    if (code != ExitCode::internal) message = presentable(message);
}

const char* Errors::what() const noexcept { return list.front().what(); }

void ErrorCollector::throwIfAny() const {
    if (!errors_.list.empty()) throw errors_;
}

ExitCode exitCodeForWrite(int errorNumber) {
    switch (errorNumber) {
        case EACCES:
        case EPERM:
        case EROFS: return ExitCode::noPermission;
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
        case EIO: return ExitCode::ioError;
        case EMFILE:
        case ENFILE:
        case EAGAIN: return ExitCode::transient;
        case ENOMEM: return ExitCode::outOfMemory;
        default: return ExitCode::cannotCreate;
    }
}

ExitCode exitCodeForRead(int errorNumber) {
    switch (errorNumber) {
        case EACCES:
        case EPERM: return ExitCode::noPermission;
        case EIO: return ExitCode::ioError;
        case EMFILE:
        case ENFILE:
        case EAGAIN: return ExitCode::transient;
        case ENOMEM: return ExitCode::outOfMemory;
        default: return ExitCode::missingInput;
    }
}

}  // namespace limn
