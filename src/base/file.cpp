#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace limn {
namespace {

class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    operator int() const { return fd_; }
    /// Some file systems report a failed write only here.
    int close() { return ::close(std::exchange(fd_, -1)); }

private:
    int fd_;
};

Error readError(const std::filesystem::path& path, int errorNumber) {
    return {exitCodeForRead(errorNumber), {path.string()},
        fmt::format("cannot be read ({})", std::strerror(errorNumber)), errorNumber == ENOENT ? "check the path" : ""};
}

Error writeError(const std::filesystem::path& path, int errorNumber, std::string_view doing) {
    std::string remedy;
    if (errorNumber == ENOSPC || errorNumber == EDQUOT) remedy = "free some space; what stood there before is unharmed";
    if (errorNumber == EFBIG) remedy = "the file size is limited here (ulimit -f); what stood there before is unharmed";
    if (errorNumber == EACCES || errorNumber == EROFS) remedy = "choose another folder with --output";
    return {exitCodeForWrite(errorNumber), {path.string()},
        fmt::format("{} failed ({})", doing, std::strerror(errorNumber)), std::move(remedy)};
}

void writeAll(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        // A write that takes nothing would loop for ever: treat it as the full disk it is.
        if (written <= 0) throw writeError(path, written < 0 ? errno : ENOSPC, "writing");
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void compareWith(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
    if (::lseek(fd, 0, SEEK_SET) != 0) throw writeError(path, errno, "reading back");
    std::array<std::byte, 1 << 16> buffer;
    while (true) {
        const ssize_t got = ::read(fd, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw writeError(path, errno, "reading back");
        if (got == 0) break;
        const auto count = static_cast<std::size_t>(got);
        if (count > bytes.size() || std::memcmp(buffer.data(), bytes.data(), count) != 0)
            throw writeError(path, EIO, "reading back");
        bytes = bytes.subspan(count);
    }
    if (!bytes.empty()) throw writeError(path, EIO, "reading back");
}

/// A word of letters, digits and dots: as part of a file's name.
std::string word(std::string text) {
    std::erase_if(text, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.'; });
    return text.empty() ? "unknown" : text;
}

std::string firstLine(const char* path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

/// When a process began, in ticks since the machine booted; empty where there is no such process. The name of its
/// program, in brackets, may hold anything: fields are counted from the last bracket.
std::string startOf(const std::string& process) {
    const std::string line = firstLine(("/proc/" + process + "/stat").c_str());
    std::istringstream fields(line.substr(std::min(line.rfind(')') + 1, line.size())));
    std::string field;
    for (int i = 0; i < 20; ++i) fields >> field;
    return fields ? field : "";
}

/// Where process numbers mean the same: host, its boot, and the namespace of processes, which containers have of their
/// own.
const std::string& thisMachine() {
    static const std::string machine = [] {
        std::array<char, 256> host{};
        ::gethostname(host.data(), host.size() - 1);
        std::error_code unknown;
        const auto space = std::filesystem::read_symlink("/proc/self/ns/pid", unknown).string();
        return word(host.data()).substr(0, 64) + '-' + word(firstLine("/proc/sys/kernel/random/boot_id")).substr(0, 12)
            + '-' + word(space);
    }();
    return machine;
}

/// ".limn-HOST-BOOT-NAMESPACE-PROCESS-START-": whose a temporary is, should a kill leave it behind.
constexpr std::string_view kTemporary = ".limn-";
std::string temporaryPrefix() {
    const std::string process = std::to_string(::getpid());
    return fmt::format("{}{}-{}-{}-", kTemporary, thisMachine(), process, word(startOf(process)));
}

/// The parts of a temporary's name: host, boot, namespace, process, start and six random letters, or those letters
/// alone, as an earlier version wrote it. Empty for every other name: what people call ".limn-notes" is theirs.
std::vector<std::string> partsOf(std::string_view name) {
    if (!name.starts_with(kTemporary)) return {};
    std::vector<std::string> parts(1);
    for (const char c : name.substr(kTemporary.size())) c == '-' ? void(parts.emplace_back()) : void(parts.back() += c);
    const bool isShaped = (parts.size() == 1 || parts.size() == 6) && parts.back().size() == 6
        && std::all_of(parts.back().begin(), parts.back().end(), [](unsigned char c) { return std::isalnum(c) != 0; });
    return isShaped ? parts : std::vector<std::string>{};
}

/// Is a process of this machine no more? One that others may not look at counts as alive.
bool isGone(const std::string& process, const std::string& start) {
    const std::string now = startOf(process);
    if (!now.empty()) return word(now) != start;
    const int number = std::atoi(process.c_str());
    return number > 0 && ::kill(number, 0) != 0 && errno == ESRCH;
}

/// Can the process that made a temporary not be there any more? Of another machine's nothing is known but their age.
bool isLeftBehind(const std::filesystem::path& file) {
    std::error_code gone;
    const std::vector<std::string> parts = partsOf(file.filename().string());
    if (parts.empty() || !std::filesystem::is_regular_file(std::filesystem::symlink_status(file, gone))) return false;
    if (parts.size() == 6 && parts[0] + '-' + parts[1] + '-' + parts[2] == thisMachine())
        return isGone(parts[3], parts[4]);
    const auto written = std::filesystem::last_write_time(file, gone);
    return !gone && std::filesystem::file_time_type::clock::now() - written > std::chrono::hours(24);
}

/// Removes what killed processes have left in a folder; once per folder and process. What cannot be removed stays.
void sweepTemporaries(const std::filesystem::path& folder) {
    static std::mutex mutex;
    static std::set<std::filesystem::path> swept;
    const std::lock_guard lock(mutex);
    std::error_code error;
    if (!swept.insert(std::filesystem::weakly_canonical(folder, error)).second) return;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
        if (isLeftBehind(entry->path())) {
            std::error_code ignored;
            std::filesystem::remove(entry->path(), ignored);
        }
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
    const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (fd < 0) throw readError(path, errno);
    struct stat info {};
    if (::fstat(fd, &info) != 0) throw readError(path, errno);
    if (S_ISDIR(info.st_mode)) throw readError(path, EISDIR);
    if (!S_ISREG(info.st_mode))
        throw Error(ExitCode::missingInput, {path.string()}, "is a pipe or a device", "write it to a file first");
    size_ = static_cast<std::size_t>(info.st_size);
    if (size_ == 0) return;
    void* mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, fd, 0);
    if (mapped == MAP_FAILED) throw readError(path, errno);
    data_ = static_cast<const char*>(mapped);
}

MappedFile::~MappedFile() {
    if (data_) ::munmap(const_cast<char*>(data_), size_);
}

bool fileExists(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

std::string readFile(const std::filesystem::path& path) {
    const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (fd < 0) throw readError(path, errno);
    std::string text;
    std::array<char, 1 << 16> buffer;
    while (true) {
        const ssize_t got = ::read(fd, buffer.data(), buffer.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw readError(path, errno);
        if (got == 0) return text;
        // A device such as /dev/zero has no end.
        if (text.size() > kLongestText)
            throw Error(ExitCode::missingInput, {path.string()},
                fmt::format("is longer than {} MiB", kLongestText >> 20), "no text that limn reads is: check the path");
        text.append(buffer.data(), static_cast<std::size_t>(got));
    }
}

/// The folder of a file that is about to be written, made where it is missing. Throws Error.
static std::filesystem::path makeFolderOf(const std::filesystem::path& path) {
    auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::error_code made;
    std::filesystem::create_directories(folder, made);
    if (made) throw writeError(folder, made.value(), "making the folder");
    std::error_code unknown;
    if (std::filesystem::is_directory(path, unknown)) throw writeError(path, EISDIR, "creating");
    return folder;
}

/// The temporaries that are there. Whoever holds the lock keeps the process from making and renaming any.
struct Temporaries {
    std::mutex mutex;
    std::set<std::string> paths;
};
static Temporaries& temporaries() {
    static auto* const list = new Temporaries;  // outlives every thread
    return *list;
}

static void dropTemporary(const std::string& path) {
    const std::lock_guard lock(temporaries().mutex);
    if (temporaries().paths.erase(path) > 0) ::unlink(path.c_str());
}

/// An open temporary beside a file. Makes missing folders, and sweeps. Throws Error.
static Descriptor makeTemporary(const std::filesystem::path& path, std::string& name) {
    const auto folder = makeFolderOf(path);
    sweepTemporaries(folder);
    name = (folder / (temporaryPrefix() + "XXXXXX")).string();
    const std::lock_guard lock(temporaries().mutex);
    const int made = ::mkostemp(name.data(), O_CLOEXEC);
    if (made < 0) throw writeError(path, errno, "creating");
    temporaries().paths.insert(name);
    return Descriptor(made);
}

/// Renames a temporary to the file that it was made for. Throws Error.
static void commitTemporary(const std::string& temporary, const std::filesystem::path& path) {
    {
        const std::lock_guard lock(temporaries().mutex);
        if (::rename(temporary.c_str(), path.c_str()) != 0) throw writeError(path, errno, "renaming");
        temporaries().paths.erase(temporary);
    }
    // The rename itself must survive a power cut; a file system that cannot sync folders has nothing better to offer.
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    const Descriptor folderFd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folderFd >= 0) ::fsync(folderFd);
}

PendingFile::PendingFile(std::filesystem::path path, std::span<const std::byte> bytes) : path_(std::move(path)) {
    std::string temporary;
    Descriptor fd = makeTemporary(path_, temporary);
    try {
        if (::fchmod(fd, 0644) != 0) throw writeError(path_, errno, "creating");
        writeAll(fd, bytes, path_);
        if (::fsync(fd) != 0) throw writeError(path_, errno, "writing");
        compareWith(fd, bytes, path_);
        if (fd.close() != 0) throw writeError(path_, errno, "writing");
    } catch (...) {
        dropTemporary(temporary);
        throw;
    }
    temporary_ = std::move(temporary);
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

PendingFile::~PendingFile() {
    if (!temporary_.empty()) dropTemporary(temporary_);
}

void PendingFile::commit() {
    commitTemporary(temporary_, path_);
    temporary_.clear();
}

ReservedFile::ReservedFile(std::filesystem::path path) : path_(std::move(path)) {
    std::string temporary;
    const Descriptor fd = makeTemporary(path_, temporary);
    temporary_ = temporary;
    ::fchmod(fd, 0644);
}

ReservedFile::~ReservedFile() {
    if (!temporary_.empty()) dropTemporary(temporary_.string());
}

void ReservedFile::commit() {
    const Descriptor fd(::open(temporary_.c_str(), O_RDWR | O_CLOEXEC));
    if (fd < 0 || ::fsync(fd) != 0) throw writeError(path_, errno, "writing");
    commitTemporary(temporary_.string(), path_);
    temporary_.clear();
}

void abandonPendingFiles() {
    temporaries().mutex.lock();  // for good
    for (const auto& path : temporaries().paths) ::unlink(path.c_str());
}

void replaceFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    PendingFile(path, bytes).commit();
}

void requireWritable(const std::filesystem::path& path) {
    const auto folder = makeFolderOf(path);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) throw writeError(path, errno, "creating");
    sweepTemporaries(folder);
}

void replaceFile(const std::filesystem::path& path, std::string_view text) {
    replaceFile(path, std::as_bytes(std::span(text.data(), text.size())));
}

bool hasFrameNumber(const std::filesystem::path& pattern) { return pattern.string().find('#') != std::string::npos; }

std::filesystem::path framePath(const std::filesystem::path& pattern, int frame) {
    std::string text = pattern.string();
    const auto first = text.find('#');
    if (first == std::string::npos) return pattern;
    auto last = first;
    while (last < text.size() && text[last] == '#') ++last;
    const std::string digits = fmt::format("{:0{}}", std::abs(frame), last - first);
    return text.replace(first, last - first, (frame < 0 ? "-" : "") + digits);
}

}  // namespace limn
