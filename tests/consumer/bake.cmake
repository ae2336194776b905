# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# docs/examples/bake.cpp on a sample, its file verified against the sample by the command.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed with ${result}: ${ARGN}")
  endif()
endfunction()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
must(${VSPLIT} sample whale --mesh --triangles 2000 -o ${WORK}/whale.ply)
must(${EXAMPLE} ${WORK}/whale.ply ${WORK}/whale.pmesh)
must(${VSPLIT} verify ${WORK}/whale.pmesh --against ${WORK}/whale.ply)
