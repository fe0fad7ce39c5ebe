// Reading whole files and replacing files safely.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace limn {

/// The bytes of a file, mapped into memory and read-only; empty for an empty file. Throws Error, for pipes and devices
/// too.
class MappedFile {
public:
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view text() const { return {data_, size_}; }

private:
    const char* data_ = nullptr;
    std::size_t size_ = 0;
};

/// Does the file exist? False too where that cannot be found out: opening it will tell why.
bool fileExists(const std::filesystem::path& path);

/// The longest file that readFile takes: people write configs, materials and shaders by hand. Meshes are mapped.
inline constexpr std::size_t kLongestText = std::size_t{64} << 20;

/// Throws Error when the file is missing, a folder, longer than kLongestText, or cannot be read.
std::string readFile(const std::filesystem::path& path);

/// New content of a file, whole on disk beside it under a temporary name: written, synced, read back and compared.
/// Gone again unless committed. Makes missing folders. Removes the temporaries of processes that are no more: this
/// machine's at once, others' after a day.
class PendingFile {
public:
    /// Throws Error: 73 cannot create, 74 I/O or disk full, 77 permission.
    PendingFile(std::filesystem::path path, std::span<const std::byte> bytes);
    ~PendingFile();
    PendingFile(PendingFile&& other) noexcept;
    PendingFile& operator=(PendingFile&&) = delete;

    /// Takes the file's place. Throws Error.
    void commit();
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    std::string temporary_;  ///< empty: nothing is there
};

/// A temporary name beside a file for another program to write to, as PendingFile has one. Gone again unless committed.
class ReservedFile {
public:
    /// Throws Error as PendingFile does.
    explicit ReservedFile(std::filesystem::path path);
    ~ReservedFile();
    ReservedFile(const ReservedFile&) = delete;
    ReservedFile& operator=(const ReservedFile&) = delete;

    const std::filesystem::path& temporary() const { return temporary_; }
    /// Syncs it, and lets it take the file's place. Throws Error.
    void commit();

private:
    std::filesystem::path path_, temporary_;
};

/// Removes this process's temporaries and keeps it from making or renaming any more: for those who are about to end it.
void abandonPendingFiles();

/// Replaces `path` by `bytes`, or leaves everything as it was. Writes a temporary in the same folder, notices short
/// writes, syncs, reads back, compares, renames, and syncs the folder. Throws what PendingFile throws.
void replaceFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
void replaceFile(const std::filesystem::path& path, std::string_view text);

/// Throws Error where replaceFile could not even begin. Makes missing folders, and sweeps as PendingFile does.
void requireWritable(const std::filesystem::path& path);

/// "room_####.exr" at 7 → "room_0007.exr".
std::filesystem::path framePath(const std::filesystem::path& pattern, int frame);
bool hasFrameNumber(const std::filesystem::path& pattern);

}  // namespace limn
