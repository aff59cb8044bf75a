#pragma once

namespace s2s::obs {

/// Registers this library's observation classes with MRPT's serialisation. Call once before reading rawlogs in a
/// program that links the library statically; `RawlogReader` does it by itself.
void registerClasses();

}  // namespace s2s::obs
