# One function for each kind of target; every target of the project is made by one of them.

# The one precompiled header that all targets share (see cmake/pch.h).
function(_s2s_common target)
  target_link_libraries(${target} PRIVATE s2s_flags)
  if(S2S_PCH)
    target_precompile_headers(${target} REUSE_FROM s2s_pch)
  endif()
endfunction()

# s2s_library(name SOURCES … DEPENDS …): the library libs/<name> as target s2s::<name>.
function(s2s_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(s2s_${name} ${ARG_SOURCES})
  add_library(s2s::${name} ALIAS s2s_${name})
  set_target_properties(s2s_${name} PROPERTIES OUTPUT_NAME s2s-${name} EXPORT_NAME ${name}
                        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  target_compile_features(s2s_${name} PUBLIC cxx_std_17)
  target_include_directories(s2s_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(s2s_${name} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
  _s2s_common(s2s_${name})
  set_property(GLOBAL APPEND PROPERTY S2S_INSTALL_TARGETS s2s_${name})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# s2s_program(name SOURCES … DEPENDS …): a command-line program, installed into bin.
function(s2s_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE s2s_command_line ${ARG_DEPENDS})
  _s2s_common(${name})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# s2s_tests(library SOURCES … DEPENDS …): the GoogleTest cases of tests/<library>, each one a CTest case.
function(s2s_tests library)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  set(target test_${library})
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_DEPENDS} GTest::gtest GTest::gmock GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/tests/support)
  target_compile_definitions(${target} PRIVATE
    S2S_SOURCE_DIR="${CMAKE_SOURCE_DIR}" S2S_DATA_DIR="${S2S_DATA_DIR}" S2S_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}"
    S2S_LIB_DIR="${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
  _s2s_common(${target})
  gtest_discover_tests(${target} TEST_PREFIX ${library}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       WORKING_DIRECTORY ${CMAKE_SOURCE_DIR} PROPERTIES LABELS ${library} TIMEOUT 600
                       ENVIRONMENT "LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/lsan.supp")
endfunction()

# s2s_benchmark(name SOURCES … DEPENDS …): a Google Benchmark program, run by share/bench.sh.
function(s2s_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(bench_${name} ${ARG_SOURCES})
  target_link_libraries(bench_${name} PRIVATE ${ARG_DEPENDS} benchmark::benchmark benchmark::benchmark_main)
  target_compile_definitions(bench_${name} PRIVATE S2S_SOURCE_DIR="${CMAKE_SOURCE_DIR}" S2S_DATA_DIR="${S2S_DATA_DIR}")
  _s2s_common(bench_${name})
endfunction()
