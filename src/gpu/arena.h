// One buffer for many owners: each puts and drops its own piece without touching the others.
#pragma once

#include "gl/objects.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace limn {

/// A piece of an arena, in elements.
struct ArenaPiece {
    std::uint32_t first = 0, count = 0;
};

class Arena {
public:
    Arena() = default;
    /// `stride`: bytes of an element. `most`: elements that the device takes. `mappable`: see gl::Buffer.
    Arena(std::string label, std::size_t stride, std::uint64_t most, bool mappable = false);

    /// Makes room for this many more elements, so that the buffer is replaced once and not at every put.
    void reserve(std::uint64_t elements);
    /// A piece with these bytes. Throws Error (outOfMemory) where the device takes no more elements.
    ArenaPiece put(std::span<const std::byte> bytes);
    void write(const ArenaPiece& piece, std::span<const std::byte> bytes);  ///< of a piece's own size
    std::vector<std::byte> read(const ArenaPiece& piece) const;
    void drop(const ArenaPiece& piece);

    const gl::Buffer& buffer() const { return buffer_; }
    /// Changes whenever the buffer is replaced.
    int generation() const { return generation_; }

private:
    void grow(std::uint64_t elements);

    std::string label_;
    std::size_t stride_ = 4;
    std::uint64_t most_ = 0, capacity_ = 0, end_ = 0;  ///< elements; those from end_ on were never used
    bool mappable_ = false;
    int generation_ = 0;
    std::map<std::uint32_t, std::uint32_t> free_;  ///< free pieces before end_: first and count
    gl::Buffer buffer_;
};

}  // namespace limn
