# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# Builds tests/consumer/no_draco and runs it on a golden file; the shared library, stripped, stays within its bar of 500 KiB.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed with ${result}: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer/no_draco -B ${WORK}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
     -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DVSPLIT_SOURCE=${SOURCE})
must(${CMAKE_COMMAND} --build ${WORK}/build)
must(${WORK}/build/bin/host_decoder ${SOURCE}/formats/golden/1-draco.pmesh ${SOURCE}/formats/golden/1-returning.pmesh)
file(GLOB_RECURSE library ${WORK}/build/libvsplit.so ${WORK}/build/libvsplit.dylib)
if(NOT library)
  message(FATAL_ERROR "there is no shared library")
endif()
find_program(STRIP strip REQUIRED)
must(${STRIP} -o ${WORK}/stripped ${library})
file(SIZE ${WORK}/stripped bytes)
math(EXPR kib "(${bytes} + 1023) / 1024")
message(STATUS "shared library without Draco, stripped: ${bytes} bytes, ${kib} KiB")
if(kib GREATER 500)
  message(FATAL_ERROR "more than 500 KiB")
endif()
