#include "gpu/arena.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {

Arena::Arena(std::string label, std::size_t stride, std::uint64_t most, bool mappable)
    : label_(std::move(label)), stride_(stride), most_(most), mappable_(mappable) {}

void Arena::grow(std::uint64_t elements) {
    if (elements > most_)
        throw Error(ExitCode::outOfMemory, {},
            fmt::format("the scene's {} are more than this GL device takes ({})", label_, most_),
            "use coarser meshes or another device");
    gl::Buffer larger = gl::Buffer::withSize(elements * stride_, label_, mappable_);
    larger.copyFrom(buffer_, end_ * stride_);
    buffer_ = {};
    buffer_ = std::move(larger);
    capacity_ = elements;
    ++generation_;
}

void Arena::reserve(std::uint64_t elements) {
    if (end_ + elements > capacity_ || !buffer_) grow(end_ + elements);
}

ArenaPiece Arena::put(std::span<const std::byte> bytes) {
    const auto count = static_cast<std::uint32_t>(bytes.size() / stride_);
    const auto fits = [&](const auto& piece) { return piece.second >= count; };
    ArenaPiece piece{static_cast<std::uint32_t>(end_), count};
    if (const auto found = std::find_if(free_.begin(), free_.end(), fits); found != free_.end() && count > 0) {
        piece.first = found->first;
        const auto rest = found->second - count;
        free_.erase(found);
        if (rest > 0) free_[piece.first + count] = rest;
    } else {
        if (end_ + count > most_) grow(end_ + count);  // throws
        // A quarter more than needed: a buffer that grew once will grow again.
        if (end_ + count > capacity_ || !buffer_) grow(std::min(end_ + count + (end_ > 0 ? end_ / 4 : 0), most_));
        end_ += count;
    }
    write(piece, bytes);
    return piece;
}

void Arena::write(const ArenaPiece& piece, std::span<const std::byte> bytes) {
    buffer_.write(bytes, piece.first * stride_);
}

std::vector<std::byte> Arena::read(const ArenaPiece& piece) const {
    return buffer_.read(piece.first * stride_, piece.count * stride_);
}

void Arena::drop(const ArenaPiece& piece) {
    if (piece.count == 0) return;
    const auto at = free_.emplace(piece.first, piece.count).first;
    if (const auto next = std::next(at); next != free_.end() && at->first + at->second == next->first) {
        at->second += next->second;
        free_.erase(next);
    }
    auto merged = at;
    if (at != free_.begin())
        if (const auto before = std::prev(at); before->first + before->second == at->first) {
            before->second += at->second;
            free_.erase(at);
            merged = before;
        }
    if (merged->first + merged->second == end_) {
        end_ = merged->first;
        free_.erase(merged);
    }
}

}  // namespace limn
