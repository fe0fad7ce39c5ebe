// The C heap, made ready for a program that asks for a few hundred large blocks and gives most of them back within
// milliseconds.
//
// By default glibc maps every large block anew and unmaps it when it is freed. The kernel then clears each of its pages
// when it is first touched, one fault at a time: 0.5 ms for every MiB, which for a picture of a megapixel adds up to a
// fifth of the time that it takes to draw.
#pragma once

#include <cstddef>

namespace limn {

/// Blocks of up to 32 MiB come from one heap that keeps what it has been given back. Call once, before anything large
/// is asked for.
void keepFreedMemory();

/// Has the kernel bring in the pages of so many bytes of free heap at once, on all cores, rather than one by one as
/// they are touched: for blocks that the calling thread is about to ask for. Does nothing where the kernel cannot
/// (before Linux 5.14).
void bringInPages(std::size_t bytes);

}  // namespace limn
