# How every target of the house is made: one function a kind, one set of flags for all.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

find_program(AW_CCACHE ccache)
if(AW_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${AW_CCACHE})
endif()

add_library(aw_flags INTERFACE)
target_include_directories(aw_flags INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(aw_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
  -Wno-missing-field-initializers)  # designated initializers leave the rest at their defaults on purpose
if(AW_SANITIZE_ADDRESS)
  target_compile_options(aw_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(aw_flags INTERFACE -fsanitize=address,undefined)
endif()
if(AW_SANITIZE_THREAD)
  # On GCC 12 Asio's fences (not modelled) and rewritten std::optional storage warn falsely.
  target_compile_options(aw_flags INTERFACE -fsanitize=thread -Wno-tsan -Wno-maybe-uninitialized)
  target_link_options(aw_flags INTERFACE -fsanitize=thread)
endif()
if(AW_FUZZ)
  target_compile_options(aw_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined)
  target_link_options(aw_flags INTERFACE -fsanitize=address,undefined)
endif()

# aw_library(codec SOURCES a.cpp DEPS atlaswire::base PkgConfig::X): the room's library, atlaswire::codec.
function(aw_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_library(atlaswire_${name} STATIC ${ARG_SOURCES})
  add_library(atlaswire::${name} ALIAS atlaswire_${name})
  target_link_libraries(atlaswire_${name} PUBLIC aw_flags ${ARG_DEPS})
endfunction()

# aw_program(atlasd SOURCES main.cpp DEPS atlaswire::server)
function(aw_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE aw_flags ${ARG_DEPS})
endfunction()

# aw_test(codec_tests SOURCES ... DEPS ... [LABELS gpu]): one GoogleTest binary, each test its own CTest entry.
function(aw_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPS;LABELS" ${ARGN})
  if(AW_FUZZ)
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS cpu)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE aw_flags ${ARG_DEPS} GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
endfunction()

# aw_fuzzer(envelope SOURCES envelope_fuzz.cpp DEPS atlaswire::proto): with AW_FUZZ a libFuzzer binary
# fuzz_envelope; otherwise a binary that replays tests/fuzz/corpus/envelope once, under CTest.
function(aw_fuzzer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(fuzz_${name} ${ARG_SOURCES})
  target_link_libraries(fuzz_${name} PRIVATE aw_flags ${ARG_DEPS})
  if(AW_FUZZ)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  else()
    target_sources(fuzz_${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests/fuzz/replay_main.cpp)
    add_test(NAME fuzz_replay.${name}
      COMMAND fuzz_${name} ${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/${name})
  endif()
endfunction()
