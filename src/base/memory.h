// How much memory there is, and who is about to need how much of it.
#pragma once

#include "base/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace limn {

/// Bytes that this process may take: what setMemoryLimit said; else the limit of its control group, or 80 % of the
/// machine's memory, whichever is less.
std::uint64_t memoryLimit();
/// 0: as if nothing had been said.
void setMemoryLimit(std::uint64_t bytes);

/// "512M", "8G", "1.5T" (powers of 1024), or a number of bytes. nullopt for anything else, and for 0.
std::optional<std::uint64_t> parseMemory(std::string_view text);

/// Memory that is about to be taken. Claims of several threads add up. Throws Error (out of memory) where all of them,
/// beside what was in use when the first of them began, exceed the limit: before anything is paid.
class MemoryClaim {
public:
    /// `what`: "the mesh has 3 billion triangles". `where` and `remedy` as in Error.
    MemoryClaim(std::uint64_t bytes, const Location& where, const std::string& what, const std::string& remedy);
    ~MemoryClaim();
    MemoryClaim(const MemoryClaim&) = delete;
    MemoryClaim& operator=(const MemoryClaim&) = delete;

private:
    std::uint64_t bytes_;
};

}  // namespace limn
