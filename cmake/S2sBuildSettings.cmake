# Language, output folders, compiler cache and flags that hold for every target of this project.

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")

# A release keeps line tables: profilers and crash reports need them, and they cost little to build.
string(APPEND CMAKE_CXX_FLAGS_RELEASE " -g1")

find_program(S2S_CCACHE ccache)
if(S2S_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Sloppiness as ccache's manual asks for precompiled headers; base folder so that clones share hits.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1
      ${S2S_CCACHE})
endif()

add_library(s2s_flags INTERFACE)
target_compile_options(s2s_flags INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow>
  $<BUILD_INTERFACE:$<$<BOOL:${S2S_WARNINGS_AS_ERRORS}>:-Werror>>
  $<BUILD_INTERFACE:$<$<BOOL:${S2S_PCH}>:-fpch-preprocess>>)
if(S2S_PCH)
  # Programs too: the precompiled header they share with the libraries must be made with the same flag.
  target_compile_options(s2s_flags INTERFACE $<BUILD_INTERFACE:-fPIC>)
endif()
if(S2S_SANITIZE)
  target_compile_options(s2s_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${S2S_SANITIZE}>
                         $<BUILD_INTERFACE:-fno-sanitize-recover=all>)
  target_link_options(s2s_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${S2S_SANITIZE}>)
endif()
