// The C heap, made ready for a program that asks for a few hundred large blocks and gives most of them back within
// milliseconds.
//
// By default glibc maps every large block anew and unmaps it when it is freed. The kernel then clears each of its pages
// when it is first touched, one fault at a time: 0.5 ms per MiB. For a picture of a megapixel this is a fifth of the
// drawing time.
#pragma once

#include <cstddef>

namespace limn {

/// Blocks of up to 32 MiB come from one heap, which keeps freed memory. Call once, before the first large allocation.
void keepFreedMemory();

/// Has the kernel bring in the pages of this much free heap at once, on all cores, instead of one by one on first
/// touch. Call before the calling thread allocates such blocks. Does nothing where the kernel cannot (before Linux
/// 5.14).
void bringInPages(std::size_t bytes);

}  // namespace limn
