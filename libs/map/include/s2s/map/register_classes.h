#pragma once

namespace s2s::map {

/// Registers CSeabedSkyMap with MRPT's serialisation and map factories. Call once in a program that links the library
/// statically and reads maps from files or INI definitions.
void registerClasses();

}  // namespace s2s::map
